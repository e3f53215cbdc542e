/* Varints, checksums (specification, F 1). */
#include "bitstream/container/container.h"

enum { MOST_VARINT = 5 };

void make_sums(Sums *sums) {
    for (uint32_t byte = 0; byte < 256; byte++) {
        uint32_t value = byte, other = byte << 8;
        for (int k = 0; k < 8; k++) {
            value = value & 1 ? value >> 1 ^ 0xedb88320u : value >> 1;
            other = other & 0x8000 ? other << 1 ^ 0x1021u : other << 1;
        }
        sums->long_sums[0][byte] = value;
        sums->short_sums[byte] = (uint16_t)other;
    }
    for (int k = 1; k < 8; k++)
        for (int byte = 0; byte < 256; byte++) {
            uint32_t before = sums->long_sums[k - 1][byte];
            sums->long_sums[k][byte] = sums->long_sums[0][before & 255] ^ before >> 8;
        }
}

/* Eight bytes, the first the lowest. */
INLINE uint32_t add_word(const Sums *sums, uint32_t value, uint64_t word) {
    uint32_t low = (uint32_t)word ^ value, high = (uint32_t)(word >> 32);
    return sums->long_sums[7][low & 255] ^ sums->long_sums[6][low >> 8 & 255] ^ sums->long_sums[5][low >> 16 & 255]
        ^ sums->long_sums[4][low >> 24] ^ sums->long_sums[3][high & 255] ^ sums->long_sums[2][high >> 8 & 255]
        ^ sums->long_sums[1][high >> 16 & 255] ^ sums->long_sums[0][high >> 24];
}

uint32_t crc32_of(const Sums *sums, Span bytes, uint32_t before) {
    uint32_t value = ~before;
    int64_t i = 0;
    for (; i + 8 <= bytes.size; i += 8) value = add_word(sums, value, little_endian(bytes.data + i, 8));
    for (; i < bytes.size; i++) value = sums->long_sums[0][(value ^ bytes.data[i]) & 255] ^ value >> 8;
    return ~value;
}

uint32_t crc32_of_positions(const Sums *sums, ConstDoubles2 positions, uint32_t before) {
    uint32_t value = ~before;
    for (int64_t i = 0; i < 3 * positions.rows; i++) {
        double place = positions.data[i] + 0.0;
        uint64_t word;
        memcpy(&word, &place, sizeof word);
        value = add_word(sums, value, word);
    }
    return ~value;
}

uint16_t crc16_of(const Sums *sums, Span bytes) {
    uint32_t value = 0;
    for (int64_t i = 0; i < bytes.size; i++)
        value = (value << 8 & 0xffff) ^ sums->short_sums[value >> 8 ^ bytes.data[i]];
    return (uint16_t)value;
}

uint64_t little_endian(const uint8_t *bytes, int size) {
    uint64_t value = 0;
    while (size-- > 0) value = value << 8 | bytes[size];
    return value;
}

uint64_t big_endian(const uint8_t *bytes, int size) {
    uint64_t value = 0;
    for (int i = 0; i < size; i++) value = value << 8 | bytes[i];
    return value;
}

int parse_varint(Span bytes, int64_t *value) {
    *value = 0;
    for (int i = 0; i < MOST_VARINT; i++) {
        if (i >= bytes.size) return 0;
        *value |= (int64_t)(bytes.data[i] & 0x7f) << 7 * i;
        if (bytes.data[i] < 0x80) return bytes.data[i] == 0 && i > 0 ? -1 : i + 1;
    }
    return -1;
}

int64_t take_varint(Cursor *cursor) {
    int64_t value;
    int size = parse_varint(cursor->left, &value);
    if (size <= 0) {
        FAIL(cursor->context, CORRUPT, "a payload ends where a varint is expected");
        return 0;
    }
    take_span(cursor, size);
    return value;
}

Span take_span(Cursor *cursor, int64_t count) {
    if (failed(cursor->context)) return (Span){NULL, 0};
    if (count > cursor->left.size) {
        FAIL(cursor->context, CORRUPT, "a payload ends # bytes early", count);
        return (Span){NULL, 0};
    }
    Span taken = {cursor->left.data, count};
    if (count > 0) cursor->left = (Span){cursor->left.data + count, cursor->left.size - count};
    return taken;
}

bool at_end(const Cursor *cursor) {
    if (failed(cursor->context)) return false;
    return cursor->left.size == 0
        || FAIL(cursor->context, CORRUPT, "a payload has # bytes too many", cursor->left.size);
}
