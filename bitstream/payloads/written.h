/* What is written in place of being read, where BSMDEC_WRITES is defined. */
#pragma once

#include <stdint.h>

/* Where payloads are written, one after the other, and where each ends. */
enum { MOST_PAYLOADS = 4 };
typedef struct Payload {
    uint8_t *data;
    int64_t capacity, size, ends[MOST_PAYLOADS];
    int count;
} Payload;

/* Faces, and values of each vertex, or of each row of an attribute; all arrays stay with the caller. */
typedef struct {
    const int32_t *faces, *values;
    int64_t faces_count, rows, columns;
} Source;
