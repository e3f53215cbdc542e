/* From BSM units to the unit of the mesh. */
#include "codec/geometry/geometry.h"

enum { AXES = 3, TOGETHER = 8 * AXES };

/* `moved` may be `positions`. Whether all of it is finite. */
KERNEL int64_t back_into_unit(ConstDoubles2 positions, double scale, ConstDoubles center, Doubles2 moved) {
    int64_t size = positions.rows * AXES, i = 0;
    if (positions.columns != AXES || center.size != AXES || moved.rows != positions.rows || moved.columns != AXES)
        return MISUSED;
    /* of a number that is not finite, what it is off itself is none */
    double middle[TOGETHER], spoiled[TOGETHER] = {0.0};
    for (int j = 0; j < TOGETHER; j++) middle[j] = center.data[j % AXES];
    for (; i + TOGETHER <= size; i += TOGETHER)
        for (int j = 0; j < TOGETHER; j++) {
            double value = positions.data[i + j] * scale + middle[j];
            moved.data[i + j] = value;
            spoiled[j] += value - value;
        }
    for (int j = 0; i + j < size; j++) {
        double value = positions.data[i + j] * scale + middle[j];
        moved.data[i + j] = value;
        spoiled[j] += value - value;
    }
    for (int j = 0; j < TOGETHER; j++)
        if (spoiled[j] != 0.0) return 0;
    return 1;
}
