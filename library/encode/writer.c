/* Packets to bytes: what bitstream/container/reader.c reads (specification, F 1 to F 5). */
#include "library/encode/encoding.h"

#ifdef BSMDEC_WRITES

enum { LEAST_ROOM = 1 << 12, TAG_BITS = 4 };

void give_buffer(Buffer *buffer) {
    host_give(buffer->context, buffer->data, (size_t)buffer->capacity);
    buffer->data = NULL;
    buffer->size = buffer->capacity = 0;
}

/* Room for so many more bytes; NULL if there is none. */
static uint8_t *more(Buffer *buffer, int64_t size) {
    if (failed(buffer->context)) return NULL;
    if (size > buffer->capacity - buffer->size) {
        int64_t capacity = largest(2 * (buffer->size + size), LEAST_ROOM);
        uint8_t *data;
        if (!TAKE_OF_HOST(buffer->context, capacity, data)) return NULL;
        if (buffer->size > 0) memcpy(data, buffer->data, (size_t)buffer->size);
        host_give(buffer->context, buffer->data, (size_t)buffer->capacity);
        buffer->data = data;
        buffer->capacity = capacity;
    }
    buffer->size += size;
    return buffer->data + buffer->size - size;
}

void put_bytes(Buffer *buffer, Span bytes) {
    uint8_t *to = more(buffer, bytes.size);
    if (to != NULL && bytes.size > 0) memcpy(to, bytes.data, (size_t)bytes.size);
}

static void put_byte(Buffer *buffer, int value) {
    uint8_t *to = more(buffer, 1);
    if (to != NULL) *to = (uint8_t)value;
}

void put_varint(Buffer *buffer, int64_t value) {
    for (; value > 0x7f; value >>= 7) put_byte(buffer, (int)(value & 0x7f) | 0x80);
    put_byte(buffer, (int)value);
}

void put_little(Buffer *buffer, uint64_t value, int size) {
    for (int i = 0; i < size; i++) put_byte(buffer, (int)(value >> 8 * i & 255));
}

static void put_big(Buffer *buffer, uint64_t value, int size) {
    while (size-- > 0) put_byte(buffer, (int)(value >> 8 * size & 255));
}

/* A tag of msgpack, and a number after it in the fewest of 1, 2, 4 and 8 bytes, for which there are tags in a row. */
static void put_tagged(Buffer *buffer, int tag, uint64_t value, int first) {
    int size = first;
    for (; size < 8 && value >> 8 * size > 0; size *= 2) tag++;
    put_byte(buffer, tag);
    put_big(buffer, value, size);
}

static void put_whole(Buffer *buffer, int64_t value) {
    if (value >= -32 && value < 128) put_byte(buffer, (int)(value & 255));
    else if (value >= 0) put_tagged(buffer, 0xcc, (uint64_t)value, 1);
    else {
        int size = value >= INT8_MIN ? 1 : value >= INT16_MIN ? 2 : value >= INT32_MIN ? 4 : 8;
        put_byte(buffer, size == 1 ? 0xd0 : size == 2 ? 0xd1 : size == 4 ? 0xd2 : 0xd3);
        put_big(buffer, (uint64_t)value, size);
    }
}

/* In single precision where that is exact. */
static void put_real(Buffer *buffer, double value) {
    float narrow = value >= -FLT_MAX && value <= FLT_MAX ? (float)value : 0.0f;
    bool fits = (double)narrow == value;
    uint32_t word;
    uint64_t wide;
    memcpy(&word, &narrow, sizeof word);
    memcpy(&wide, &value, sizeof wide);
    put_byte(buffer, fits ? 0xca : 0xcb);
    put_big(buffer, fits ? word : wide, fits ? 4 : 8);
}

static void put_text(Buffer *buffer, Span text) {
    if (text.size < 32) put_byte(buffer, 0xa0 | (int)text.size);
    else put_tagged(buffer, 0xd9, (uint64_t)text.size, 1);
    put_bytes(buffer, text);
}

static void put_count(Buffer *buffer, int few, int many, int64_t count) {
    if (count < 16) put_byte(buffer, few | (int)count);
    else put_tagged(buffer, many, (uint64_t)count, 2);
}

void put_record(Buffer *buffer, Fields fields, const Record *record) {
    int entries = 0;
    const Field *end = fields.field + fields.count;
    for (const Field *f = fields.field; f < end; f++) entries += record->count[f->key] > 0 && !is_default(f, record);
    put_count(buffer, 0x80, 0xde, entries);
    for (const Field *f = fields.field; f < end; f++) {
        int count = record->count[f->key];
        if (count == 0 || is_default(f, record)) continue;
        put_byte(buffer, f->key);
        if (f->type == INTS_FIELD || f->type == FLOATS_FIELD) put_count(buffer, 0x90, 0xdc, count);
        for (int i = 0; i < count; i++) {
            if (f->type == TEXT_FIELD) put_text(buffer, record->text);
            else if (f->type == FLOAT_FIELD || f->type == FLOATS_FIELD) put_real(buffer, record->number[f->key][i]);
            else put_whole(buffer, (int64_t)record->number[f->key][i]);
        }
    }
}

