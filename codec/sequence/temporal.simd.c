/* The temporal transform (specification, S 5, S 7): columns at right angles, and frames of the components of a field,
 * each of its coordinates in as many frames as a vector has numbers. */
#define VECTORS_OF_DOUBLES
#include "codec/basis/vectors.h"
#include "codec/sequence/temporal.h"

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
INLINE void show_coordinates(const int vectors, int64_t column, ConstDoubles2 field, int64_t first,
    ConstDoubles2 weights, Doubles2 frames) {
    int64_t v = 0;
    for (; v + ROWS <= field.rows; v += ROWS)
        show_vertices(ROWS, vectors, field, first, weights, v, column, frames);
    for (; v < field.rows; v++) show_vertices(1, vectors, field, first, weights, v, column, frames);
}

/* Up to WIDTH frames, one below the other, of d coordinates, from as many columns of a field, from `first` on, as there
 * are rows of `weights`. A coordinate has WIDTH columns of these, one for each frame. */
int64_t ISA(show_frames)(ConstDoubles2 field, int64_t first, ConstDoubles2 weights, Doubles2 frames) {
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

/* Add a multiple of a row to another. */
INLINE void add_row(double *to, double scalar, const double *from, int64_t count) {
    int64_t i = 0;
    for (; i + WIDTH <= count; i += WIDTH) store(to + i, add_scaled(load(to + i), scalar, load(from + i)));
    for (; i < count; i++) to[i] += scalar * from[i];
}

/* Columns at right angles, of what is free in them, which they overwrite (S 5.3). `vector` has room for a column,
 * `shares` for a row. */
int64_t ISA(turn_columns)(Doubles2 free, Doubles vector, Doubles shares) {
    int64_t rows = free.rows, columns = free.columns;
    if (columns > rows || vector.size < rows || shares.size < columns) return MISUSED;
    double *v = vector.data;
    for (int64_t k = columns - 1; k >= 0; k--) {
        double square = 0.0, turned = 0.0;
        for (int64_t r = k; r < rows; r++) {
            v[r] = free.data[r * columns + k];
            square += v[r] * v[r];
        }
        if (!(square > 0.0)) continue;
        v[k] += v[k] < 0.0 ? -__builtin_sqrt(square) : __builtin_sqrt(square);
        for (int64_t r = k; r < rows; r++) turned += v[r] * v[r];
        int64_t count = columns - k - 1;
        for (int64_t i = 0; i < count; i++) shares.data[i] = 0.0;
        for (int64_t r = k; r < rows; r++) add_row(shares.data, v[r], free.data + r * columns + k + 1, count);
        for (int64_t i = 0; i < count; i++) shares.data[i] *= 2.0 / turned;
        for (int64_t r = k; r < rows; r++) add_row(free.data + r * columns + k + 1, -v[r], shares.data, count);
    }
    return 0;
}
