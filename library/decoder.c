/* The functions of bsmdec.h. */
#include "library/state.h"

#include "library/arithmetic.h"

/* The smallest sizes of the callers' structures: those of release 1.0. Do not change them. Add new fields at the end,
 * so that no padding follows them. */
enum {
    LIMITS_SIZE = offsetof(bsmdec_limits, heap) + sizeof(double),
    ALLOCATOR_SIZE = offsetof(bsmdec_allocator, host) + sizeof(void *),
    PARALLEL_SIZE = offsetof(bsmdec_parallel, threads) + sizeof(int64_t),
    OPTIONS_SIZE = offsetof(bsmdec_options, index_size) + sizeof(size_t),
    MAX_SIZE = 4096
};

/* Copy a structure of a caller, which begins with its size, over the defaults. */
static bool copy_given(void *own, size_t known, size_t least, const void *given) {
    size_t size;
    memcpy(&size, given, sizeof size);
    if (size < least || size > MAX_SIZE) return false;
    for (size_t i = known; i < size; i++)
        if (((const unsigned char *)given)[i] != 0) return false;
    memcpy(own, given, size < known ? size : known);
    return true;
}

static bsmdec_limits default_limits(void) {
    return (bsmdec_limits){
        .size = sizeof(bsmdec_limits), .vertices = 1 << 24, .faces = 1 << 25, .blocks = 1 << 17, .block_size = 8192,
        .coefficients = 4096, .frames = 1 << 20, .gop_frames = 1024, .frame_bytes = 1 << 28, .metadata_bytes = 1 << 23,
        .attributes = 255, .attribute_values = 1 << 28, .sequence_bytes = 2147483648.0, .field_bytes = 4294967296.0,
        .work = 8e8, .work_per_vertex = 3.2e4, .work_per_byte = 1.6e4, .most_work = 1e300, .memory = 1 << 26,
        .memory_per_vertex = 1 << 10, .memory_per_byte = 64, .most_memory = 1e300,
        .heap = sizeof(size_t) > 4 ? 0x1p40 : 2147483648.0,
    };
}

bsmdec_status bsmdec_default_limits(bsmdec_limits *limits, size_t size) {
    const bsmdec_limits usual = default_limits();
    if (limits == NULL || size < LIMITS_SIZE || size > MAX_SIZE) return BSMDEC_MISUSED;
    memset(limits, 0, size);
    memcpy(limits, &usual, size < sizeof usual ? size : sizeof usual);
    limits->size = size;
    return BSMDEC_OK;
}

/* Take over the limits of a caller; the context fails if they are none. */
static void take_limits(Context *context, const bsmdec_limits *given) {
    bsmdec_limits *limits = &context->limits;
    if (!copy_given(limits, sizeof *limits, LIMITS_SIZE, given))
        FAIL(context, MISUSED,
            "limits.size is not sizeof(bsmdec_limits), or fields are set that this release does not know");
    const double *each = (const double *)((const char *)limits + offsetof(bsmdec_limits, vertices));
    const int64_t count = (int64_t)((sizeof *limits - offsetof(bsmdec_limits, vertices)) / sizeof *each);
    for (int64_t i = 0; i < count; i++)
        if (!(each[i] >= 0.0)) FAIL(context, MISUSED, "field # of the limits is negative or not a number", i + 1);
}

bool copy_options(const bsmdec_options *given, bsmdec_options *options) {
    return given == NULL || copy_given(options, sizeof *options, OPTIONS_SIZE, given);
}

