/* Canonical maps: one map has one encoding, and nothing else is accepted (specification, F 1.5). */
#include "bitstream/container/container.h"

#include <float.h>

static uint8_t take_byte(Cursor *cursor) {
    Span byte = take_span(cursor, 1);
    return byte.size == 1 ? *byte.data : 0;
}

static uint64_t take_unsigned(Cursor *cursor, int size) {
    Span bytes = take_span(cursor, size);
    return bytes.size == size ? big_endian(bytes.data, size) : 0;
}

static void require_shortest(Cursor *cursor, bool is_shortest) {
    if (!is_shortest) FAIL(cursor->context, CORRUPT, "a map is not in its shortest form");
}

bool is_text(Span bytes) {
    for (int64_t i = 0; i < bytes.size;) {
        uint32_t first = bytes.data[i++];
        if (first < 0x80) continue;
        int more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
        if (first < 0xc2 || first > 0xf4 || bytes.size - i < more) return false;
        uint32_t value = first & (0x3fu >> more);
        for (int k = 0; k < more; k++, i++) {
            if ((bytes.data[i] & 0xc0) != 0x80) return false;
            value = value << 6 | (bytes.data[i] & 0x3f);
        }
        if ((more == 2 && (value < 0x800 || (value >= 0xd800 && value < 0xe000)))
            || (more == 3 && (value < 0x10000 || value > 0x10ffff)))
            return false;
    }
    return true;
}

static Value bytes_value(Cursor *cursor, Kind kind, int64_t size) {
    Span bytes = take_span(cursor, size);
    if (kind == TEXT && !is_text(bytes)) FAIL(cursor->context, CORRUPT, "a text of a map is not UTF-8");
    return (Value){.kind = kind, .bytes = bytes};
}

static Value unsigned_value(uint64_t bits) {
    return (Value){.kind = INTEGER, .whole = bits > INT64_MAX ? INT64_MAX : (int64_t)bits, .bits = bits,
        .number = (double)bits};
}

static Value negative_value(Cursor *cursor, int size) {
    static const int64_t ABOVE[] = {-32, -128, -32768, -(INT64_C(1) << 31)};
    uint64_t bits = take_unsigned(cursor, 1 << size);
    int64_t value = size == 0 ? (int8_t)bits : size == 1 ? (int16_t)bits : size == 2 ? (int32_t)bits : (int64_t)bits;
    require_shortest(cursor, value < ABOVE[size]);
    return (Value){.kind = INTEGER, .whole = value, .number = (double)value};
}

static Value real_value(Cursor *cursor, bool is_double) {
    double number;
    if (is_double) {
        uint64_t bits = take_unsigned(cursor, 8);
        memcpy(&number, &bits, sizeof number);
        bool single = number >= -FLT_MAX && number <= FLT_MAX && (double)(float)number == number;
        require_shortest(cursor, !single);
    } else {
        uint32_t bits = (uint32_t)take_unsigned(cursor, 4);
        float single;
        memcpy(&single, &bits, sizeof single);
        number = single;
    }
    if (!(number - number == 0.0)) FAIL(cursor->context, CORRUPT, "a map may not hold a number that is not finite");
    return (Value){.kind = REAL, .number = number};
}

