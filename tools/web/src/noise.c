/* Fixed pseudo-random numbers for the columns that dictionaries start from. */
#include "bitstream/kernel.h"

/* Add `share` of the numbers in [-1, 1) that belong to row and column (specification, M 8.6). */
void add_noise(Doubles2 columns, double share) {
    for (int64_t row = 0; row < columns.rows; row++)
        for (int64_t column = 0; column < columns.columns; column++) {
            uint64_t z = (((uint64_t)row << 32) + (uint64_t)column + 1) * 0x9e3779b97f4a7c15u;
            z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
            z = (z ^ z >> 27) * 0x94d049bb133111ebu;
            columns.data[row * columns.columns + column] += share * ((double)((z ^ z >> 31) >> 11) * 0x1p-52 - 1);
        }
}