EXACTLY(bsmdec *, bsmdec_open, (const bsmdec_options *given), (given)) {
    make_tables();
    bsmdec_options options = {.size = sizeof options};
    bsmdec_allocator usual = library_allocator(), host = usual;
    bool known = copy_options(given, &options);
    bool own = known && options.allocator != NULL;
    bool allocates = !own
        || (copy_given(&host, sizeof host, ALLOCATOR_SIZE, options.allocator) && host.allocate != NULL
            && host.release != NULL);
    bsmdec_parallel parallel = {.size = sizeof parallel};
    bool runs = !known || options.parallel == NULL
        || (copy_given(&parallel, sizeof parallel, PARALLEL_SIZE, options.parallel) && parallel.run != NULL);
    if (!allocates) host = usual;
    bool limited = known && options.limits != NULL && options.limits->size >= LIMITS_SIZE;
    double heap = limited ? options.limits->heap : default_limits().heap;
    if (heap >= 0.0 && heap < (double)sizeof(bsmdec)) return NULL;
    bsmdec *decoder = host.allocate(host.host, sizeof *decoder);
    if (decoder == NULL) return NULL;
    memset(decoder, 0, sizeof *decoder);
    Context *context = &decoder->context;
    context->host = with_pool(host, &decoder->pool);
    context->heap = sizeof *decoder;
    context->limits = default_limits();
    context->error.offset = context->error.frame = context->error.block = -1;
    decoder->loss = context->error;
    if (!known)
        FAIL(context, MISUSED,
            "options.size is not sizeof(bsmdec_options), or fields are set that this release does not know");
    else if (!allocates)
        FAIL(context, MISUSED, "allocator.size is not sizeof(bsmdec_allocator), or a function is NULL");
    else if (!runs)
        FAIL(context, MISUSED, "parallel.size is not sizeof(bsmdec_parallel), or run is NULL");
    else if (options.limits != NULL) take_limits(context, options.limits);
    decoder->parallel = parallel;
    if (!is_exact())
        FAIL(context, UNSUPPORTED,
            "this build of bsmdec does not round as IEEE 754: compile it without fast or fused arithmetic");
    decoder->tolerant = options.tolerant != 0;
    decoder->base_alone = options.layers == 1;
    decoder->sequence.start = options.start > 0 ? options.start : 0;
    decoder->sequence.waiting = arena_of(context);
    decoder->scratch = decoder->shown = decoder->split.arena = arena_of(context);
    decoder->changes.memory = decoder->changes.answer = arena_of(context);
    begin_reader(&decoder->reader, context, decoder->tolerant);
    return decoder;
}

void bsmdec_close(bsmdec *decoder) {
    if (decoder == NULL) return;
    Context *context = &decoder->context;
    if (decoder->has_mesh) end_mesh(&decoder->mesh);
    close_sequence(decoder);
    forget_changes(&decoder->changes);
    release_all(&decoder->scratch);
    release_all(&decoder->shown);
    forget_split(decoder);
    end_reader(&decoder->reader);
    host_give(context, decoder->queue, (size_t)decoder->slots * sizeof *decoder->queue);
    bsmdec_allocator host = without_pool(context->host);
    host.release(host.host, decoder, sizeof *decoder);
}

bsmdec_status refuse(bsmdec *decoder, Message message) {
    write_message(decoder->misuse, sizeof decoder->misuse, message);
    return BSMDEC_MISUSED;
}

bool fits(bsmdec *decoder, const void *array, size_t count, int64_t expected) {
    if (array == NULL) return REFUSE(decoder, "the array is NULL"), false;
    return count == (size_t)expected || (REFUSE(decoder, "size #, expected #", (int64_t)count, expected), false);
}

EXACTLY(bsmdec_status, bsmdec_push, (bsmdec *decoder, const void *bytes, size_t size), (decoder, bytes, size)) {
    if (decoder == NULL) return BSMDEC_MISUSED;
    if (bytes == NULL && size > 0) return REFUSE(decoder, "bytes is NULL");
    if ((uint64_t)size > INT64_MAX / 4) return REFUSE(decoder, "size exceeds the address space");
    if (decoder->reader.finished) return REFUSE(decoder, "bytes are pushed after bsmdec_finish");
    if (failed(&decoder->context) || size == 0) return decoder->context.error.status;
    return receive(&decoder->reader, (Span){bytes, (int64_t)size}) ? BSMDEC_OK : decoder->context.error.status;
}

bsmdec_status bsmdec_finish(bsmdec *decoder) {
    if (decoder == NULL) return BSMDEC_MISUSED;
    decoder->reader.finished = true;
    return decoder->context.error.status == BSMDEC_MISUSED ? BSMDEC_MISUSED : BSMDEC_OK; /* by wrong options */
}

/* What comes before the blocks of the first mesh, and these: all that a helper needs. */
static bool is_for_helpers(const Packet *packet) {
    return packet->type == HEADER_FRAME || packet->type == CONNECTIVITY_FRAME || packet->type == PARTITION_FRAME
        || packet->type == BLOCK_FRAME;
}