Value take_single(Cursor *cursor, uint8_t tag) {
    static const uint64_t TEXTS[] = {32, 256, 65536}, BINARIES[] = {0, 256, 65536},
        LONGER[] = {128, 256, 65536, UINT64_C(1) << 32};
    if (tag < 0x80) return unsigned_value(tag);
    if (tag >= 0xe0) return (Value){.kind = INTEGER, .whole = (int8_t)tag, .number = (int8_t)tag};
    if (tag >= 0xa0 && tag <= 0xbf) return bytes_value(cursor, TEXT, tag & 31);
    if (tag >= 0xc4 && tag <= 0xc6) {
        uint64_t size = take_unsigned(cursor, 1 << (tag - 0xc4));
        require_shortest(cursor, size >= BINARIES[tag - 0xc4]);
        return bytes_value(cursor, BINARY, (int64_t)size);
    }
    if (tag >= 0xd9 && tag <= 0xdb) {
        uint64_t size = take_unsigned(cursor, 1 << (tag - 0xd9));
        require_shortest(cursor, size >= TEXTS[tag - 0xd9]);
        return bytes_value(cursor, TEXT, (int64_t)size);
    }
    if (tag == 0xca || tag == 0xcb) return real_value(cursor, tag == 0xcb);
    if (tag >= 0xcc && tag <= 0xcf) {
        uint64_t bits = take_unsigned(cursor, 1 << (tag - 0xcc));
        require_shortest(cursor, bits >= LONGER[tag - 0xcc]);
        return unsigned_value(bits);
    }
    if (tag >= 0xd0 && tag <= 0xd3) return negative_value(cursor, tag - 0xd0);
    FAIL(cursor->context, CORRUPT, "a map may not hold a value that begins with byte # here", tag);
    return (Value){0};
}

/* Entries of a map or an array whose first byte is `tag`; -1 if it is neither. */
static int64_t count_of(Cursor *cursor, uint8_t tag, uint8_t few, uint8_t many) {
    if ((tag & 0xf0) == few) return tag & 15;
    if (tag != many) return -1;
    int64_t count = (int64_t)take_unsigned(cursor, 2);
    require_shortest(cursor, count >= 16);
    if (count > MOST_ENTRIES) FAIL(cursor->context, CORRUPT, "# entries of a map or an array are too many", count);
    return failed(cursor->context) ? 0 : count;
}

static Value take_value(Cursor *cursor, Map *map) {
    uint8_t tag = take_byte(cursor);
    int64_t count = count_of(cursor, tag, 0x90, 0xdc);
    if (count < 0) return take_single(cursor, tag);
    Value list = {.kind = LIST, .first = map->items, .whole = count};
    if (count > MOST_ENTRIES - map->items) {
        FAIL(cursor->context, CORRUPT, "the arrays of a map have too many entries");
        return list;
    }
    for (; count > 0 && !failed(cursor->context); count--)
        map->item[map->items++] = take_single(cursor, take_byte(cursor));
    return list;
}

/* Whether key b comes after key a. */
static bool ascends(const Value *a, const Value *b) {
    if (a->kind != b->kind) return false;
    if (a->kind == INTEGER) return a->bits < b->bits;
    int64_t common = least(a->bytes.size, b->bytes.size);
    int order = memcmp(a->bytes.data, b->bytes.data, (size_t)common);
    return order < 0 || (order == 0 && a->bytes.size < b->bytes.size);
}

bool parse_map(Context *context, Span payload, Map *map) {
    Cursor cursor = {context, payload};
    map->count = map->items = 0;
    int64_t count = count_of(&cursor, take_byte(&cursor), 0x80, 0xde);
    if (count < 0) return FAIL(context, CORRUPT, "expected a map of few entries");
    for (int i = 0; i < count && !failed(context); i++) {
        Value *key = &map->key[i];
        *key = take_single(&cursor, take_byte(&cursor));
        map->value[i] = take_value(&cursor, map);
        map->count = i + 1;
        if (failed(context)) return false;
        if (key->kind != TEXT && (key->kind != INTEGER || key->whole < 0))
            return FAIL(context, CORRUPT, "the keys of a map must be unsigned integers or texts");
        if (i > 0 && !ascends(key - 1, key))
            return FAIL(context, CORRUPT, "the keys of a map must be of one type and ascend");
    }
    return at_end(&cursor);
}

enum { RESERVED = 255 };

static const Field *field_of(Fields fields, uint64_t key) {
    for (int i = 0; i < fields.count; i++)
        if (fields.field[i].key == key) return fields.field + i;
    return NULL;
}

