/* The smallest pieces of the format: varints, checksums, payloads read from front to back. */
#pragma once

#include "bitstream/context.h"

/* Bytes that somebody else keeps. */
typedef struct {
    const uint8_t *data;
    int64_t size;
} Span;

/* `long_sums[k]`: of a byte followed by k zeros. */
typedef struct {
    uint32_t long_sums[8][256];
    uint16_t short_sums[256];
} Sums;

void make_sums(Sums *sums);
uint32_t crc32_of(const Sums *sums, Span bytes, uint32_t before);
/* Of positions that follow those with the checksum `before` (F 5.10). */
uint32_t crc32_of_positions(const Sums *sums, ConstDoubles2 positions, uint32_t before);
uint16_t crc16_of(const Sums *sums, Span bytes);
/* `size` bytes, at most eight, as a number. */
uint64_t little_endian(const uint8_t *bytes, int size);
uint64_t big_endian(const uint8_t *bytes, int size);

/* Bytes that the varint at the start takes; 0 if `bytes` ends inside it, -1 if it is invalid (F 1.2). */
int parse_varint(Span bytes, int64_t *value);

/* What a payload lacks or has too much is corrupt; a cursor that has failed gives zeros. */
typedef struct {
    Context *context;
    Span left;
} Cursor;

int64_t take_varint(Cursor *cursor);
Span take_span(Cursor *cursor, int64_t count);
INLINE Span take_rest(Cursor *cursor) { return take_span(cursor, cursor->left.size); }
bool at_end(const Cursor *cursor);
