/* A stream in one call, into an array of vertices as graphics draw them. */
#include "library/arithmetic.h"
#include "library/state.h"

/* The mesh that a caller has, and what it is made with. */
typedef struct {
    bsmdec_mesh given;
    Arena fixed, buffers; /* fields and their attributes; vertices and indices */
    bsmdec_field *fields;
    int *attributes;
    size_t stride, index_size;
    bool finds_fields;
} Whole;

enum { SPACE = 3 }; /* components of positions */

static const bsmdec_error NO_ROOM = {BSMDEC_NO_MEMORY, -1, -1, -1, "there is no memory for a decoder", NULL, 0};
static const bsmdec_mesh NOTHING = {.error = &NO_ROOM};

static size_t packed_size(const bsmdec_field *field) { return (size_t)field->components * kind_size(field->kind); }

/* Whether an attribute is what a field asks for. */
static bool suits(const bsmdec_field *field, const bsmdec_attribute *shape) {
    if (shape->domain == BSMDEC_FACE || shape->semantic != field->semantic) return false;
    return field->name == NULL
        || (strlen(field->name) == strlen(shape->name) && memcmp(field->name, shape->name, strlen(shape->name)) == 0);
}

/* The attribute that a field asks for. */
static int attribute_for(bsmdec *decoder, const bsmdec_field *field) {
    bsmdec_attribute shape;
    if (field->semantic == BSMDEC_POSITION) return BSMDEC_POSITION;
    for (int k = 0; k < bsmdec_attribute_count(decoder); k++)
        if (find_shape(decoder, k, &shape) && suits(field, &shape)) return k;
    return BSMDEC_ABSENT;
}

/* Fields for all that vertices have, as floats. */
static bool find_fields(Whole *whole) {
    bsmdec *decoder = whole->given.decoder;
    size_t count = 1, all = (size_t)bsmdec_attribute_count(decoder) + 1;
    release_all(&whole->fixed);
    if (!TAKE(&whole->fixed, (int64_t)all, whole->fields) || !TAKE(&whole->fixed, (int64_t)all, whole->attributes))
        return false;
    whole->fields[0] = (bsmdec_field){BSMDEC_POSITION, NULL, BSMDEC_FLOAT32, SPACE, 0};
    whole->attributes[0] = BSMDEC_POSITION;
    whole->given.stride = packed_size(&whole->fields[0]);
    for (int k = 0; k + 1 < (int)all; k++) {
        bsmdec_attribute shape;
        if (!find_shape(decoder, k, &shape) || shape.domain == BSMDEC_FACE) continue;
        whole->fields[count] =
            (bsmdec_field){shape.semantic, shape.name, BSMDEC_FLOAT32, shape.components, whole->given.stride};
        whole->attributes[count] = k;
        whole->given.stride += packed_size(&whole->fields[count++]);
    }
    whole->given.field_count = count;
    if (whole->stride > 0 && whole->given.stride > whole->stride)
        return FAIL(&decoder->context, MISUSED, "a vertex has # bytes, more than the stride",
            (int64_t)whole->given.stride);
    if (whole->stride > 0) whole->given.stride = whole->stride;
    return true;
}

/* Replace a name of the caller by one of our own. */
static bool copy_name(Arena *arena, const char **name) {
    if (*name == NULL) return true;
    const size_t size = strlen(*name) + 1;
    char *own;
    if (!TAKE(arena, (int64_t)size, own)) return false;
    *name = memcpy(own, *name, size);
    return true;
}

/* Fields as the caller wants them. */
static bool copy_fields(Whole *whole, const bsmdec_options *options) {
    bsmdec *decoder = whole->given.decoder;
    const size_t most = options->stride > 0 ? options->stride : PTRDIFF_MAX; /* no array is larger */
    size_t stride = options->stride, widest = 1;
    if (!TAKE(&whole->fixed, (int64_t)options->field_count, whole->fields)
        || !TAKE(&whole->fixed, (int64_t)options->field_count, whole->attributes))
        return false;
    for (size_t i = 0; i < options->field_count; i++) {
        const bsmdec_field *field = &options->fields[i];
        if (!is_kind(field->kind) || field->components < 1 || field->components > MOST_COMPONENTS)
            return FAIL(&decoder->context, MISUSED, "field #: kind # or # components cannot be", (int64_t)i,
                field->kind, field->components);
        size_t end = field->offset + packed_size(field);
        if (end < field->offset || end > most)
            return FAIL(&decoder->context, MISUSED, "field # ends at byte # of a vertex, behind the stride", (int64_t)i,
                (int64_t)end);
        if (end > stride) stride = end;
        if (kind_size(field->kind) > widest) widest = kind_size(field->kind);
        whole->fields[i] = *field;
        if (!copy_name(&whole->fixed, &whole->fields[i].name)) return false;
    }
    whole->given.stride = options->stride > 0 ? stride : (stride + widest - 1) / widest * widest;
    whole->given.field_count = options->field_count;
    return true;
}

/* Find attributes for fields, and split vertices by them. */
static bool split_by_fields(Whole *whole) {
    bsmdec_mesh *given = &whole->given;
    int by[MOST_ATTRIBUTES], count = 0;
    if (whole->finds_fields && !find_fields(whole)) return false;
    for (size_t i = 0; i < given->field_count; i++) {
        if (!whole->finds_fields) whole->attributes[i] = attribute_for(given->decoder, &whole->fields[i]);
        if (whole->attributes[i] >= 0 && count < MOST_ATTRIBUTES) by[count++] = whole->attributes[i];
    }
    given->fields = whole->fields;
    given->attributes = whole->attributes;
    return bsmdec_split(given->decoder, by, count, &given->vertices) == BSMDEC_OK;
}

