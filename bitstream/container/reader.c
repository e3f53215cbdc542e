/* Bytes to packets (specification, F 2, F 3, F 5). */
#include "bitstream/container/container.h"

enum { MAGIC = 4, PREAMBLE = 5 };
static const uint8_t BEGINNING[MAGIC] = {0x89, 'B', 'S', 'M'};
/* Work of any frame, and of each of its bytes; of looking at a place, and into a frame there (M 14.3, F 8). */
static const double FRAME_WORK = 8e3, BYTE_WORK = 8, PLACE_WORK = 4e3, MAP_WORK = 6e5, METADATA_WORK = 2e4,
                    ENTRY_WORK = 8e3;
enum { STRIDE = 4096, SCAN_BYTES = 1 << 20, SCAN_FACTOR = 64 };

void begin_reader(Reader *reader, Context *context, bool tolerant) {
    *reader = (Reader){.context = context, .tolerant = tolerant};
    make_sums(&reader->sums);
    begin_grammar(&reader->grammar, tolerant);
    reader->metadata.arena = reader->meshes = reader->scratch = arena_of(context);
}

void end_reader(Reader *reader) {
    host_give(reader->context, reader->buffer, (size_t)reader->capacity);
    release_all(&reader->metadata.arena);
    release_all(&reader->meshes);
    release_all(&reader->scratch);
}

bool receive(Reader *reader, Span bytes) {
    int64_t size = reader->end - reader->begin;
    if (reader->capacity - reader->end < bytes.size) {
        int64_t capacity = reader->capacity;
        uint8_t *buffer = reader->buffer;
        if (size + bytes.size > capacity / 2) {
            capacity = 2 * (size + bytes.size) + 1024;
            if (!TAKE_OF_HOST(reader->context, capacity, buffer)) return false;
        }
        if (size > 0) memmove(buffer, reader->buffer + reader->begin, (size_t)size);
        if (buffer != reader->buffer) host_give(reader->context, reader->buffer, (size_t)reader->capacity);
        reader->buffer = buffer;
        reader->capacity = capacity;
        reader->begin = 0;
        reader->end = size;
        reader->moves++;
    }
    if (bytes.size > 0) memcpy(reader->buffer + reader->end, bytes.data, (size_t)bytes.size);
    reader->end += bytes.size;
    return true;
}

static Span waiting(const Reader *reader) {
    return (Span){reader->buffer + reader->begin, reader->end - reader->begin};
}

static void drop(Reader *reader, int64_t count) {
    reader->begin += count;
    reader->offset += count;
}

static Arrival incomplete(Reader *reader) {
    if (!reader->finished) return NO_MORE_YET;
    FAIL(reader->context, TRUNCATED, "the stream ends too early; get the rest of it");
    locate(&reader->context->error, reader->offset + reader->end - reader->begin, -1, -1);
    return NOTHING_BUT_AN_ERROR;
}

/* Spend; a lack of work or memory is not damage. */
static bool pay(Reader *reader, double work, double received) {
    if (charge(reader->context, work, received)) return true;
    reader->refused = true;
    return false;
}

/* Magic and version, as far as they have come. */
static Arrival start(Reader *reader) {
    Span present = waiting(reader);
    if (present.size > 0 && memcmp(present.data, BEGINNING, (size_t)least(present.size, MAGIC)) != 0) {
        FAIL(reader->context, FORMAT, "not a BSM stream: it does not begin with 89 42 53 4D");
        locate(&reader->context->error, 0, -1, -1);
        return NOTHING_BUT_AN_ERROR;
    }
    if (present.size < PREAMBLE) return incomplete(reader);
    int major = present.data[MAGIC] >> 4;
    if (major != MAJOR) {
        if (major < MAJOR)
            FAIL(reader->context, UNSUPPORTED,
                "this stream is written by version # of the format, and this reads #: encode the source again, or "
                "decode "
                "it with the release that wrote it",
                major, MAJOR);
        else
            FAIL(reader->context, UNSUPPORTED,
                "this stream is written by version # of the format, and this reads #: a later release reads it", major,
                MAJOR);
        locate(&reader->context->error, MAGIC, -1, -1);
        return NOTHING_BUT_AN_ERROR;
    }
    reader->version = present.data[MAGIC];
    reader->sum = crc32_of(&reader->sums, (Span){present.data, PREAMBLE}, 0);
    drop(reader, PREAMBLE);
    reader->started = true;
    return A_PACKET;
}