static bool accept_packet(bsmdec *decoder, const Packet *packet) {
    if (decoder->share.helps && !is_for_helpers(packet)) return true;
    Mark mark = mark_of(&decoder->scratch);
    bool in_sequence = decoder->sequence.active || (packet->type == HEADER_FRAME && packet->header->gop_frames > 0);
    decoder->has_checksum = packet->has_positions && (!in_sequence || decoder->sequence.start == 0);
    decoder->expected_sum = packet->positions;
    bool done = in_sequence ? accept_in_sequence(decoder, packet) : accept_section(decoder, packet);
    release_to(&decoder->scratch, mark);
    return done;
}

static bool accept_damage(bsmdec *decoder) {
    decoder->context.error = decoder->reader.damage.why;
    decoder->context.error.status = BSMDEC_CORRUPT;
    locate(&decoder->context.error, decoder->reader.damaged_offset, -1, -1);
    return decoder->sequence.active ? accept_damage_in_sequence(decoder) : accept_damage_in_mesh(decoder);
}

/* Read received bytes until there is an event, an error, or nothing more. */
static bsmdec_event_type advance(bsmdec *decoder) {
    Context *context = &decoder->context;
    while (decoder->waiting == 0) {
        if (decoder->over) return BSMDEC_END_OF_STREAM;
        Packet packet;
        Arrival arrival = next_packet(&decoder->reader, &packet);
        if (arrival == NO_MORE && !decoder->ended)
            arrival = (decoder->sequence.active ? end_sequence(decoder) : finish_mesh(decoder))
                ? A_PACKET : NOTHING_BUT_AN_ERROR; /* a tolerant reader may find no END */
        else if (arrival == A_PACKET && !accept_packet(decoder, &packet)) arrival = NOTHING_BUT_AN_ERROR;
        else if (arrival == A_DAMAGE && !accept_damage(decoder)) arrival = NOTHING_BUT_AN_ERROR;
        if (arrival == NO_MORE_YET) return BSMDEC_NEED_DATA;
        if (arrival == NO_MORE) return BSMDEC_END_OF_STREAM;
        if (arrival == NOTHING_BUT_AN_ERROR) {
            locate(&context->error, decoder->reader.last_offset, decoder->reader.last_frame, -1);
            if (decoder->waiting == 0) return BSMDEC_ERROR;
        }
    }
    return BSMDEC_END;
}

EXACTLY(bsmdec_status, bsmdec_next, (bsmdec *decoder, bsmdec_event *event), (decoder, event)) {
    if (decoder == NULL) return BSMDEC_MISUSED;
    if (event == NULL) return REFUSE(decoder, "event is NULL");
    bsmdec_event_type type = decoder->waiting > 0 ? BSMDEC_END
        : failed(&decoder->context)               ? BSMDEC_ERROR
                                                  : advance(decoder);
    if (decoder->waiting == 0) {
        *event = event_of(decoder, type, 0, 0);
        return type == BSMDEC_ERROR ? decoder->context.error.status : BSMDEC_OK;
    }
    const Report *report = decoder->queue + decoder->first;
    *event = report->event;
    decoder->first = (decoder->first + 1) % decoder->slots;
    decoder->waiting--;
    if (event->type == BSMDEC_FRAME && !show(decoder, event->index)) {
        decoder->waiting = 0;
        *event = event_of(decoder, BSMDEC_ERROR, 0, 0);
        return decoder->context.error.status;
    }
    if (event->type == BSMDEC_LOSS) decoder->loss = report->loss;
    return BSMDEC_OK;
}

bsmdec_status bsmdec_faces(bsmdec *decoder, uint32_t *corners, size_t count) {
    if (decoder == NULL) return BSMDEC_MISUSED;
    if (!decoder->mesh.announced) return REFUSE(decoder, "faces are known after CONNECTIVITY");
    ConstInts2 faces = decoder->mesh.numbering.faces;
    if (!fits(decoder, corners, count, 3 * faces.rows)) return BSMDEC_MISUSED;
    for (int64_t i = 0; i < 3 * faces.rows; i++) corners[i] = (uint32_t)faces.data[i];
    return BSMDEC_OK;
}

