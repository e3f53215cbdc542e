/* What lies inside a decoder, for the binding in C++, which cannot read the headers in C. */
#include "library/python/inside.h"

#include <stdlib.h>

#include "library/state.h"
#include "bitstream/payloads/payloads.h"
#include "library/encode/encoding.h"
#include "library/writing.h"

DecoderState decoder_state(const bsmdec *decoder) {
    const Spent *spent = &decoder->context.spent;
    return (DecoderState){decoder->reader.offset, spent->vertices, spent->vertices + spent->shown,
        spent->vertices - spent->gone, spent->spent, spent->received, spent->reserved};
}

_Static_assert((int)MOST_FIELD_KEY == MOST_KEY, "fields have other keys");

static int numbers_of(const Record *record, int key, const double **numbers) {
    *numbers = record->number[key];
    return record->count[key];
}

int decoder_field(const bsmdec *decoder, int key, const double **numbers) {
    return numbers_of(&decoder->reader.headers[decoder->reader.header].record, key, numbers);
}

_Static_assert(sizeof((SkimmedPacket *)0)->name > MOST_NAME, "names do not fit");

bool decoder_skim(bsmdec *decoder, SkimmedPacket *packet) {
    Reader *reader = &decoder->reader;
    const Header *header = &reader->headers[0];
    Packet p;
    Gop gop = {0};
    if (next_packet(reader, &p) != A_PACKET) return false;
    header += reader->header;
    if (p.type == GOP_FRAME
        && !parse_beginning(&(Cursor){&decoder->context, p.data}, header->gop_frames, header->run, &gop))
        return false;
    const Declaration none = {0}, *d = p.type == ATTRIBUTE_FRAME ? p.declaration : &none;
    *packet = (SkimmedPacket){.type = p.type, .offset = reader->last_offset,
        .length = reader->offset - reader->last_offset, .payload = p.size, .data = p.data.size, .index = p.index,
        .count = p.coefficients + p.count + gop.frames, .entries = reader->metadata.count, .version = reader->version,
        .positions = p.has_positions ? (int64_t)p.positions : -1,
        .begins = gop.method == LEARNED || gop.method == KEY_FRAMES, .domain = d->domain, .semantic = d->semantic,
        .kind = d->kind, .components = d->components, .coding = d->coding, .rows = d->rows, .moves = d->moves};
    memcpy(packet->name, d->name, sizeof d->name);
    return true;
}

struct Encoding {
    PayloadWriter writer;
    CodedField field;
    GivenMesh given;
    JoinedMesh joined;
    CodedMesh coded;
    Carried *carried;
    int carried_count;
    Record declared; /* the last of them */
    Mark mark; /* before what carried attributes have */
    Payload payloads;
    CodedChain *chain;
};

Encoding *open_encoding(void) {
    Encoding *encoding = calloc(1, sizeof *encoding);
    if (encoding != NULL) open_writer(&encoding->writer, library_allocator());
    return encoding;
}

void close_encoding(Encoding *encoding) {
    end_payloads(&encoding->writer.context, &encoding->payloads);
    end_field(&encoding->field);
    if (encoding->chain != NULL) close_chain(encoding->chain);
    close_writer(&encoding->writer);
    free(encoding);
}

CodedChain *encoding_chain(Encoding *encoding) {
    if (encoding->chain == NULL) encoding->chain = open_chain(&encoding->writer);
    return encoding->chain;
}

const bsmdec_error *encoding_error(const Encoding *encoding) { return &encoding->writer.context.error; }
const Payload *encoding_payloads(const Encoding *encoding) { return &encoding->payloads; }

static bool begin_again(Encoding *encoding, int64_t capacity) {
    end_payloads(&encoding->writer.context, &encoding->payloads);
    encoding->payloads = (Payload){0};
    return begin_payloads(&encoding->writer.context, capacity, &encoding->payloads);
}

Payload *encoding_anew(Encoding *encoding) {
    return begin_again(encoding, 1 << 12) ? &encoding->payloads : NULL;
}

bool encode_joined(Encoding *encoding, ConstInts2 faces, ConstInts places, bool keep, bool keeps,
    JoinedArrays *arrays) {
    PayloadWriter *writer = &encoding->writer;
    JoinedMesh *joined = &encoding->joined;
    int64_t n = places.size;
    Ints place;
    if (faces.columns != 3 || !are_below(faces.data, 3 * faces.rows, 0, n) || !are_below(places.data, n, 0, n))
        return FAIL(&writer->context, MISUSED, "faces and places do not fit together");
    encoding->given = (GivenMesh){n, faces.rows, 1, {NULL, 0, 3}, (const uint32_t *)faces.data};
    encoding->coded = (CodedMesh){.given = &encoding->given, .joined = joined, .keeps = keeps};
    if (!take_ints(&writer->scratch, n, &place)) return false;
    memcpy(place.data, places.data, (size_t)n * sizeof *place.data);
    bool done = join_places(&encoding->given, place, keep, writer, joined);
    release_all(&writer->scratch);
    *arrays = (JoinedArrays){const_ints(joined->index), const_ints(joined->first), const_ints(joined->kept),
        joined->merged, joined->loose};
    return done;
}

