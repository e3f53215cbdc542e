/* Canonical msgpack maps (specification, F 1.5), and records of typed fields in them (F 4.1 to F 4.5). */
#pragma once

#include "bitstream/container/wire.h"

enum { MOST_ENTRIES = 256 };
typedef enum { NO_VALUE, INTEGER, REAL, TEXT, BINARY, LIST } Kind;

typedef struct {
    Kind kind;
    int first;        /* of a list: its first item */
    int64_t whole;    /* an integer, cut to 64 bits with a sign; of a list: how many items */
    uint64_t bits;    /* an integer above that */
    double number;    /* an integer or a real */
    Span bytes;       /* text or binary */
} Value;

typedef struct {
    int count, items;
    Value key[MOST_ENTRIES], value[MOST_ENTRIES], item[MOST_ENTRIES];
} Map;

/* Whether bytes are UTF-8: no form longer than needed, no surrogates, nothing above U+10FFFF. */
bool is_text(Span bytes);
/* A value that holds no other, behind its first byte; what else begins with that is corrupt. */
Value take_single(Cursor *cursor, uint8_t tag);
/* The entries of a payload, whose bytes they point to. */
bool parse_map(Context *context, Span payload, Map *map);

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

enum { MOST_KEY = 25, MOST_LIST = 8 };
/* By key: numbers, how many; and the text of the one field that may have one. */
typedef struct {
    double number[MOST_KEY][MOST_LIST];
    int count[MOST_KEY];
    uint32_t stored;  /* bit k: key k */
    Span text;
} Record;

bool parse_record(Context *context, Span payload, Fields fields, Arena *scratch, Record *record);
bool is_default(const Field *field, const Record *record);
/* Set the fields that are not stored to their defaults, and check that every value is in its range. */
bool complete_record(Context *context, Fields fields, Record *record);