typedef struct {
    int type;
    int64_t size; /* with tag and checksum; 0 if it is not complete */
    Span payload;
} Section;

/* What the tag at the start of some bytes says; 0 if it is incomplete, -1 if it is invalid. */
static int read_tag(Span bytes, Section *frame) {
    int64_t tag;
    int head = parse_varint(bytes, &tag);
    if (head <= 0) return head;
    frame->type = (int)(tag % 16);
    frame->payload.size = tag / 16;
    int sum = frame->type == BLOCK_FRAME || frame->payload.size < SHORT_PAYLOAD ? 2 : 4;
    frame->size = head + frame->payload.size + sum;
    return head;
}

#ifndef BSMDEC_TERSE
/* A message on the checksum of a section, in words for users. */
static const char *checksum_message(int type) {
    switch (type) {
        case VALUES_FRAME: return "values of an attribute are damaged: the checksum of # bytes is wrong";
        case HEADER_FRAME: return "the header is damaged: the checksum of # bytes is wrong";
        case METADATA_FRAME:
            return "metadata (names, materials, images) are damaged: the checksum of # bytes is wrong";
        case CONNECTIVITY_FRAME: return "the faces are damaged: the checksum of # bytes is wrong";
        case PARTITION_FRAME: return "the labels of parts are damaged: the checksum of # bytes is wrong";
        case ORDER_FRAME: return "the order of vertices is damaged: the checksum of # bytes is wrong";
        case BLOCK_FRAME: return "positions of a block are damaged: the checksum of # bytes is wrong";
        case GOP_FRAME: return "positions of several frames are damaged: the checksum of # bytes is wrong";
        case GRID_FRAME: return "positions are damaged: the checksum of # bytes is wrong";
        case REFINEMENT_FRAME: return "details of positions are damaged: the checksum of # bytes is wrong";
        case ATTRIBUTE_FRAME: return "the description of an attribute is damaged: the checksum of # bytes is wrong";
        case END_FRAME: return "the end of the stream is damaged: the checksum of # bytes is wrong";
        default: return "the stream is damaged: the checksum of # bytes is wrong";
    }
}
#endif

/* The frame at the start of some bytes, whose checksum is right; `size` 0 if it is not complete. */
static bool read_frame(Reader *reader, Span bytes, Section *frame) {
    Context *context = reader->context;
    int head = read_tag(bytes, frame);
    if (head < 0) return FAIL(context, CORRUPT, "non-canonical varint in a tag");
    if (head == 0) {
        frame->size = 0;
        return true;
    }
    if (!WITHIN(context, frame_bytes, frame->payload.size)) return false;
    if (frame->size > bytes.size) {
        frame->size = 0;
        return true;
    }
    Span body = {bytes.data, head + frame->payload.size};
    int sum = (int)(frame->size - body.size);
    uint32_t expected = sum == 2 ? crc16_of(&reader->sums, body) : crc32_of(&reader->sums, body, 0);
    if (little_endian(bytes.data + body.size, sum) != expected)
        return FAIL(context, CORRUPT, checksum_message(frame->type), frame->payload.size);
    frame->payload.data = bytes.data + head;
    return true;
}

/* Bytes of a payload of METADATA without those of binary values, such as images, for which the bytes received pay. */
static int64_t plain_bytes(const Map *map, Span payload) {
    int64_t bytes = payload.size;
    for (int i = 0; i < map->count; i++) {
        if (map->value[i].kind == BINARY) bytes -= map->value[i].bytes.size;
    }
    return bytes;
}

/* Entries of a payload of METADATA; kept where `adding`. */
static bool read_metadata(Reader *reader, Span payload, bool adding) {
    Context *context = reader->context;
    Mark mark = mark_of(&reader->scratch);
    Map *map;
    bool done = TAKE(&reader->scratch, 1, map) && parse_map(context, payload, map);
    if (done) reader->plain_bytes = plain_bytes(map, payload);
    done = done && WITHIN(context, metadata_bytes, reader->plain_bytes);
    for (int i = 0; done && i < map->count; i++) {
        if (map->key[i].kind != TEXT || map->value[i].kind == LIST)
            done = FAIL(context, CORRUPT, "metadata of a wrong type");
    }
    for (int i = 0; done && i < map->count; i++) {
        if (adding) done = add_entry(&reader->metadata, &map->key[i], &map->value[i]);
        else if (reader->grammar.header != NULL && find_name(&reader->metadata, map->key[i].bytes))
            done = FAIL(context, CORRUPT, "duplicate metadata name");
    }
    if (done && adding) done = pay(reader, METADATA_WORK + ENTRY_WORK * map->count, 0);
    release_to(&reader->scratch, mark);
    return done;
}