bool encode_faces(Encoding *encoding, ConstInts merged, int repeats, CodedArrays *arrays) {
    int64_t n = encoding->joined.first.size, vertices = merged.data != NULL ? 0 : n;
    CodedMesh *coded = &encoding->coded;
    if (coded->joined == NULL || (merged.data != NULL && (merged.size != n || !are_below(merged.data, n, 0, n))))
        return FAIL(&encoding->writer.context, MISUSED, "# vertices are merged of # joined ones", merged.size, n);
    if (repeats < AS_CORNERS || repeats > WHERE_SMALLER)
        return FAIL(&encoding->writer.context, MISUSED, "# is not a way to code faces that repeat a corner", repeats);
    for (int64_t i = 0; i < merged.size; i++) vertices = largest(vertices, merged.data[i] + 1);
    encoding->carried = NULL; /* the attributes of another order */
    coded->repeats = repeats;
    if (!begin_again(encoding, 1 << 16)
        || !order_faces(&encoding->writer, merged.data, vertices, &encoding->payloads, coded))
        return false;
    *arrays = (CodedArrays){const_ints(coded->vertex_order), const_ints(coded->face_order), const_ints2(coded->faces),
        const_bytes(coded->turns), coded->repeats};
    return true;
}

bool encode_order(Encoding *encoding, ConstDoubles2 positions) {
    Buffer section = {.context = &encoding->writer.context};
    if (positions.rows != encoding->given.vertices || positions.columns != 3 || encoding->coded.faces.rows == 0)
        return FAIL(section.context, MISUSED, "# positions for # vertices", positions.rows, encoding->given.vertices);
    encoding->given.positions = positions;
    end_payloads(section.context, &encoding->payloads);
    put_order(&section, &encoding->coded, &encoding->writer.scratch);
    encoding->payloads = (Payload){section.data, section.capacity, section.size, {section.size}, 1};
    return !failed(section.context);
}

bool encode_carried(Encoding *encoding, const bsmenc_attribute *given, bool first, CarriedOutcome *whole) {
    PayloadWriter *writer = &encoding->writer;
    const CodedMesh *coded = &encoding->coded;
    bool by_vertex = given->domain == BSMDEC_VERTEX, by_face = given->domain == BSMDEC_FACE;
    int64_t rows = by_vertex ? encoding->given.vertices : by_face ? encoding->given.faces : given->rows;
    if (encoding->carried == NULL) {
        if (!TAKE_ZEROS(&writer->arena, MOST_ATTRIBUTES, encoding->carried)
            || !link_mesh(&writer->context, const_ints2(coded->faces), coded->vertex_order.size, &writer->arena,
                &writer->scratch, &encoding->coded.corners))
            return false;
        encoding->mark = mark_of(&writer->arena);
    }
    if (first) encoding->carried_count = 0;
    int number = encoding->carried_count;
    Carried *carried = encoding->carried + number;
    if (coded->faces.rows == 0 || given->rows != rows || number >= MOST_ATTRIBUTES || strlen(given->name) > MOST_NAME
        || (!by_vertex && !by_face
            && (given->indices == NULL
                || !are_below((const int32_t *)given->indices, 3 * encoding->given.faces, 0, rows))))
        return FAIL(&writer->context, MISUSED, "values and faces do not fit together");
    if (first) release_to(&writer->arena, encoding->mark);
    memset(carried, 0, sizeof *carried);
    if (!carry_attribute(writer, coded, given, number, encoding->carried)
        || !begin_again(encoding, carried->seams.size + 64)
        || !write_seams(writer, coded, number, encoding->carried, &encoding->payloads))
        return false;
    encoding->carried_count++;
    const Declaration *d = &carried->quantized.declaration;
    Ints2 pieces = {NULL, 0, 0};
    if (d->words > 0 && !take_pieces(&writer->arena, carried, &pieces)) return false;
    encoding->declared = declaration_record(d);
    *whole = (CarriedOutcome){carried->quantized.outcome, pieces.data,
        d->domain == BSMDEC_CORNER ? carried->faces.data : NULL, carried->vertices.data, d->rows, pieces.columns,
        carried->vertices.size, d->words > 0 && can_lean(d), const_doubles2(carried->tangents),
        const_ints(carried->rows)};
    return true;
}