const double *place_of(const bsmdec *decoder, int64_t v, int64_t *loose) {
    const Numbering *numbering = &decoder->mesh.numbering;
    int64_t coded = numbering->source.size > 0 ? numbering->source.data[v] : v;
    return coded < 0 ? numbering->loose.data + 3 * (*loose)++ : decoder->positions.data + 3 * coded;
}

bsmdec_status find_places(bsmdec *decoder) {
    if (decoder->has_positions || (!decoder->ended && look_at_positions(decoder))) return BSMDEC_OK;
    if (failed(&decoder->context)) return decoder->context.error.status;
    return REFUSE(decoder,
        decoder->sequence.active ? "positions are known after FRAME" : "positions are known after the first BLOCK");
}

/* Write positions to an array of a caller, in either precision. */
static bsmdec_status show_in(bsmdec *decoder, double *wide, float *narrow, size_t count) {
    if (decoder == NULL) return BSMDEC_MISUSED;
    bsmdec_status status = find_places(decoder);
    if (status != BSMDEC_OK) return status;
    if (!fits(decoder, wide != NULL ? (void *)wide : narrow, count, 3 * decoder->mesh.numbering.size))
        return BSMDEC_MISUSED;
    int64_t loose = 0;
    for (size_t v = 0; v < count / 3; v++) {
        const double *place = place_of(decoder, (int64_t)v, &loose);
        for (int i = 0; i < 3; i++) {
            if (narrow != NULL) *narrow++ = (float)place[i];
            else *wide++ = place[i];
        }
    }
    return BSMDEC_OK;
}

EXACTLY(bsmdec_status, bsmdec_positions,
    (bsmdec *decoder, double *coordinates, size_t count),
    (decoder, coordinates, count)) {
    return show_in(decoder, coordinates, NULL, count);
}

EXACTLY(bsmdec_status, bsmdec_positions_single,
    (bsmdec *decoder, float *coordinates, size_t count),
    (decoder, coordinates, count)) {
    return show_in(decoder, NULL, coordinates, count);
}

static bsmdec_metadata entry_of(const MetadataEntry *own) {
    return (bsmdec_metadata){(const char *)own->name.data, own->kind, own->whole, own->number, own->bytes.data,
        (size_t)own->bytes.size};
}

bsmdec_status bsmdec_metadata_find(bsmdec *decoder, const char *name, bsmdec_metadata *entry) {
    if (decoder == NULL) return BSMDEC_MISUSED;
    if (name == NULL || entry == NULL) return REFUSE(decoder, "name or entry is NULL");
    const MetadataEntry *found =
        find_name(&decoder->reader.metadata, (Span){(const uint8_t *)name, (int64_t)strlen(name)});
    if (found == NULL) return REFUSE(decoder, "no entry of metadata has this name");
    *entry = entry_of(found);
    return BSMDEC_OK;
}

bsmdec_status bsmdec_metadata_at(bsmdec *decoder, int64_t index, bsmdec_metadata *entry) {
    if (decoder == NULL) return BSMDEC_MISUSED;
    if (entry == NULL) return REFUSE(decoder, "entry is NULL");
    int64_t known = decoder->reader.metadata.count;
    if (index < 0 || index >= known) return REFUSE(decoder, "entry # of metadata, # are known", index, known);
    *entry = entry_of(decoder->reader.metadata.entries[index]);
    return BSMDEC_OK;
}

const Attribute *started_attribute(bsmdec *decoder, int index) {
    if (decoder == NULL) return NULL;
    int count = bsmdec_attribute_count(decoder);
    if (index < 0 || index >= count) return REFUSE(decoder, "attribute #, # are known", index, count), NULL;
    const Attribute *attribute = decoder->mesh.announced ? decoder->mesh.attributes.list[index] : NULL;
    if (attribute == NULL || attribute->values == NULL)
        return REFUSE(decoder, "attribute # is known after its ATTRIBUTE", index), NULL;
    return attribute;
}

/* An attribute that is available; NULL, and the reason is noted, if there is none with this number. */
static const Attribute *attribute_of(bsmdec *decoder, int index) {
    const Attribute *attribute = started_attribute(decoder, index);
    if (attribute != NULL && !attribute->whole)
        return REFUSE(decoder, "attribute # is known after its ATTRIBUTE", index), NULL;
    return attribute;
}

int bsmdec_attribute_count(const bsmdec *decoder) {
    return decoder != NULL && decoder->mesh.has_attributes ? (int)decoder->mesh.header.attributes : 0;
}

