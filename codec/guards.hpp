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
template <typename... Arrays> bool sized(int64_t size, Arrays... arrays) { return ((arrays.size == size) && ...); }
template <typename... Arrays> bool rows_of(int64_t columns, int64_t rows, Arrays... arrays) {
    return ((arrays.rows == rows && arrays.columns == columns) && ...);
}
template <typename... Arrays> bool triples(int64_t rows, Arrays... arrays) { return rows_of(3, rows, arrays...); }
inline bool corners(ConstInts2 faces, int64_t vertices) { return faces.columns == 3 && below(faces, vertices); }
inline bool edges(ConstInts offsets, ConstInts neighbors) {
    return offsets.size > 0 && fits_rows(offsets, neighbors, offsets.size - 1, offsets.size - 1);
}

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
    return triples(m, faces.centroids, faces.normals) && faces.areas.size == m;
}

inline bool collect_edges(ConstInts2 faces, Ints offsets, Ints filled, Ints ends, Ints second) {
    return offsets.size > 0 && corners(faces, offsets.size - 1) && filled.size >= offsets.size - 1
        && ends.size >= 6 * faces.rows && second.size >= 6 * faces.rows;
}
inline bool vertex_faces(ConstInts2 faces, Longs starts, Ints members) {
    return starts.size > 0 && below(faces, starts.size - 1) && members.size >= faces.rows * faces.columns;
}
inline bool geometric_laplacian(ConstDoubles2 positions, Lists neighbors, Doubles2 result) {
    int64_t n = positions.rows;
    return triples(n, positions, result) && graph(neighbors, n, n);
}
inline bool face_geometry(
    ConstDoubles2 positions, ConstInts2 faces, Doubles2 centroids, Doubles areas, Doubles2 normals, Bytes whole) {
    int64_t m = faces.rows;
    return positions.columns == 3 && corners(faces, positions.rows) && triples(m, centroids, normals) && areas.size == m
        && (whole.size == 0 || whole.size == m);
}
inline bool weighted_angle(
    ConstDoubles2 normals, ConstDoubles weights, ConstDoubles2 decoded, ConstInts2 faces, double) {
    return triples(faces.rows, normals) && weights.size == faces.rows && decoded.columns == 3
        && corners(faces, decoded.rows);
}
inline bool build_tree(ConstDoubles2 lowest, ConstDoubles2 highest, Longs order, Doubles2 low, Doubles2 high,
    Longs first, Longs count) {
    int64_t m = lowest.rows, nodes = 2 * m + 1;
    return triples(m, lowest, highest) && order.size == m && triples(nodes, low, high) && sized(nodes, first, count);
}
// A node without triangles has its other child after it, so that a walk ends; how deep it goes the kernel bounds.
inline bool nearest_distances(ConstDoubles2 points, Tree tree, Doubles, Longs) {
    int64_t m = tree.triangles.rows, nodes = 2 * m + 1, seen = 1;
    if (points.columns != 3 || tree.triangles.columns != 9 || m < 1 || tree.order.size != m
        || !triples(nodes, tree.low, tree.high) || !sized(nodes, tree.first, tree.count))
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
inline bool reach(ConstDoubles2 points, Lists adjacent, double, int64_t most, int64_t begin, Ints seen,
    Longs reached_starts, Ints) {
    int64_t n = points.rows;
    return points.columns == 3 && graph(adjacent, n, n) && most > 0 && begin >= 0 && begin <= n && seen.size == n
        && reached_starts.size == n + 1 && reached_starts.data[begin] >= 0;
}
inline bool follow_normals(Doubles2 positions, ConstInts2 faces, Lists around, ConstDoubles2 normals, int64_t,
    ConstBytes free, Doubles heights) {
    int64_t n = positions.rows, m = faces.rows;
    return positions.columns == 3 && corners(faces, n) && graph(around, n, m) && triples(m, normals) && free.size == n
        && heights.size == m;
}
inline bool weighed_normals(FaceGeometry faces, ConstDoubles2 guide, Lists near, double, double, Doubles2 packed,
    Doubles2 sums) {
    int64_t m = faces.normals.rows;
    return geometry(faces) && triples(m, guide) && graph(near, m, m) && rows_of(8, m, packed) && rows_of(4, m, sums);
}
inline bool patch_guidance(ConstDoubles2 normals, ConstDoubles areas, Lists patches, ConstDoubles steps, Lists inner,
    Doubles scores, Doubles2 means, Doubles2 guide) {
    int64_t m = normals.rows;
    return triples(m, normals, means, guide) && sized(m, areas, scores) && graph(patches, m, m, 1)
        && graph(inner, m, steps.size);
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
    return edges(offsets, neighbors);
}
inline bool smooth_all(ConstInts offsets, ConstInts neighbors, ConstDoubles2, double, Doubles, Doubles2) {
    return edges(offsets, neighbors);
}
inline bool prolong(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstDoubles2 places, int64_t, Singles,
    Doubles2) {
    return edges(offsets, neighbors) && below(own, places.rows);
}
inline bool fit_cells(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstInts links, ConstInts linked,
    ConstDoubles2, int64_t, double, int64_t, Singles, Doubles2, Doubles2) {
    return edges(offsets, neighbors) && edges(links, linked) && below(own, links.size - 1);
}
inline bool couple_cells(ConstInts offsets, ConstInts neighbors, ConstInts bounds, ConstInts order, ConstInts links,
    ConstInts linked, int64_t, double, Singles, Ints, Ints, Singles, Doubles, Longs, Ints, Singles) {
    return edges(offsets, neighbors) && edges(links, linked)
        && fits_rows(bounds, order, links.size - 1, offsets.size - 1);
}
inline bool level_cells(ConstLongs starts, ConstInts ends, ConstSingles values, ConstDoubles weights, ConstDoubles2,
    ConstDoubles2, int64_t, Doubles2, Ints2) {
    return values.size == ends.size && graph(Lists{starts, ends}, weights.size, weights.size);
}
inline bool local_frames(ConstDoubles2 positions, ConstInts2 faces, Doubles2) { return below(faces, positions.rows); }
inline bool tangent_steps(ConstDoubles2 positions, ConstInts2 faces, double, double, Doubles2, Doubles) {
    return below(faces, positions.rows);
}
inline bool collect_flaps(ConstInts2 faces, ConstInts starts, ConstInts members, Ints, Ints2) {
    return edges(starts, members) && below(faces, starts.size - 1);
}
inline bool count_folds(ConstDoubles2 positions, ConstInts2 flaps, Bytes) { return below(flaps, positions.rows); }
inline bool wanted(const Wanted &given) {
    int64_t n = given.positions.rows;
    return below(given.faces, n) && graph(Lists{given.around_starts, given.around}, n, given.faces.rows)
        && fits_rows(given.beside_starts, given.beside, n, n);
}
inline bool flapped(const Wanted &given, Flaps edges) {
    int64_t n = given.positions.rows;
    return wanted(given) && below(edges.rows, n) && fits_rows(edges.starts, edges.members, n, 2 * edges.rows.rows);
}
inline bool shape_levels(Wanted given, Aim, Shaped, ConstDoubles2, ConstDoubles, double) { return wanted(given); }
inline bool shape_grid(Wanted given, Aim, Shaped, double, Flaps edges, Ints2, ConstDoubles) {
    return flapped(given, edges);
}
inline bool unfold_levels(Wanted given, ConstDoubles, Shaped, ConstDoubles2, Flaps edges, int64_t, ConstBytes) {
    return flapped(given, edges);
}

}  // namespace guards
