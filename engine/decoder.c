/* The functions of bsmdec.h. */
#include "engine/decoder.h"

#include <stdlib.h>

void bsmdec_default_limits(bsmdec_limits *limits) {
    *limits = (bsmdec_limits){
        .vertices = 1 << 24, .faces = 1 << 25, .blocks = 1 << 17, .block_size = 8192, .coefficients = 4096, .frames = 1 << 20,
        .gop_frames = 1024, .frame_bytes = 1 << 28, .metadata_bytes = 1 << 23, .attributes = 255, .attribute_values = 1 << 28,
        .sequence_bytes = 2147483648.0, .field_bytes = 4294967296.0, .work = 8e8, .work_per_vertex = 3.2e4, .work_per_byte = 1.6e4,
        .most_work = 1e300, .memory = 1 << 26, .memory_per_vertex = 1 << 10, .memory_per_byte = 64, .most_memory = 1e300,
        .heap = sizeof(size_t) > 4 ? 0x1p40 : 2147483648.0,
    };
}

static void *take_of_library(void *host, size_t size) {
    (void)host;
    return malloc(size);
}

static void give_to_library(void *host, void *memory, size_t size) {
    (void)host;
    (void)size;
    free(memory);
}

bsmdec *bsmdec_open(const bsmdec_options *options) {
    bsmdec_allocator host = {take_of_library, give_to_library, NULL};
    if (options != NULL && options->allocator != NULL) host = *options->allocator;
    if (host.allocate == NULL || host.release == NULL) return NULL;
    bsmdec *decoder = host.allocate(host.host, sizeof *decoder);
    if (decoder == NULL) return NULL;
    memset(decoder, 0, sizeof *decoder);
    Context *context = &decoder->context;
    context->host = host;
    context->heap = sizeof *decoder;
    context->error.offset = context->error.frame = context->error.block = -1;
    if (options != NULL && options->limits != NULL) context->limits = *options->limits;
    else bsmdec_default_limits(&context->limits);
    decoder->tolerant = options != NULL && options->tolerant != 0;
    decoder->sequence.start = options != NULL ? options->start : 0;
    decoder->sequence.waiting = arena_of(context);
    decoder->loss = context->error;
    decoder->scratch = decoder->shown = arena_of(context);
    begin_reader(&decoder->reader, context, decoder->tolerant);
    return decoder;
}

void bsmdec_close(bsmdec *decoder) {
    if (decoder == NULL) return;
    Context *context = &decoder->context;
    if (decoder->has_mesh) end_mesh(&decoder->mesh);
    close_sequence(decoder);
    release_all(&decoder->scratch);
    release_all(&decoder->shown);
    end_reader(&decoder->reader);
    host_give(context, decoder->queue, (size_t)decoder->room * sizeof *decoder->queue);
    host_give(context, decoder->losses, (size_t)decoder->loss_room * sizeof *decoder->losses);
    context->host.release(context->host.host, decoder, sizeof *decoder);
}

bsmdec_status bsmdec_push(bsmdec *decoder, const void *bytes, size_t size) {
    if (decoder == NULL || (bytes == NULL && size > 0) || size > INT64_MAX / 4 || decoder->reader.finished) return BSMDEC_MISUSED;
    if (failed(&decoder->context) || size == 0) return decoder->context.error.status;
    receive(&decoder->reader, (Span){bytes, (int64_t)size});
    return decoder->context.error.status;
}

bsmdec_status bsmdec_finish(bsmdec *decoder) {
    if (decoder == NULL) return BSMDEC_MISUSED;
    decoder->reader.finished = true;
    return BSMDEC_OK;
}

/* Have an event wait to be told. */
bool tell(bsmdec *decoder, bsmdec_event_type type, int64_t index, int64_t count) {
    Context *context = &decoder->context;
    if (decoder->waiting == decoder->room) {
        int64_t room = 2 * decoder->room + 16;
        bsmdec_event *queue = host_take(context, (size_t)room * sizeof *queue);
        if (queue == NULL) return false;
        for (int64_t i = 0; i < decoder->waiting; i++) queue[i] = decoder->queue[(decoder->first + i) % decoder->room];
        host_give(context, decoder->queue, (size_t)decoder->room * sizeof *queue);
        decoder->queue = queue;
        decoder->room = room;
        decoder->first = 0;
    }
    const Mesh *mesh = &decoder->mesh;
    bool real = mesh->announced;
    decoder->queue[(decoder->first + decoder->waiting++) % decoder->room] = (bsmdec_event){type, index, count,
        real ? mesh->numbering.size : type == BSMDEC_HEADER ? mesh->header.vertices : 0, real || type == BSMDEC_HEADER ? mesh->header.faces : 0};
    return true;
}

