/* Numbers of the container that its writers and its readers need (specification, F, S 2.1). */
#pragma once

#include "bitstream/kernel.h"

enum {
    MAJOR = 1,            /* version of the format */
    MINOR_OF_SWIFT = 3,   /* the first that has swift attributes, and faces that repeat a corner on edges */
    SHORT_PAYLOAD = 128,  /* a payload of fewer bytes has a short checksum */
    MOST_NAME = 255,      /* bytes */
    MOST_GIVEN = 1 << 24, /* vertices, so that every number of one can be coded */
    MOST_COPIES = 16, FREE_COPIES = 1 << 16, /* rows of all blocks, at most: for each vertex, and in addition */
    METHODS = 8, RUNS = 32, WITH_ATTRIBUTES = 4, /* in the first byte of a GOP */
};

/* The fields of headers and of declarations, in the order of their keys. */
typedef enum { INT_FIELD, METHOD_FIELD, FLOAT_FIELD, INTS_FIELD, FLOATS_FIELD, TEXT_FIELD } FieldType;
typedef struct {
    uint8_t key;
    FieldType type;
    double low, high;
    int least, most;  /* entries of a list */
    double fallback;  /* of a field without list; a list falls back to `least` zeros */
    bool required;
} Field;
typedef struct {
    const Field *field;
    int count;
} Fields;
extern INSIDE const Fields HEADER_FIELDS, DECLARATION_FIELDS;
