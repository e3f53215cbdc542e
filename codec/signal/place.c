/* Positions of a block from its levels (specification, M 10.2): what is expected, and U times the coefficients. */
#include "codec/signal/place.h"

#include "bitstream/coefficients/trellis.h"
#include "codec/signal/transform.h"

/* `levels` are those of M 9.11, a row for each of the first columns of U; `scratch` has room for a number for each. */
int64_t place_block(ConstDoubles2 prediction, ConstDoubles2 subspace, ConstInts2 levels, double half_step, Doubles scratch,
                    Doubles2 positions) {
    int64_t n = subspace.rows, count = 3 * levels.rows;
    if (prediction.rows != n || positions.rows != n || prediction.columns != 3 || positions.columns != 3 ||
        levels.columns != 3 || levels.rows > subspace.columns || scratch.size < count)
        return MISUSED;
    values_of_levels(levels.data, count, half_step, scratch.data);
    reconstruct(subspace, (ConstDoubles2){scratch.data, levels.rows, 3}, positions);
    for (int64_t i = 0; i < 3 * n; i++) positions.data[i] += prediction.data[i];
    return 0;
}
