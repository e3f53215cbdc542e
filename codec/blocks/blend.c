/* Weighted sums over the copies of each vertex (paper, Algorithm 3; specification, M 12). */
#include "codec/blocks/blend.h"

/* Add one copy of each of `vertices`, all below `total.size`. */
void add_copies(Doubles2 sums, Doubles total, ConstInts vertices, ConstDoubles2 positions, ConstDoubles weights) {
    int64_t count = least(vertices.size, least(positions.rows, weights.size));
    for (int64_t r = 0; r < count; r++) {
        int64_t v = vertices.data[r];
        double weight = weights.data[r];
        total.data[v] += weight;
        for (int d = 0; d < 3; d++) sums.data[3 * v + d] += weight * positions.data[3 * r + d];
    }
}