static bool read_attribute(Reader *reader, Cursor *cursor, Packet *packet) {
    Context *context = reader->context;
    packet->index = take_varint(cursor);
    Span map = take_span(cursor, take_varint(cursor));
    Declaration *d = &reader->declared;
    if (failed(context) || !parse_declaration(context, map, &reader->scratch, d)) return false;
    packet->declaration = d;
    packet->data = take_rest(cursor);
    return WITHIN(context, attribute_values, (double)d->rows * (d->words > 0 ? d->words : 1));
}

/* F 5: the payload by itself. */
static bool read_payload(Reader *reader, Section frame, Packet *packet) {
    Cursor cursor = {reader->context, frame.payload};
    *packet = (Packet){.type = (FrameType)frame.type, .size = frame.payload.size};
    switch (packet->type) {
        case HEADER_FRAME:
            packet->header = &reader->headers[!reader->header];
            return parse_header(reader->context, frame.payload, &reader->scratch, &reader->headers[!reader->header]);
        case METADATA_FRAME: packet->data = frame.payload; return true;
        case ATTRIBUTE_FRAME: return read_attribute(reader, &cursor, packet);
        case BLOCK_FRAME:
            packet->index = take_varint(&cursor);
            packet->coefficients = take_varint(&cursor);
            break;
        case GOP_FRAME: packet->index = take_varint(&cursor); break;
        case VALUES_FRAME:
            packet->index = take_varint(&cursor);
            /* fall through */
        case GRID_FRAME:
        case REFINEMENT_FRAME:
            packet->first = take_varint(&cursor);
            packet->count = take_varint(&cursor);
            break;
        case END_FRAME: {
            packet->count = take_varint(&cursor);
            Span sum = take_span(&cursor, 4);
            packet->sum = sum.size == 4 ? (uint32_t)little_endian(sum.data, 4) : 0;
            packet->has_positions = cursor.left.size > 0;
            if (packet->has_positions) sum = take_span(&cursor, 4);
            packet->positions = sum.size == 4 ? (uint32_t)little_endian(sum.data, 4) : 0;
            return at_end(&cursor);
        }
        default: break;
    }
    packet->data = take_rest(&cursor);
    return !failed(reader->context);
}

static bool is_skippable(int type) { return type >= 8 && type <= 11; }

/* The packet in a frame, checked against everything before it (F 3.15). */
static bool read_packet(Reader *reader, Section frame, Packet *packet) {
    Context *context = reader->context;
    Grammar *grammar = &reader->grammar;
    if (is_skippable(frame.type))
        return grammar->header != NULL || FAIL(context, CORRUPT, "the first section must be a header");
    if (!announces(grammar, frame.type))
        return FAIL(context, UNSUPPORTED, "section type # is not declared in the header", frame.type);
    if (!read_payload(reader, frame, packet)) return false;
    bool is_metadata = packet->type == METADATA_FRAME;
    if (is_metadata && !read_metadata(reader, frame.payload, false)) return false;
    if (!check_packet(context, grammar, packet)) return false;
    if (is_metadata && !WITHIN(context, metadata_bytes, reader->metadata_bytes + reader->plain_bytes)) return false;
    if (packet->type != END_FRAME) return true;
    if (reader->damaged || grammar->joined) {
        packet->has_positions = false;
        return true;
    }
    if (packet->count != reader->frames)
        return FAIL(context, CORRUPT, "the stream had # sections when it was written, and has # now", packet->count,
            reader->frames);
    return packet->sum == reader->sum || FAIL(context, CORRUPT, "the CRC-32 of the whole stream is wrong");
}

/* Keep what follows the header of a brief stream in its frame (F 11). */
static bool keep_brief(Reader *reader, Span payload, Header *header) {
    uint8_t *copy;
    if (!is_brief(header)) return true;
    if (!TAKE(&reader->meshes, payload.size, copy)) return false;
    memcpy(copy, payload.data, (size_t)payload.size);
    return parse_header(reader->context, (Span){copy, payload.size}, &reader->scratch, header);
}

