/* Frames of the components of a field (specification, S 7.1): each of its coordinates in as many frames as a vector has
 * numbers. */
#include "codec/basis/vectors.h"
#include "codec/sequence/kernels.h"

/* Some vertices from v on, and some coordinates side by side, of which the first is in `column` of the weights. */
INLINE void show_vertices(const int rows, const int vectors, ConstDoubles2 field, int64_t first, ConstDoubles2 weights,
                          int64_t v, int64_t column, Doubles2 frames) {
    const double *from = field.data + v * field.columns + first, *right = weights.data + column;
    Vector sums[ROWS][VECTORS];
    EACH(i, rows) EACH(a, vectors) sums[i][a] = zeros();
    for (int64_t k = 0; k < weights.rows; k++, right += weights.columns)
        EACH(i, rows) EACH(a, vectors)
            sums[i][a] = add_scaled(sums[i][a], from[i * field.columns + k], load(right + a * WIDTH));
    double lanes[ROWS][VECTORS][WIDTH];
    EACH(i, rows) EACH(a, vectors) store(lanes[i][a], sums[i][a]);
    double *to = frames.data + v * frames.columns + column / WIDTH;
    int64_t count = frames.rows / field.rows;
    for (int64_t t = 0; t < count; t++, to += field.rows * frames.columns)
        EACH(i, rows) EACH(a, vectors) to[i * frames.columns + a] = lanes[i][a][t];
}

/* Some coordinates of all vertices. */
INLINE void show_coordinates(const int vectors, int64_t column, ConstDoubles2 field, int64_t first, ConstDoubles2 weights,
                             Doubles2 frames) {
    int64_t v = 0;
    for (; v + ROWS <= field.rows; v += ROWS)
        show_vertices(ROWS, vectors, field, first, weights, v, column, frames);
    for (; v < field.rows; v++) show_vertices(1, vectors, field, first, weights, v, column, frames);
}

/* Up to WIDTH frames, one below the other, of d coordinates, from as many columns of a field, from `first` on, as there
 * are rows of `weights`. A coordinate has WIDTH columns of these, one for each frame. */
int64_t LEVEL(show_frames)(ConstDoubles2 field, int64_t first, ConstDoubles2 weights, Doubles2 frames) {
    int64_t columns = weights.columns;
    if (first < 0 || first + weights.rows > field.columns || columns != WIDTH * frames.columns ||
        (field.rows ? frames.rows % field.rows || frames.rows > WIDTH * field.rows : frames.rows != 0))
        return MISUSED;
    int64_t column = 0;
    for (; column + LANES <= columns; column += LANES)
        WITH_VECTORS(VECTORS, column, show_coordinates, field, first, weights, frames);
    if (column < columns)
        WITH_VECTORS((columns - column) / WIDTH, column, show_coordinates, field, first, weights, frames);
    return 0;
}
