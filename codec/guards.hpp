// What must hold of arrays that Python gives to kernels of `codec`. C calls many of these as well, often in loops, with
// arrays that it has made itself, so that the kernel does not check each index again: Python's arrays are checked once,
// here. A guard has the name of its kernel, takes the same arguments, and says whether sizes fit together and indices
// lie within what they point into. A failure is a fault of the caller, never of a stream.
#pragma once

#include "bitstream/kernel.hpp"

extern "C" {
#include "codec/blocks/blocks.h"
#include "codec/denoise/denoise.h"
#include "codec/geometry/geometry.h"
#include "codec/look/look.h"
#include "codec/signal/signal.h"
#include "codec/static/choice/choice.h"
}

namespace guards {

inline bool below(ConstInts indices, int64_t limit) { return all_below(indices.data, indices.size, limit); }
inline bool below(ConstInts2 indices, int64_t limit) {
    return all_below(indices.data, indices.rows * indices.columns, limit);
}
inline bool triples(int64_t rows, ConstDoubles2 array) { return array.rows == rows && array.columns == 3; }
inline bool triples(int64_t rows, Doubles2 array) { return array.rows == rows && array.columns == 3; }

// Rows of a list: they ascend from 0, and end within the members; `least` members at least are in each.
inline bool lists(ConstLongs starts, int64_t rows, int64_t members, int64_t least = 0) {
    if (rows < 0 || starts.size != rows + 1 || starts.data[0] != 0) return false;
    for (int64_t row = 0; row < rows; row++)
        if (starts.data[row + 1] - starts.data[row] < least || starts.data[row + 1] > members) return false;
    return true;
}
inline bool graph(Lists given, int64_t rows, int64_t limit, int64_t least = 0) {
    return lists(given.starts, rows, given.members.size, least) && below(given.members, limit);
}
inline bool geometry(FaceGeometry faces) {
    int64_t m = faces.normals.rows;
    return triples(m, faces.centroids) && faces.areas.size == m && triples(m, faces.normals);
}

inline bool collect_edges(ConstInts2 faces, Ints offsets, Ints filled, Ints ends, Ints second) {
    return faces.columns == 3 && offsets.size > 0 && below(faces, offsets.size - 1) && filled.size >= offsets.size - 1
        && ends.size >= 6 * faces.rows && second.size >= 6 * faces.rows;
}
inline bool vertex_faces(ConstInts2 faces, Longs starts, Ints members) {
    return starts.size > 0 && below(faces, starts.size - 1) && members.size >= faces.rows * faces.columns;
}
inline bool normals_apart(ConstDoubles2 original, ConstDoubles2 decoded, ConstInts2 faces, Doubles2 around) {
    return triples(original.rows, original) && triples(original.rows, decoded) && faces.columns == 3
        && around.rows == original.rows && around.columns == 7 && below(faces, original.rows);
}
inline bool geometric_laplacian(ConstDoubles2 positions, Lists neighbors, Doubles2 result) {
    int64_t n = positions.rows;
    return triples(n, positions) && triples(n, result) && graph(neighbors, n, n);
}
inline bool face_geometry(
    ConstDoubles2 positions, ConstInts2 faces, Doubles2 centroids, Doubles areas, Doubles2 normals, Bytes whole) {
    int64_t m = faces.rows;
    return triples(positions.rows, positions) && faces.columns == 3 && below(faces, positions.rows)
        && triples(m, centroids) && areas.size == m && triples(m, normals) && (whole.size == 0 || whole.size == m);
}
inline bool weighted_angle(
    ConstDoubles2 normals, ConstDoubles weights, ConstDoubles2 decoded, ConstInts2 faces, double) {
    return triples(faces.rows, normals) && weights.size == faces.rows && faces.columns == 3
        && triples(decoded.rows, decoded) && below(faces, decoded.rows);
}
inline bool build_tree(ConstDoubles2 lowest, ConstDoubles2 highest, Longs order, Doubles2 low, Doubles2 high,
    Longs first, Longs count) {
    int64_t m = lowest.rows, nodes = 2 * m + 1;
    return triples(m, lowest) && triples(m, highest) && order.size == m && triples(nodes, low) && triples(nodes, high)
        && first.size == nodes && count.size == nodes;
}
// A node without triangles has its other child after it, so that a walk ends; how deep it goes the kernel bounds.
inline bool nearest_distances(ConstDoubles2 points, Tree tree, Doubles, Longs) {
    int64_t m = tree.triangles.rows, nodes = 2 * m + 1, seen = 1;
    if (points.columns != 3 || tree.triangles.columns != 9 || m < 1 || tree.order.size != m || !triples(nodes, tree.low)
        || !triples(nodes, tree.high) || tree.first.size != nodes || tree.count.size != nodes)
        return false;
    for (int64_t node = 0; node < seen; node++) {
        int64_t begin = tree.first.data[node], held = tree.count.data[node];
        if (held < 0 || begin < 0 || (held > 0 ? begin > m - held : begin <= node || begin >= nodes)) return false;
        if (held == 0) seen = largest(seen, largest(begin, node + 1) + 1);
        if (seen > nodes) return false;
    }
    return true;
}
inline bool add_copies(
    Doubles2 sums, Doubles total, ConstInts vertices, ConstDoubles2 positions, ConstDoubles weights) {
    return triples(total.size, sums) && triples(vertices.size, positions) && weights.size == vertices.size
        && below(vertices, total.size);
}
inline bool face_patches(ConstInts2 faces, Lists around, int64_t crowd, Ints seen, Longs starts, Ints members) {
    int64_t n = around.starts.size - 1, m = faces.rows, room = m;
    if (faces.columns != 3 || !graph(around, n, m) || !below(faces, n) || crowd < 0 || seen.size != m
        || starts.size != m + 1)
        return false;
    for (int64_t k = 0; k < 3 * m; k++) {
        int64_t size = around.starts.data[faces.data[k] + 1] - around.starts.data[faces.data[k]];
        room += size > crowd ? 0 : size;
    }
    return members.size >= room;
}
inline bool reach(ConstDoubles2 points, Lists adjacent, double, int64_t most, int64_t begin, Ints seen,
    Longs reached_starts, Ints) {
    int64_t n = points.rows;
    return triples(n, points) && graph(adjacent, n, n) && most > 0 && begin >= 0 && begin <= n && seen.size == n
        && reached_starts.size == n + 1 && reached_starts.data[begin] >= 0;
}
inline bool pair_distances(ConstDoubles2 values, ConstInts2 pairs, Doubles distances) {
    return triples(values.rows, values) && pairs.columns == 2 && distances.size == pairs.rows
        && below(pairs, values.rows);
}
inline bool follow_normals(Doubles2 positions, ConstInts2 faces, Lists around, ConstDoubles2 normals, int64_t,
    ConstBytes free, Doubles2 planes, Doubles2 sums) {
    int64_t n = positions.rows, m = faces.rows;
    return triples(n, positions) && faces.columns == 3 && below(faces, n) && graph(around, n, m)
        && triples(m, normals) && free.size == n && planes.rows == m && planes.columns == 4 && sums.rows == n
        && sums.columns == 16;
}
inline bool filter_normals(FaceGeometry faces, ConstDoubles2 guide, Lists near, double, double, Doubles2 packed,
    Doubles2 filtered) {
    int64_t m = faces.normals.rows;
    return geometry(faces) && triples(m, guide) && graph(near, m, m) && packed.rows == m && packed.columns == 8
        && triples(m, filtered);
}
inline bool patch_guidance(ConstDoubles2 normals, ConstDoubles areas, Lists patches, ConstDoubles steps, Lists inner,
    Doubles scores, Doubles2 means, Doubles2 guide) {
    int64_t m = normals.rows;
    return triples(m, normals) && areas.size == m && graph(patches, m, m, 1)
        && graph(inner, m, steps.size) && scores.size == m && triples(m, means) && triples(m, guide);
}
inline bool describe_faces(FaceGeometry faces, Filtered filtered, Lists near, double, int64_t begin, Doubles2 described,
    Doubles2 frames) {
    int64_t m = faces.normals.rows;
    return geometry(faces) && triples(m, filtered.guide) && triples(m, filtered.smooth) && triples(m, filtered.axes)
        && graph(near, m, m) && begin >= 0 && begin <= m - described.rows
        && described.columns >= DESCRIBED && frames.rows == described.rows && frames.columns == 9;
}
inline bool cosines(Doubles table, Doubles2 columns) { return table.size >= columns.rows + 8; }
inline bool project(ConstSingles2 subspace, ConstDoubles2 values, Doubles2 coefficients) {
    return subspace.rows == values.rows && coefficients.rows <= subspace.columns
        && coefficients.columns == values.columns;
}
inline bool reconstruct(ConstSingles2 subspace, ConstDoubles2 coefficients, Doubles2 values) {
    return subspace.rows == values.rows && coefficients.rows <= subspace.columns
        && coefficients.columns == values.columns;
}


// Kernels that compare sizes themselves: their indices.
inline bool label_components(ConstInts offsets, ConstInts neighbors, Ints, Ints) {
    return fits_rows(offsets, neighbors, offsets.size - 1, offsets.size - 1);
}
inline bool smooth_all(ConstInts offsets, ConstInts neighbors, ConstDoubles2, double, Doubles, Doubles2) {
    return fits_rows(offsets, neighbors, offsets.size - 1, offsets.size - 1);
}
inline bool edges(ConstInts offsets, ConstInts neighbors) {
    return offsets.size > 0 && fits_rows(offsets, neighbors, offsets.size - 1, offsets.size - 1);
}
inline bool find_cells(ConstInts offsets, ConstInts neighbors, int64_t reach, Bytes far, Ints waiting, Ints own) {
    int64_t n = offsets.size - 1;
    return edges(offsets, neighbors) && reach >= 0 && reach < 255 && far.size == n && waiting.size == n
        && own.size == n;
}
inline bool link_cells(ConstInts offsets, ConstInts neighbors, ConstInts own, Ints bounds, Ints order, Ints filled,
    Ints found, Ints links, Ints ends) {
    int64_t n = offsets.size - 1, cells = links.size - 1;
    return edges(offsets, neighbors) && own.size == n && below(own, cells) && bounds.size == cells + 1
        && order.size == n && filled.size == cells && found.size > neighbors.size && ends.size > neighbors.size;
}
inline bool cell_faces(
    ConstInts2 faces, ConstInts own, Ints counts, Ints2 found, Ints order, Ints sorted, Ints2 kept) {
    int64_t m = faces.rows;
    return faces.columns == 3 && below(faces, own.size) && below(own, counts.size - 1) && found.rows == m
        && found.columns == 3 && order.size == m && sorted.size == m && kept.rows == m && kept.columns == 3;
}
inline bool prolong(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstDoubles2 places, int64_t, Singles,
    Doubles2) {
    return edges(offsets, neighbors) && below(own, places.rows);
}
inline bool fit_cells(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstInts links, ConstInts linked,
    ConstDoubles2, int64_t, int64_t, Singles, Doubles2) {
    return edges(offsets, neighbors) && edges(links, linked) && below(own, links.size - 1);
}
inline bool local_frames(ConstDoubles2 positions, ConstInts2 faces, Doubles2) { return below(faces, positions.rows); }
inline bool tangent_steps(ConstDoubles2 positions, ConstInts2 faces, double, double, Doubles2, Doubles) {
    return below(faces, positions.rows);
}
inline bool collect_flaps(ConstInts2 faces, ConstInts starts, ConstInts members, Ints, Ints2) {
    return below(faces, starts.size - 1) && fits_rows(starts, members, starts.size - 1, starts.size - 1);
}
inline bool count_folds(ConstDoubles2 positions, ConstInts2 flaps) { return below(flaps, positions.rows); }
inline bool wanted(const Wanted &given) {
    int64_t n = given.positions.rows;
    return below(given.faces, n) && graph(Lists{given.around_starts, given.around}, n, given.faces.rows)
        && fits_rows(given.beside_starts, given.beside, n, n);
}
inline bool shape_levels(Wanted given, Aim, Doubles2, Ints2, ConstDoubles2, ConstDoubles, double, Bytes) {
    return wanted(given);
}
inline bool shape_grid(Wanted given, Aim, Doubles2, Ints2, double, ConstInts2 flaps, ConstInts starts,
    ConstInts members, Ints2, ConstDoubles, Bytes) {
    int64_t n = given.positions.rows;
    return wanted(given) && below(flaps, n) && fits_rows(starts, members, n, 2 * flaps.rows);
}
inline bool unfold_levels(Wanted given, ConstDoubles, Doubles2, Ints2, ConstDoubles2, ConstInts2 flaps,
    ConstInts starts, ConstInts members, int64_t, Bytes, Bytes) {
    int64_t n = given.positions.rows;
    return wanted(given) && below(flaps, n) && fits_rows(starts, members, n, 2 * flaps.rows);
}

}  // namespace guards