static bool make_buffers(Whole *whole, int64_t faces) {
    bsmdec_mesh *given = &whole->given;
    release_all(&whole->buffers);
    given->faces = faces;
    size_t needed = given->vertices > UINT16_MAX ? LONG_INDEX : SHORT_INDEX;
    given->index_size = whole->index_size > 0 ? whole->index_size : needed;
    given->vertex_bytes = (size_t)given->vertices * given->stride;
    return is_there(given->vertex_data = find_zeros(&whole->buffers, given->vertices, given->stride))
        && is_there(given->index_data = find_memory(&whole->buffers, 3 * faces, given->index_size))
        && bsmdec_split_indices(given->decoder, given->index_size, given->index_data, 3 * (size_t)faces) == BSMDEC_OK;
}

static bool write_fields(Whole *whole) {
    bsmdec_mesh *given = &whole->given;
    for (size_t i = 0; i < given->field_count; i++) {
        const bsmdec_field *field = &whole->fields[i];
        if (whole->attributes[i] != BSMDEC_ABSENT
            && bsmdec_split_values(given->decoder, whole->attributes[i], field->kind, field->components, given->stride,
                   (char *)given->vertex_data + field->offset, given->vertex_bytes - field->offset)
                != BSMDEC_OK)
            return false;
    }
    return true;
}

/* Bring the buffers up to the mesh, or to the current frame. */
static bool fill_buffers(Whole *whole, int64_t faces) {
    bool made = whole->given.decoder->split.is_made || (split_by_fields(whole) && make_buffers(whole, faces));
    return made && write_fields(whole);
}

/* Decode up to a frame, or to the end of the stream, and bring the buffers up to it. */
static bool decode_next(Whole *whole) {
    bsmdec_mesh *given = &whole->given;
    bsmdec *decoder = given->decoder;
    bsmdec_event event = {0};
    while (event.type != BSMDEC_FRAME && event.type != BSMDEC_END_OF_STREAM) {
        if (bsmdec_next(decoder, &event) != BSMDEC_OK) return false;
        given->losses += event.type == BSMDEC_LOSS;
        bool fills = event.type == BSMDEC_FRAME || (event.type == BSMDEC_END && !decoder->sequence.active);
        if (fills && !fill_buffers(whole, event.faces)) return false;
    }
    given->frame = event.type == BSMDEC_FRAME ? event.index : -1;
    given->frames = event.frames;
    return true;
}

/* The status for the caller. A refused call is an error of the options. After an error there is no mesh. */
static bsmdec_status status_of(Whole *whole, bool done) {
    bsmdec *decoder = whole->given.decoder;
    if (done) return BSMDEC_OK;
    fail_with(&decoder->context, BSMDEC_MISUSED, (Message){.text = decoder->misuse});
    whole->given = (bsmdec_mesh){.error = &decoder->context.error, .decoder = decoder, .frame = -1};
    return decoder->context.error.status;
}

EXACTLY(bsmdec_status, bsmdec_decode,
    (const void *bytes, size_t size, const bsmdec_options *given, bsmdec_mesh **mesh),
    (bytes, size, given, mesh)) {
    if (mesh == NULL) return BSMDEC_MISUSED;
    *mesh = (bsmdec_mesh *)&NOTHING;
    bsmdec *decoder = bsmdec_open(given);
    if (decoder == NULL) return BSMDEC_NO_MEMORY;
    Context *context = &decoder->context;
    /* Wrong options, such as this limit, are to be reported. */
    bool fits_heap = failed(context) || context->heap + (double)sizeof(Whole) <= context->limits.heap;
    Whole *whole = fits_heap ? context->host.allocate(context->host.host, sizeof *whole) : NULL;
    if (whole == NULL) {
        bsmdec_close(decoder);
        return BSMDEC_NO_MEMORY;
    }
    context->heap += sizeof *whole;
    *whole = (Whole){.given = {.error = &context->error, .decoder = decoder, .frame = -1},
        .fixed = arena_of(context),
        .buffers = arena_of(context)};
    *mesh = &whole->given;
    bsmdec_options options = {.size = sizeof options};
    bool known = copy_options(given, &options);
    whole->finds_fields = options.fields == NULL;
    whole->stride = options.stride;
    whole->index_size = options.index_size;
    bool done = known && !failed(context) && bsmdec_push(decoder, bytes, size) == BSMDEC_OK
        && bsmdec_finish(decoder) == BSMDEC_OK && (whole->finds_fields || copy_fields(whole, &options))
        && decode_next(whole);
    return status_of(whole, done);
}

EXACTLY(bsmdec_status, bsmdec_advance, (bsmdec_mesh *mesh), (mesh)) {
    if (mesh == NULL || mesh->decoder == NULL) return BSMDEC_MISUSED;
    return status_of((Whole *)mesh, decode_next((Whole *)mesh));
}

void bsmdec_release(bsmdec_mesh *mesh) {
    if (mesh == NULL || mesh->decoder == NULL) return;
    Whole *whole = (Whole *)mesh;
    bsmdec *decoder = mesh->decoder;
    const bsmdec_allocator *host = &decoder->context.host;
    release_all(&whole->fixed);
    release_all(&whole->buffers);
    host->release(host->host, whole, sizeof *whole);
    bsmdec_close(decoder);
}