/* The packets for which a brief stream has no frames. */
static bool next_of_brief(Reader *reader, Packet *packet) {
    Header *header = &reader->headers[reader->header];
    bool has_faces = reader->grammar.last == HEADER_FRAME, has_values = reader->grammar.last == CONNECTIVITY_FRAME;
    if (header->metadata.size > 0) {
        *packet = (Packet){.type = METADATA_FRAME, .data = header->metadata, .size = header->metadata.size};
        header->metadata.size = 0;
        return read_metadata(reader, packet->data, true);
    }
    *packet = (Packet){.type = has_faces ? CONNECTIVITY_FRAME : has_values ? GRID_FRAME : END_FRAME,
        .data = has_faces ? header->connectivity : has_values ? header->values : (Span){0},
        .count = has_values ? header->vertices : 0};
    packet->size = packet->data.size;
    reader->last_offset = reader->offset;
    advance_grammar(&reader->grammar, packet, NULL);
    return true;
}

/* Skip a frame. */
static bool accept_frame(Reader *reader, Section frame, const Packet *packet) {
    Span bytes = {waiting(reader).data, frame.size};
    if (!is_skippable(frame.type)) {
        Declaration *own = NULL;
        if (packet->type == HEADER_FRAME) {
            reader->header = !reader->header;
            release_all(&reader->meshes);
            if (!keep_brief(reader, frame.payload, &reader->headers[reader->header])) return false;
        }
        if (packet->type == ATTRIBUTE_FRAME) {
            if (!TAKE(&reader->meshes, 1, own)) return false;
            *own = *packet->declaration;
        }
        if (packet->type == METADATA_FRAME) {
            if (!read_metadata(reader, frame.payload, true)) return false;
            reader->metadata_bytes += reader->plain_bytes;
        }
        advance_grammar(&reader->grammar, packet, own);
    }
    reader->sum = crc32_of(&reader->sums, bytes, reader->sum);
    reader->last_offset = reader->offset;
    reader->last_frame = reader->frames++;
    drop(reader, frame.size);
    return true;
}

static Arrival next_whole(Reader *reader, Packet *packet) {
    Context *context = reader->context;
    if (!reader->started) {
        Arrival begun = start(reader);
        if (begun != A_PACKET) return begun;
    }
    while (reader->grammar.last != END_FRAME) {
        Section frame = {0};
        if (reader->grammar.header != NULL && is_brief(reader->grammar.header))
            return next_of_brief(reader, packet) ? A_PACKET : NOTHING_BUT_AN_ERROR;
        if (!read_frame(reader, waiting(reader), &frame)) return NOTHING_BUT_AN_ERROR;
        if (frame.size == 0) return incomplete(reader);
        if (!pay(reader, FRAME_WORK + BYTE_WORK * (double)frame.size, (double)frame.size)) return NOTHING_BUT_AN_ERROR;
        if (!read_packet(reader, frame, packet) || !accept_frame(reader, frame, packet)) return NOTHING_BUT_AN_ERROR;
        if (!is_skippable(frame.type)) return A_PACKET;
    }
    if (reader->end > reader->begin) {
        FAIL(context, CORRUPT, "data after END");
        return NOTHING_BUT_AN_ERROR;
    }
    return reader->finished ? NO_MORE : NO_MORE_YET;
}

bool peek_packet(Reader *reader, int64_t *place, Grammar *grammar, Packet *packet) {
    Section frame = {0};
    Span present = waiting(reader);
    if (failed(reader->context)) return false;
    bool sound = read_frame(reader, (Span){present.data + *place, present.size - *place}, &frame) && frame.size > 0
        && (frame.type == BLOCK_FRAME || frame.type == REFINEMENT_FRAME) && announces(grammar, frame.type)
        && read_payload(reader, frame, packet) && check_packet(reader->context, grammar, packet);
    if (failed(reader->context)) take_error(reader->context);
    if (sound) {
        *place += frame.size;
        advance_grammar(grammar, packet, NULL);
    }
    return sound;
}

/* Take note of damage at the first byte that waits (F 8.2). */
static void inspect(Reader *reader) {
    Section frame = {0};
    Damage *damage = &reader->damage;
    *damage = (Damage){.found = true, .sure = true, .why = take_error(reader->context), .type = NO_FRAME,
        .by_length = -1, .from_next = true};
    reader->damaged = true;
    lose_frames(&reader->grammar);
    if (read_tag(waiting(reader), &frame) <= 0) return;
    if (!is_skippable(frame.type)) damage->type = (FrameType)frame.type;
    if (frame.size <= waiting(reader).size) damage->by_length = frame.size;
}

