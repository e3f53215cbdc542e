/* Positions of values on a grid (specification, V 12). */
#include "bitstream/kernel.h"

enum { AXES = 3 };

/* The cell of a value, in integers; what a grid without a lattice has are cells. */
static int64_t cell_of(int64_t value, int64_t cells, int64_t points) {
    return points > 0 ? (2 * value * cells + points) / (2 * points) : value;
}

/* Place `vertices`, a row each, and in the rows of all. `frame`: corner, center, scale. False if one is not finite. */
int64_t place_values(ConstInts2 values, ConstInts vertices, int64_t cells, int64_t points, ConstDoubles frame,
    Doubles2 places, Doubles2 all) {
    if (values.columns != AXES || places.columns != AXES || all.columns != AXES || all.rows != values.rows
        || places.rows != vertices.size || frame.size != 2 * AXES + 1)
        return MISUSED;
    double probe = 0;
    for (int64_t i = 0; i < vertices.size; i++) {
        int64_t v = vertices.data[i];
        if (v < 0 || v >= values.rows) return MISUSED;
        for (int j = 0; j < AXES; j++) {
            double place = (double)cell_of(values.data[AXES * v + j], cells, points) + frame.data[j];
            place = place * frame.data[2 * AXES] + frame.data[AXES + j];
            probe += 0 * place;
            places.data[AXES * i + j] = all.data[AXES * v + j] = place;
        }
    }
    return probe == 0;
}