/* Report a later version first, whatever else may seem wrong. */
static bool refuse_unknown(Context *context, const Map *map, Fields fields) {
    for (int i = 0; i < map->count; i++) {
        const Value *value = &map->value[i];
        if (map->key[i].kind != INTEGER) return FAIL(context, CORRUPT, "a field key is not an integer");
        const Field *field = field_of(fields, map->key[i].bits);
        if (field == NULL) return FAIL(context, UNSUPPORTED, "field # is unknown to this decoder", map->key[i].whole);
        if (field->type == METHOD_FIELD && value->kind == INTEGER && value->number > field->high
            && value->whole <= RESERVED)
            return FAIL(context, UNSUPPORTED, "field # names method #, unknown to this decoder", field->key,
                value->whole);
    }
    return true;
}

/* The numbers of a value that has the type of its field. */
static bool read_field(Context *context, const Map *map, const Field *field, const Value *value, Record *record) {
    bool is_list = field->type == INTS_FIELD || field->type == FLOATS_FIELD;
    Kind own = field->type == FLOAT_FIELD || field->type == FLOATS_FIELD ? REAL : field->type == TEXT_FIELD ? TEXT
        : INTEGER;
    const Value *from = is_list && value->kind == LIST ? map->item + value->first : value;
    int64_t count = is_list && value->kind == LIST ? value->whole : 1;
    bool right = !is_list || value->kind == LIST;
    for (int64_t i = 0; i < count; i++) right = right && from[i].kind == own;
    if (!right) return FAIL(context, CORRUPT, "field # is of another type", field->key);
    record->count[field->key] = (int)count;
    for (int64_t i = 0; i < count && i < MOST_LIST; i++)
        record->number[field->key][i] = own == TEXT ? (double)value->bytes.size : from[i].number;
    if (own == TEXT) record->text = value->bytes;
    record->stored |= 1u << field->key;
    return true;
}

bool is_default(const Field *field, const Record *record) {
    if (field->required) return false;
    bool is_list = field->type == INTS_FIELD || field->type == FLOATS_FIELD;
    int count = is_list ? field->least : 1;
    if (record->count[field->key] != count) return false;
    for (int i = 0; i < count; i++)
        if (record->number[field->key][i] != field->fallback) return false;
    return true;
}

static bool in_range(const Field *field, const Record *record) {
    bool is_list = field->type == INTS_FIELD || field->type == FLOATS_FIELD;
    int count = record->count[field->key];
    if (is_list && (count < field->least || count > field->most)) return false;
    for (int i = 0; i < count; i++)
        if (!(record->number[field->key][i] >= field->low && record->number[field->key][i] <= field->high))
            return false;
    return true;
}

bool complete_record(Context *context, Fields fields, Record *record) {
    for (int i = 0; i < fields.count; i++) {
        const Field *field = fields.field + i;
        bool is_stored = record->stored >> field->key & 1, is_list = field->type == INTS_FIELD
            || field->type == FLOATS_FIELD;
        if (!is_stored && field->required) return FAIL(context, CORRUPT, "field # is missing", field->key);
        if (!is_stored) {
            record->count[field->key] = is_list ? field->least : 1;
            record->number[field->key][0] = field->fallback;
        }
    }
    for (int i = 0; i < fields.count; i++)
        if (!in_range(fields.field + i, record))
            return FAIL(context, CORRUPT, "field # is outside its legal range", fields.field[i].key);
    return true;
}

static bool read_record(Context *context, const Map *map, Fields fields, Record *record) {
    *record = (Record){0};
    if (!refuse_unknown(context, map, fields)) return false;
    for (int i = 0; i < map->count; i++) {
        const Field *field = field_of(fields, map->key[i].bits);
        if (!read_field(context, map, field, &map->value[i], record)) return false;
        if (is_default(field, record))
            return FAIL(context, CORRUPT, "field # is stored although it has its default", field->key);
    }
    return complete_record(context, fields, record);
}

bool parse_record(Context *context, Span payload, Fields fields, Arena *scratch, Record *record) {
    Mark mark = mark_of(scratch);
    Map *map;
    bool done = TAKE(scratch, 1, map) && parse_map(context, payload, map)
        && read_record(context, map, fields, record);
    release_to(scratch, mark);
    return done;
}