bool encode_turns(Encoding *encoding, const TangentArrays *a, int32_t *words, double *values, double *error,
    bool *near) {
    PayloadWriter *writer = &encoding->writer;
    int64_t m = a->faces.rows, rows = a->vertices.size, n = a->places.rows;
    GivenTangents given = {{a->faces, a->normal_faces, a->coordinate_faces, a->vertices.data, a->places,
                               a->coordinates, rows},
        a->normals.data, a->tangents.data, a->rows.data, a->size};
    Longs2 turns;
    if (a->normal_faces.rows != m || a->coordinate_faces.rows != m || a->rows.size != 3 * m || a->size < 1
        || !are_below(a->faces.data, 3 * m, 0, rows) || !are_below(a->normal_faces.data, 3 * m, 0, a->normals.rows)
        || !are_below(a->coordinate_faces.data, 3 * m, 0, a->coordinates.rows)
        || !are_below(a->vertices.data, rows, 0, n) || !are_below(a->rows.data, 3 * m, 0, a->tangents.rows))
        return FAIL(&writer->context, MISUSED, "tangents, normals and texture coordinates do not fit together");
    bool done = take_longs2(&writer->scratch, rows, 2, &turns)
        && turn_tangents(&writer->scratch, &given, turns, values, error);
    for (int64_t i = 0; done && i < 2 * rows; i++) words[i] = (int32_t)turns.data[i];
    *near = done && is_turn_near(*error, a->size);
    release_all(&writer->scratch);
    return done;
}

int carried_field(const Encoding *encoding, int key, const double **numbers) {
    return numbers_of(&encoding->declared, key, numbers);
}

bool encode_positions(Encoding *encoding, const Encoding *like, Source given, const int32_t *largest, int light,
    const double *origin, double step, const double *exact, const int32_t *transforms, int congruence) {
    const GridField *known = light != LIGHT && like != NULL ? &like->field.grid : NULL;
    return begin_positions(&encoding->field, known != NULL && known->grid.order.data != NULL ? known : NULL,
        &encoding->writer.context, given, largest, light, origin, step, exact, transforms, congruence);
}

bool encode_going(Encoding *encoding, const double *wanted) {
    Twins *twins = encoding->field.kind == ON_GRID ? encoding->field.grid.twins : NULL;
    if (twins == NULL) return FAIL(&encoding->writer.context, MISUSED, "this field has no images");
    twins->wanted = wanted;
    return true;
}

bool encode_mended(Encoding *encoding, Ints2 places, const int32_t *largest, const double *wanted) {
    const CodedField *field = &encoding->field;
    if (field->kind != ON_GRID || places.rows != field->header.vertices
        || !are_below(places.data, 3 * places.rows, 0, INT32_MAX))
        return FAIL(&encoding->writer.context, MISUSED, "these places are not of this mesh");
    Arena *scratch = &encoding->writer.scratch;
    Mark mark = mark_of(scratch);
    uint8_t *tried;
    if (!TAKE_ZEROS(scratch, places.rows, tried)) return false;
    mend_places(&field->grid.corners, places, wanted, largest, tried);
    release_to(scratch, mark);
    return true;
}

bool encode_levels(Encoding *encoding, Source given) {
    return begin_refinement(&encoding->field, &encoding->writer.context, given);
}

bool encode_attribute(Encoding *encoding, Source given, const uint8_t *declaration, int64_t size, int64_t vertices,
    const int32_t *at, const int32_t *places, int swift) {
    PayloadWriter *writer = &encoding->writer;
    Declaration declared;
    return parse_declaration(&writer->context, (Span){declaration, size}, &writer->scratch, &declared)
        && begin_attribute(&encoding->field, &writer->context, given, &declared, vertices, at, places, swift);
}

bool encode_chunk(Encoding *encoding, int64_t first, int64_t count) {
    return begin_again(encoding, room_of_chunk(&encoding->field, count))
        && code_chunk(&encoding->field, first, count, (Span){0}, &encoding->payloads);
}

bool decode_field_chunk(Encoding *encoding, int64_t first, int64_t count, const uint8_t *payload, int64_t size) {
    return code_chunk(&encoding->field, first, count, (Span){payload, size}, NULL);
}

void carried_values(const Encoding *encoding, void *values) {
    const Carried *carried = encoding->carried + encoding->carried_count - 1;
    const Declaration *d = &carried->quantized.declaration;
    for (int64_t r = 0; r < d->rows; r++) restore(d, carried->levels.data + d->words * r, r, values);
}

bool encode_rounded(Encoding *encoding, const double *positions, int64_t rows, int bits, double cell,
    const double *origin, double *grid, int32_t *places) {
    Context *context = &encoding->writer.context;
    ConstDoubles2 given = {positions, rows, 3};
    Rounded rounded = {.places = {places, rows, 3}};
    bool done = bits > 0 ? round_to_bits(context, given, bits, &rounded)
        : cell > 0.0 ? round_to_cells(context, given, cell, origin, &rounded) : round_exactly(context, given, &rounded);
    memcpy(grid, rounded.origin, sizeof rounded.origin);
    grid[3] = rounded.step;
    for (int j = 0; j < 3; j++) grid[4 + j] = rounded.largest[j];
    return done;
}

const int32_t *encoding_order(const Encoding *encoding) {
    const CodedField *field = &encoding->field;
    return field->kind == OF_VALUES ? field->attribute.group[0].order.data : field->grid.order.data;
}

const int32_t *encoding_values(const Encoding *encoding) {
    const CodedField *field = &encoding->field;
    return field->kind == ON_GRID ? field->grid.values.data
        : field->kind == OF_LEVELS ? field->layer.levels.levels.data : field->attribute.group[0].pieces.data;
}
