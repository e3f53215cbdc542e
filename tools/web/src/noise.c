/* Fixed pseudo-random numbers for the columns that dictionaries start from. */
#include "codec/basis/basis.h"

/* Add `share` of the hash columns (specification, M 8.3, M 8.6). */
void add_noise(Singles2 columns, double share) {
    for (int64_t row = 0; row < columns.rows; row++)
        for (int64_t column = 0; column < columns.columns; column++)
            columns.data[row * columns.columns + column] += (float)(share * hash_at(row, column));
}