bsmdec_attribute shape_of(const bsmdec *decoder, const Attribute *attribute) {
    const Declaration *d = &attribute->declaration;
    Given given = given_shape(attribute, &decoder->mesh.numbering);
    int64_t corners = given.domain == BSMDEC_CORNER ? 3 * decoder->mesh.faces.rows : 0;
    return (bsmdec_attribute){
        d->name, given.domain, d->semantic, d->kind, d->components, given.rows, corners, d->moves};
}

bool find_shape(const bsmdec *decoder, int index, bsmdec_attribute *shape) {
    const Attribute *found = decoder->mesh.announced ? decoder->mesh.attributes.list[index] : NULL;
    if (found == NULL || found->values == NULL || !found->whole) return false;
    *shape = shape_of(decoder, found);
    return true;
}

bsmdec_status bsmdec_attribute_at(bsmdec *decoder, int index, bsmdec_attribute *attribute) {
    const Attribute *found = attribute_of(decoder, index);
    if (found == NULL) return BSMDEC_MISUSED;
    if (attribute == NULL) return REFUSE(decoder, "attribute is NULL");
    *attribute = shape_of(decoder, found);
    return BSMDEC_OK;
}

EXACTLY(bsmdec_status, bsmdec_attribute_values,
    (bsmdec *decoder, int index, void *values, size_t size),
    (decoder, index, values, size)) {
    const Attribute *found = attribute_of(decoder, index);
    bsmdec_attribute shape;
    if (bsmdec_attribute_at(decoder, index, &shape) != BSMDEC_OK) return BSMDEC_MISUSED;
    size_t each = (size_t)shape.components * kind_size(shape.kind);
    if (!fits(decoder, values, size, shape.rows * (int64_t)each)) return BSMDEC_MISUSED;
    Arena own = arena_of(&decoder->context);
    Longs rows;
    bool done = take_longs(&own, shape.rows, &rows) && given_rows(found, &decoder->mesh.numbering, &own, rows);
    for (int64_t i = 0; done && i < shape.rows; i++)
        memcpy((char *)values + (size_t)i * each,
            (const char *)(found->moved != NULL ? found->moved : found->values) + (size_t)rows.data[i] * each, each);
    release_all(&own);
    return done ? BSMDEC_OK : decoder->context.error.status;
}

bsmdec_status bsmdec_attribute_indices(bsmdec *decoder, int index, uint32_t *indices, size_t count) {
    const Attribute *found = started_attribute(decoder, index);
    if (found == NULL) return BSMDEC_MISUSED;
    bsmdec_attribute shape = shape_of(decoder, found);
    if (shape.indices == 0) return REFUSE(decoder, "attribute # has no indices: it is not of corners", index);
    if (!fits(decoder, indices, count, shape.indices)) return BSMDEC_MISUSED;
    for (size_t i = 0; i < count; i++)
        indices[i] = (uint32_t)row_of_corner(found, &decoder->mesh.numbering, (int64_t)i);
    return BSMDEC_OK;
}

const bsmdec_error *bsmdec_last_error(const bsmdec *decoder) {
    return decoder != NULL ? &decoder->context.error : NULL;
}

const bsmdec_error *bsmdec_last_loss(const bsmdec *decoder) { return decoder != NULL ? &decoder->loss : NULL; }

const char *bsmdec_last_misuse(const bsmdec *decoder) {
    return decoder != NULL ? decoder->misuse : "the decoder is NULL";
}

const char *bsmdec_version(void) { return BSMDEC_VERSION; }

const char *bsmdec_status_name(bsmdec_status status) {
    switch (status) {
        case BSMDEC_OK: return "ok";
        case BSMDEC_MISUSED: return "misused";
        case BSMDEC_FORMAT: return "format";
        case BSMDEC_CORRUPT: return "corrupt";
        case BSMDEC_UNSUPPORTED: return "unsupported";
        case BSMDEC_LIMIT: return "limit";
        case BSMDEC_NUMERIC: return "numeric";
        case BSMDEC_NO_MEMORY: return "no memory";
        case BSMDEC_TRUNCATED: return "truncated";
        default: return "unknown";
    }
}

size_t bsmdec_kind_size(int kind) { return is_kind(kind) ? kind_size(kind) : 0; }
