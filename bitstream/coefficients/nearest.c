/* Levels nearest to a block's coefficients: the way through the trellis of the least squared error, by dynamic
 * programming (an encoder's choice, no part of the format). */
#include "bitstream/coefficients/coefficients.h"

enum { STATES = TRELLIS_STATES };

#define NEVER __builtin_inf()

/* Levels for targets in 1 / TARGET_UNIT of a step, coefficient by coefficient. Zeros stay zero, so flat meshes stay
 * flat. `ways` and `origins` are scratch with a row of STATES for each coefficient. */
KERNEL void nearest_levels(ConstLongs targets, int32_t *ways, uint8_t *origins, int32_t *levels) {
    int64_t count = targets.size;
    double errors[2][STATES];
    for (int s = 0; s < STATES; s++) errors[0][s] = s == 0 ? 0.0 : NEVER;
    for (int64_t i = 0; i < count; i++) {
        int64_t target = targets.data[i] < 0 ? -targets.data[i] : targets.data[i];
        double *old = errors[i & 1], *new = errors[~i & 1];
        for (int s = 0; s < STATES; s++) new[s] = NEVER;
        for (int state = 0; state < STATES; state++) {
            if (old[state] == NEVER) continue;
            int64_t below = (2 * target + TARGET_UNIT * trellis_grid(state)) / (2 * TARGET_UNIT);
            for (int candidate = 0; candidate < (target > 0 ? 2 : 1); candidate++) {
                int32_t level = (int32_t)least(below + candidate, MAX_LEVEL);
                double error = (double)target - 0.5 * TARGET_UNIT * trellis_point(state, level);
                int after = trellis_following(state, level);
                if (old[state] + error * error >= new[after]) continue;
                new[after] = old[state] + error * error;
                ways[STATES * i + after] = level;
                origins[STATES * i + after] = (uint8_t)state;
            }
        }
    }
    int state = 0;
    for (int s = 1; s < STATES; s++)
        if (errors[count & 1][s] < errors[count & 1][state]) state = s;
    for (int64_t i = count; i-- > 0;) {
        int32_t level = ways[STATES * i + state];
        levels[i] = targets.data[i] >= 0 ? level : -level;
        state = origins[STATES * i + state];
    }
}
