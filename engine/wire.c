/* Varints, checksums (specification, F 1). */
#include "engine/wire.h"

enum { MOST_VARINT = 5 };

void make_sums(Sums *sums) {
    for (uint32_t byte = 0; byte < 256; byte++) {
        uint32_t value = byte, other = byte << 8;
        for (int k = 0; k < 8; k++) {
            value = value & 1 ? value >> 1 ^ 0xedb88320u : value >> 1;
            other = other & 0x8000 ? other << 1 ^ 0x1021u : other << 1;
        }
        sums->long_sums[byte] = value;
        sums->short_sums[byte] = (uint16_t)other;
    }
}

uint32_t crc32_of(const Sums *sums, Span bytes, uint32_t before) {
    uint32_t value = ~before;
    for (int64_t i = 0; i < bytes.size; i++) value = sums->long_sums[(value ^ bytes.data[i]) & 255] ^ value >> 8;
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
        FAIL(cursor->context, CORRUPT, "a payload has no varint where one belongs");
        return 0;
    }
    take_span(cursor, size);
    return value;
}

Span take_span(Cursor *cursor, int64_t count) {
    if (failed(cursor->context)) return (Span){NULL, 0};
    if (count > cursor->left.size) {
        FAIL(cursor->context, CORRUPT, "a payload ends where # more bytes should be", count);
        return (Span){NULL, 0};
    }
    Span taken = {cursor->left.data, count};
    if (count > 0) cursor->left = (Span){cursor->left.data + count, cursor->left.size - count};
    return taken;
}

bool at_end(const Cursor *cursor) {
    if (failed(cursor->context)) return false;
    return cursor->left.size == 0 || FAIL(cursor->context, CORRUPT, "a payload has # bytes too many", cursor->left.size);
}