/* Take in what has come, until there is an event, an error, or nothing more. */
static bsmdec_event_type advance(bsmdec *decoder) {
    Context *context = &decoder->context;
    while (decoder->waiting == 0) {
        Packet packet;
        Arrival arrival = next_packet(&decoder->reader, &packet);
        if (arrival == NO_MORE && !decoder->ended) arrival = accept_end(decoder) ? A_PACKET : NOTHING_BUT_AN_ERROR; /* a tolerant reader may find no END */
        else if (arrival == A_PACKET && !accept_packet(decoder, &packet)) arrival = NOTHING_BUT_AN_ERROR;
        else if (arrival == A_DAMAGE && !accept_damage(decoder)) arrival = NOTHING_BUT_AN_ERROR;
        if (arrival == NO_MORE_YET) return BSMDEC_NEED_DATA;
        if (arrival == NO_MORE) return BSMDEC_END_OF_STREAM;
        if (arrival == NOTHING_BUT_AN_ERROR) {
            locate(&context->error, decoder->reader.offset, decoder->reader.frames, -1);
            if (decoder->waiting == 0) return BSMDEC_ERROR;
        }
    }
    return BSMDEC_END;
}

bsmdec_status bsmdec_next(bsmdec *decoder, bsmdec_event *event) {
    if (decoder == NULL || event == NULL) return BSMDEC_MISUSED;
    bsmdec_event_type type = decoder->waiting > 0 ? BSMDEC_END : failed(&decoder->context) ? BSMDEC_ERROR : advance(decoder);
    if (decoder->waiting == 0) {
        *event = (bsmdec_event){.type = type};
        return type == BSMDEC_ERROR ? decoder->context.error.status : BSMDEC_OK;
    }
    *event = decoder->queue[decoder->first];
    decoder->first = (decoder->first + 1) % decoder->room;
    decoder->waiting--;
    if (event->type == BSMDEC_FRAME && !show(decoder, event->index)) {
        decoder->waiting = 0;
        *event = (bsmdec_event){.type = BSMDEC_ERROR};
        return decoder->context.error.status;
    }
    if (event->type == BSMDEC_LOSS) {
        decoder->loss = decoder->losses[0];
        memmove(decoder->losses, decoder->losses + 1, (size_t)--decoder->loss_count * sizeof *decoder->losses);
    }
    return BSMDEC_OK;
}

bsmdec_status bsmdec_faces(bsmdec *decoder, uint32_t *corners, size_t count) {
    if (decoder == NULL || corners == NULL || !decoder->mesh.announced) return BSMDEC_MISUSED;
    ConstInts2 faces = decoder->mesh.numbering.faces;
    if (count != (size_t)(3 * faces.rows)) return BSMDEC_MISUSED;
    for (int64_t i = 0; i < 3 * faces.rows; i++) corners[i] = (uint32_t)faces.data[i];
    return BSMDEC_OK;
}

/* Where vertex v of the user is; `loose` counts those in no face. */
static const double *place_of(const bsmdec *decoder, int64_t v, int64_t *loose) {
    const Numbering *numbering = &decoder->mesh.numbering;
    int64_t coded = numbering->source.size > 0 ? numbering->source.data[v] : v;
    return coded < 0 ? numbering->loose.data + 3 * (*loose)++ : decoder->positions.data + 3 * coded;
}

static bool can_show(bsmdec *decoder, const void *to, size_t count) {
    return decoder != NULL && to != NULL && count == (size_t)(3 * decoder->mesh.numbering.size)
        && (decoder->has_positions || look_at_positions(decoder));
}

bsmdec_status bsmdec_positions(bsmdec *decoder, double *coordinates, size_t count) {
    if (!can_show(decoder, coordinates, count)) return BSMDEC_MISUSED;
    int64_t loose = 0;
    for (size_t v = 0; v < count / 3; v++) memcpy(coordinates + 3 * v, place_of(decoder, (int64_t)v, &loose), 3 * sizeof(double));
    return BSMDEC_OK;
}

