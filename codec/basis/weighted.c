/* Laplacians with cotangent weights (Pinkall and Polthier 1993; specification, S 3.1 and S 3.2). */
#include "codec/basis/weighted.h"

/* Index of the first entry that is not below `value`, in an ascending list from `low` to before `high`. */
static int64_t lower_bound(const int32_t *list, int64_t low, int64_t high, int32_t value) {
    while (low < high) {
        int64_t middle = (low + high) / 2;
        if (list[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Half the sum of the cotangents opposite to each edge, added to `weights`, one for every entry of `neighbours`; the
 * graph has every edge of `faces`. */
void cotangents(ConstInts offsets, ConstInts neighbours, ConstInts2 faces, ConstDoubles2 positions, Doubles weights) {
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        for (int corner = 0; corner < 3; corner++) {
            int32_t a = face[corner], b = face[(corner + 1) % 3], c = face[(corner + 2) % 3];
            if (a == b || a == c || b == c) continue;
            const double *p = positions.data + 3 * (int64_t)a, *q = positions.data + 3 * (int64_t)b;
            const double *s = positions.data + 3 * (int64_t)c;
            double ux = q[0] - p[0], uy = q[1] - p[1], uz = q[2] - p[2];
            double vx = s[0] - p[0], vy = s[1] - p[1], vz = s[2] - p[2];
            double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
            double area = __builtin_sqrt(x * x + y * y + z * z);
            if (!(area > 0.0)) continue;
            double half = 0.5 * (ux * vx + uy * vy + uz * vz) / area;
            weights.data[lower_bound(neighbours.data, offsets.data[b], offsets.data[b + 1] - 1, c)] += half;
            weights.data[lower_bound(neighbours.data, offsets.data[c], offsets.data[c + 1] - 1, b)] += half;
        }
    }
}

/* The Laplacian of the part with the given vertices, ascending, and the springs on which it hangs; returns how many these
 * are. `matrix` is zero before; there is room for as many springs as the vertices have neighbours. */
int64_t hold(ConstInts offsets, ConstInts neighbours, ConstDoubles weights, ConstInts vertices, ConstInts rank,
             Doubles2 matrix, Ints rows, Ints outer, Doubles stiffness) {
    int64_t n = vertices.size, springs = 0;
    int32_t own = rank.data[vertices.data[0]];
    for (int64_t r = 0; r < n; r++) {
        int32_t v = vertices.data[r];
        for (int64_t i = offsets.data[v]; i < offsets.data[v + 1]; i++) {
            int32_t w = neighbours.data[i];
            if (rank.data[w] > own) continue;
            matrix.data[r * n + r] += weights.data[i];
            if (rank.data[w] == own) {
                int64_t column = lower_bound(vertices.data, 0, n, w);
                if (column < n) matrix.data[r * n + column] -= weights.data[i];
            } else {
                rows.data[springs] = (int32_t)r;
                outer.data[springs] = w;
                stiffness.data[springs++] = weights.data[i];
            }
        }
    }
    return springs;
}