void put_metadata(Buffer *buffer, const bsmdec_metadata *const *entries, int count) {
    put_count(buffer, 0x80, 0xde, count);
    for (int i = 0; i < count; i++) {
        const bsmdec_metadata *entry = entries[i];
        Span bytes = {entry->bytes, (int64_t)entry->size};
        put_text(buffer, (Span){(const uint8_t *)entry->name, (int64_t)strlen(entry->name)});
        if (entry->type == BSMDEC_WHOLE) put_whole(buffer, entry->whole);
        if (entry->type == BSMDEC_NUMBER) put_real(buffer, entry->number);
        if (entry->type == BSMDEC_TEXT) put_text(buffer, bytes);
        if (entry->type == BSMDEC_BYTES) put_tagged(buffer, 0xc4, (uint64_t)bytes.size, 1), put_bytes(buffer, bytes);
    }
}

void put_order(Buffer *buffer, const CodedMesh *coded, Arena *scratch) {
    const GivenMesh *given = coded->given;
    const JoinedMesh *joined = coded->joined;
    Context *context = buffer->context;
    Mark mark = mark_of(scratch);
    Payload writing = {0};
    Ints source, number; /* the joined vertex of each given one that comes back; their numbers */
    Ints2 corners;
    Doubles2 loose;
    if (!take_ints(scratch, given->vertices, &source) || !take_ints(scratch, given->vertices, &number)
        || !take_ints2(scratch, given->faces, 3, &corners) || !take_doubles2(scratch, joined->loose, 3, &loose))
        return;
    source.size = loose.rows = 0;
    for (int64_t v = 0; v < given->vertices; v++) {
        int32_t index = joined->index.data[v];
        number.data[v] = (int32_t)source.size;
        if (index < 0 && coded->keeps)
            memcpy(loose.data + 3 * loose.rows++, given->positions.data + 3 * v, 3 * sizeof *loose.data);
        if (index >= 0 || coded->keeps) source.data[source.size++] = index;
    }
    for (int64_t i = 0; i < 3 * corners.rows; i++) corners.data[i] = number.data[given->corners[i]];
    Arrangement arrangement = {const_ints2(joined->faces), const_ints2(coded->faces), const_ints(coded->vertex_order),
        const_ints(coded->face_order), const_ints(source), const_ints2(corners),
        source.size - loose.rows - coded->vertex_order.size, loose.rows};
    if (begin_payloads(context, 1 << 12, &writing) && write_order(context, &arrangement, scratch, &writing)) {
        put_varint(buffer, arrangement.copies);
        put_varint(buffer, arrangement.loose);
        for (int64_t i = 0; i < 3 * loose.rows; i++) {
            uint64_t bits;
            memcpy(&bits, loose.data + i, sizeof bits);
            put_little(buffer, bits, 8);
        }
        put_bytes(buffer, (Span){writing.data, writing.size});
    }
    end_payloads(context, &writing);
    release_to(scratch, mark);
}

void start_stream(StreamWriter *writer, Context *context, int minor) {
    const uint8_t preamble[] = {0x89, 'B', 'S', 'M', (uint8_t)(16 * MAJOR + minor)};
    writer->bytes = writer->payload = (Buffer){.context = context};
    writer->sections = 0;
    make_sums(&writer->sums);
    put_bytes(&writer->bytes, (Span){preamble, sizeof preamble});
    writer->sum = crc32_of(&writer->sums, (Span){preamble, sizeof preamble}, 0);
}

void put_section(StreamWriter *writer, FrameType type) {
    Buffer *bytes = &writer->bytes;
    int64_t start = bytes->size, size = writer->payload.size;
    bool brief = type == BLOCK_FRAME || size < SHORT_PAYLOAD;
    put_varint(bytes, size << TAG_BITS | type);
    put_bytes(bytes, bytes_of(&writer->payload));
    writer->payload.size = 0;
    if (failed(bytes->context)) return;
    Span body = {bytes->data + start, bytes->size - start};
    put_little(bytes, brief ? crc16_of(&writer->sums, body) : crc32_of(&writer->sums, body, 0), brief ? 2 : 4);
    if (failed(bytes->context)) return;
    writer->sum = crc32_of(&writer->sums, (Span){bytes->data + start, bytes->size - start}, writer->sum);
    writer->sections++;
}

void end_stream(StreamWriter *writer, uint32_t positions) {
    put_varint(&writer->payload, writer->sections);
    put_little(&writer->payload, writer->sum, 4);
    put_little(&writer->payload, positions, 4);
    put_section(writer, END_FRAME);
}

void give_stream(StreamWriter *writer) {
    give_buffer(&writer->bytes);
    give_buffer(&writer->payload);
}

#endif