bsmdec_status bsmdec_positions_single(bsmdec *decoder, float *coordinates, size_t count) {
    if (!can_show(decoder, coordinates, count)) return BSMDEC_MISUSED;
    int64_t loose = 0;
    for (size_t v = 0; v < count / 3; v++) {
        const double *place = place_of(decoder, (int64_t)v, &loose);
        for (int d = 0; d < 3; d++) coordinates[3 * v + (size_t)d] = (float)place[d];
    }
    return BSMDEC_OK;
}

bsmdec_status bsmdec_metadata_at(const bsmdec *decoder, int64_t index, bsmdec_metadata *entry) {
    if (decoder == NULL || entry == NULL || index < 0 || index >= decoder->reader.metadata.count) return BSMDEC_MISUSED;
    const Saying *said = decoder->reader.metadata.said[index];
    *entry = (bsmdec_metadata){(const char *)said->name.data, said->kind, said->whole, said->number, said->bytes.data, (size_t)said->bytes.size};
    return BSMDEC_OK;
}

/* An attribute that is whole; NULL if there is none of that number. */
static const Attribute *attribute_of(const bsmdec *decoder, int index) {
    if (decoder == NULL || !decoder->mesh.has_attributes || !decoder->mesh.announced || index < 0 || index >= MOST_ATTRIBUTES) return NULL;
    const Attribute *one = decoder->mesh.attributes.one[index];
    return one != NULL && one->whole ? one : NULL;
}

int bsmdec_attribute_count(const bsmdec *decoder) {
    return decoder != NULL && decoder->mesh.has_attributes ? (int)decoder->mesh.header.attributes : 0;
}

bsmdec_status bsmdec_attribute_at(const bsmdec *decoder, int index, bsmdec_attribute *attribute) {
    const Attribute *one = attribute_of(decoder, index);
    if (one == NULL || attribute == NULL) return BSMDEC_MISUSED;
    const Declaration *d = &one->declaration;
    Given given = given_shape(one, &decoder->mesh.numbering);
    int64_t corners = given.domain == BSMDEC_CORNER ? 3 * decoder->mesh.faces.rows : 0;
    *attribute = (bsmdec_attribute){d->name, given.domain, d->semantic, d->kind, d->components, given.rows, corners, d->moves};
    return BSMDEC_OK;
}

bsmdec_status bsmdec_attribute_values(bsmdec *decoder, int index, void *values, size_t size) {
    const Attribute *one = attribute_of(decoder, index);
    bsmdec_attribute shape;
    if (bsmdec_attribute_at(decoder, index, &shape) != BSMDEC_OK || values == NULL) return BSMDEC_MISUSED;
    size_t each = (size_t)shape.components * kind_size(shape.kind);
    if (size != (size_t)shape.rows * each) return BSMDEC_MISUSED;
    Arena own = arena_of(&decoder->context);
    Longs rows = take_longs(&own, shape.rows);
    bool done = rows.data != NULL && given_rows(one, &decoder->mesh.numbering, &own, rows);
    for (int64_t i = 0; done && i < shape.rows; i++)
        memcpy((char *)values + (size_t)i * each, (const char *)(one->moved != NULL ? one->moved : one->values) + (size_t)rows.data[i] * each, each);
    release_all(&own);
    return done ? BSMDEC_OK : decoder->context.error.status;
}

bsmdec_status bsmdec_attribute_indices(bsmdec *decoder, int index, uint32_t *indices, size_t count) {
    const Attribute *one = attribute_of(decoder, index);
    bsmdec_attribute shape;
    if (bsmdec_attribute_at(decoder, index, &shape) != BSMDEC_OK || indices == NULL || shape.indices == 0 || count != (size_t)shape.indices)
        return BSMDEC_MISUSED;
    for (size_t i = 0; i < count; i++) indices[i] = (uint32_t)row_of_corner(one, &decoder->mesh.numbering, (int64_t)i);
    return BSMDEC_OK;
}

const bsmdec_error *bsmdec_last_error(const bsmdec *decoder) { return decoder != NULL ? &decoder->context.error : NULL; }

const bsmdec_error *bsmdec_last_loss(const bsmdec *decoder) { return decoder != NULL ? &decoder->loss : NULL; }
