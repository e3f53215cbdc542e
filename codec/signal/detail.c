/* Vertex normals of a block from the faces inside it, and the detail layer along them (specification, M 11.3). */
#include "codec/signal/detail.h"

#include "bitstream/coefficients/trellis.h"
#include "codec/signal/transform.h"

/* A position or a direction, and a number that does not count. */
typedef double Four __attribute__((vector_size(32)));
typedef double UnalignedFour __attribute__((vector_size(32), aligned(8), may_alias));

/* Row r; what is read beyond it is in the next row, but for the last row. */
INLINE Four point(ConstDoubles2 positions, int64_t r) {
    const double *row = positions.data + 3 * r;
    if (r + 1 == positions.rows) return (Four){row[0], row[1], row[2], 0.0};
    return *(const UnalignedFour *)row;
}

/* y, z and x. */
INLINE Four turned(Four v) { return (Four){v[1], v[2], v[0], v[3]}; }

INLINE Four cross(Four u, Four v) { return turned(u) * turned(turned(v)) - turned(turned(u)) * turned(v); }

/* Normals at the rows of the block of `vertices`, from its own `positions`. `members` are the faces around each vertex;
 * `place`, one entry a vertex of the mesh, is scratch: zero before and after. */
KERNEL void block_normals(ConstInts2 faces, ConstLongs starts, ConstInts members, ConstInts vertices, Ints place,
                          ConstDoubles2 positions, double softness, double least_length, Doubles2 normals) {
    int64_t n = vertices.size;
    for (int64_t r = 0; r < n; r++) place.data[vertices.data[r]] = (int32_t)r + 1;
    double total = 0.0;
    for (int64_t r = 0; r < n; r++) {
        Four sum = {0.0, 0.0, 0.0, 0.0};
        for (int64_t k = starts.data[vertices.data[r]]; k < starts.data[vertices.data[r] + 1]; k++) {
            const int32_t *face = faces.data + 3 * (int64_t)members.data[k];
            int64_t a = place.data[face[0]], b = place.data[face[1]], c = place.data[face[2]];
            if (a == 0 || b == 0 || c == 0) continue;
            Four corner = point(positions, a - 1);
            sum += cross(point(positions, b - 1) - corner, point(positions, c - 1) - corner);
        }
        double *normal = normals.data + 3 * r;
        for (int d = 0; d < 3; d++) normal[d] = sum[d];
        total += sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2];
    }
    double soft = softness * softness * total / (double)n + least_length * least_length;
    for (int64_t r = 0; r < n; r++) {
        double *normal = normals.data + 3 * r;
        double length = __builtin_sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2] + soft);
        for (int d = 0; d < 3; d++) normal[d] /= length;
    }
    for (int64_t r = 0; r < n; r++) place.data[vertices.data[r]] = 0;
}

/* Move a block along its normals by U e: e are the coefficients of the first `count` of the levels, which successive
 * frequencies have in rows of three. `scratch` has room for them, and for four numbers for each row of the block. */
int64_t raise_block(ConstInts2 faces, ConstLongs starts, ConstInts members, ConstInts vertices, Ints place,
                    double softness, double least_length, ConstDoubles2 subspace, ConstInts2 levels, int64_t count,
                    double half_step, Doubles scratch, Doubles2 positions) {
    int64_t n = vertices.size;
    if (starts.size != place.size + 1 || members.size < starts.data[place.size] || subspace.rows != n ||
        positions.rows != n || positions.columns != 3 || count < 0 || count > subspace.columns ||
        count > levels.rows * levels.columns || scratch.size < 4 * n + count)
        return MISUSED;
    Doubles2 normals = {scratch.data, n, 3}, height = {scratch.data + 3 * n, n, 1};
    double *values = scratch.data + 4 * n;
    block_normals(faces, starts, members, vertices, place, (ConstDoubles2){positions.data, n, 3}, softness, least_length,
                  normals);
    values_of_levels(levels.data, count, half_step, values);
    reconstruct(subspace, (ConstDoubles2){values, count, 1}, height);
    for (int64_t r = 0; r < n; r++)
        for (int d = 0; d < 3; d++) positions.data[3 * r + d] += normals.data[3 * r + d] * height.data[r];
    return 0;
}
