/* Where the rows of a binary table begin when their lists differ in length (PLY: each list begins with its length). */
#include "bitstream/kernel.h"

/* The number in the first `width` bytes, which the caller has found to be there. */
static uint64_t read_number(const uint8_t *bytes, int64_t width, bool big_endian) {
    uint64_t number = 0;
    for (int64_t i = 0; i < width; i++) number = number << 8 | bytes[big_endian ? i : width - 1 - i];
    return number;
}

/* Walk over as many rows as `starts` has entries. Returns where the last ends; negative, minus where the walk stopped,
 * if a row runs over the end. `widths`: for each property the bytes of its list's length (0: it is a number), and the
 * bytes of one item; `place` is the property whose lists are wanted. */
int64_t walk_rows(
    ConstBytes raw, int64_t offset, ConstLongs2 widths, int64_t place, bool big_endian, Longs starts, Longs sizes) {
    if (offset < 0 || offset > raw.size || widths.columns != 2 || sizes.size != starts.size) return MISUSED;
    for (int64_t i = 0; i < widths.rows; i++)
        if (widths.data[2 * i] < 0 || widths.data[2 * i] > 8 || widths.data[2 * i + 1] < 1
            || widths.data[2 * i + 1] > 8)
            return MISUSED;
    int64_t cursor = offset;
    for (int64_t row = 0; row < starts.size; row++) {
        for (int64_t i = 0; i < widths.rows; i++) {
            int64_t length_width = widths.data[2 * i], item_width = widths.data[2 * i + 1];
            uint64_t size = 1;
            if (length_width > 0) {
                if (length_width > raw.size - cursor) return -cursor;
                size = read_number(raw.data + cursor, length_width, big_endian);
                cursor += length_width;
            }
            if (size > (uint64_t)((raw.size - cursor) / item_width)) return -cursor;
            if (i == place) {
                starts.data[row] = cursor;
                sizes.data[row] = (int64_t)size;
            }
            cursor += (int64_t)size * item_width;
        }
    }
    return cursor;
}