enum { GO_ON = 0, NO_FRAME_HERE = 1, MORE_FIRST = -1 };

/* Bytes of the frame `place` bytes from here, or one of these. */
static int64_t step_from(Reader *reader, int64_t place, bool sure) {
    Context *context = reader->context;
    Span bytes = {waiting(reader).data + place, waiting(reader).size - place};
    uint32_t expected = expected_types(&reader->grammar);
    Section frame = {0};
    Packet packet;
    int head = read_tag(bytes, &frame);
    if (head < 0) return NO_FRAME_HERE;
    if (head > 0) {
        double budget = SCAN_BYTES + (double)SCAN_FACTOR * (double)(reader->offset + reader->end - reader->begin);
        if (reader->scanned + (double)frame.size > budget || !(sure || expected >> frame.type & 1))
            return NO_FRAME_HERE;
        if (frame.size <= bytes.size) reader->scanned += (double)frame.size;
    }
    bool whole = read_frame(reader, bytes, &frame);
    take_error(context);
    if (!whole) return NO_FRAME_HERE;
    if (frame.size == 0) return reader->finished ? NO_FRAME_HERE : MORE_FIRST;
    if (place > 0 && expected >> frame.type & 1) {
        if (!pay(reader, MAP_WORK + BYTE_WORK * (double)frame.size, 0)) return MORE_FIRST;
        bool legal = read_packet(reader, frame, &packet);
        take_error(context);
        reader->refused = context->starved;
        if (legal) return GO_ON;
    }
    return frame.size;
}

/* Bytes up to where reading goes on, or to the end of the data; -1 if more must come first, or work is refused. */
static int64_t find_end(Reader *reader) {
    Damage *damage = &reader->damage;
    int64_t available = waiting(reader).size;
    bool ended = reader->grammar.last == END_FRAME;
    while (!ended && (damage->from_next || damage->place < available)) {
        if (damage->place % STRIDE == 1 && damage->place > damage->paid) {
            if (!pay(reader, PLACE_WORK * STRIDE, STRIDE)) return -1;
            damage->paid = damage->place;
        }
        int64_t step = step_from(reader, damage->place, damage->sure);
        if (reader->refused || step == MORE_FIRST) return -1;
        if (step == GO_ON) return damage->place;
        if (step > NO_FRAME_HERE) {
            damage->place += step;
            damage->by_length = -1;
            damage->from_next = false;
            continue;
        }
        damage->sure = damage->by_length >= 0;
        damage->place = damage->sure ? damage->by_length : damage->from_next ? 1 : damage->place + 1;
        if (!damage->sure) damage->from_next = false;
        damage->by_length = -1;
    }
    return reader->finished || ended ? available : -1;
}

static Arrival recover(Reader *reader) {
    int64_t length = find_end(reader);
    if (reader->refused) return NOTHING_BUT_AN_ERROR;
    if (length < 0) return NO_MORE_YET;
    if (length == 0) reader->damage.type = END_FRAME;
    reader->damage.found = false;
    reader->behind_damage = true;
    reader->damaged_offset = reader->last_offset = reader->offset;
    reader->damaged_size = length;
    reader->last_frame = reader->frames++;
    drop(reader, length);
    return A_DAMAGE;
}

Arrival next_packet(Reader *reader, Packet *packet) {
    if (failed(reader->context)) return NOTHING_BUT_AN_ERROR;
    if (reader->behind_damage && reader->grammar.last == END_FRAME) { /* bytes after END were reported */
        drop(reader, waiting(reader).size);
        return reader->finished ? NO_MORE : NO_MORE_YET;
    }
    if (reader->behind_damage && reader->finished && reader->begin == reader->end) return NO_MORE;
    if (!reader->damage.found) {
        Arrival arrival = next_whole(reader, packet);
        if (arrival != NOTHING_BUT_AN_ERROR) {
            reader->behind_damage = reader->behind_damage && arrival == NO_MORE_YET;
            return arrival;
        }
        if (!reader->tolerant || reader->grammar.header == NULL || reader->refused || reader->context->starved) {
            locate(&reader->context->error, reader->offset, reader->started ? reader->frames : -1, -1);
            return NOTHING_BUT_AN_ERROR;
        }
        inspect(reader);
    }
    return recover(reader);
}
