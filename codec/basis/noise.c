/* Hash columns (specification, M 8.6): fixed pseudo-random numbers in [-1, 1), the same on every machine. */
#include "codec/basis/noise.h"

/* Overwrite each entry by the splitmix64 of row * 2^32 + column. */
KERNEL void hash_columns(Doubles2 columns) {
    for (int64_t r = 0; r < columns.rows; r++)
        for (int64_t j = 0; j < columns.columns; j++) {
            uint64_t z = (((uint64_t)r << 32) + (uint64_t)j + 1) * 0x9E3779B97F4A7C15u;
            z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
            z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
            columns.data[r * columns.columns + j] = (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
        }
}
