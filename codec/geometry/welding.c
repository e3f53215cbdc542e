/* Equal rows of a table. */
#include "codec/geometry/geometry.h"

/* The number of what each row is equal to, bit for bit, in order of first appearance; returns how many there are.
 * `places` is scratch, a power of two of entries, more than rows. The `seed` is random: nobody can choose rows that
 * meet at one place. */
int64_t equal_rows(ConstLongs2 rows, int64_t seed, Ints places, Ints numbers) {
    int64_t count = 0, mask = places.size - 1;
    if (places.size <= rows.rows || (places.size & mask) || numbers.size != rows.rows || rows.rows > INT32_MAX)
        return MISUSED;
    for (int64_t i = 0; i < places.size; i++) places.data[i] = -1;
    for (int64_t i = 0; i < rows.rows; i++) {
        const int64_t *row = rows.data + i * rows.columns;
        uint64_t mixed = (uint64_t)seed;
        for (int64_t k = 0; k < rows.columns; k++) {
            mixed = (mixed ^ (uint64_t)row[k]) * 0x9E3779B97F4A7C15u;
            mixed ^= mixed >> 29;
        }
        mixed *= 0xBF58476D1CE4E5B9u;
        int64_t place = (int64_t)(mixed >> 20) & mask;
        for (;; place = (place + 1) & mask) {
            int32_t other = places.data[place];
            if (other < 0) {
                places.data[place] = (int32_t)i;
                numbers.data[i] = (int32_t)count++;
                break;
            }
            const int64_t *known = rows.data + other * rows.columns;
            int64_t k = 0;
            while (k < rows.columns && known[k] == row[k]) k++;
            if (k < rows.columns) continue;
            numbers.data[i] = numbers.data[other];
            break;
        }
    }
    return count;
}
