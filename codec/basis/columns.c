/* Hash columns (specification, M 8.6): fixed pseudo-random numbers in [-1, 1), the same on every machine. */
#include "codec/basis/basis.h"

KERNEL void hash_columns(Doubles2 columns) {
    for (int64_t r = 0; r < columns.rows; r++)
        for (int64_t j = 0; j < columns.columns; j++) columns.data[r * columns.columns + j] = hash_at(r, j);
}
