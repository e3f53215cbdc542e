/* Levels of a block to points: coefficients in half steps (specification, M 9.11). */
#include "bitstream/coefficients/trellis.h"

void points_of_levels(ConstInts2 levels, Ints2 points) {
    int64_t count = least(levels.rows * levels.columns, points.rows * points.columns);
    int state = 0;
    for (int64_t i = 0; i < count; i++) {
        int32_t level = levels.data[i];
        points.data[i] = trellis_point(state, level);
        state = trellis_following(state, level);
    }
}
