/* What is given to the encoder, and whether its streams keep what they promise. */
#include "library/encode/encoding.h"

#ifdef BSMDEC_WRITES

enum { MOST_FACES = (1 << 30) / 3, MOST_VERTICES = 1 << 30, MOST_FRAMES = 1 << 28, MOST_GRID_BITS = 20,
    MOST_VALUE_BITS = 32, MOST_LABEL = 1 << 24, MOST_LABELS = 1 << 16, NAME_WORDS = (MOST_NAME + 1) / 8 };
static const double MOST_COORDINATE = 1e290, LEAST_EXTENT = 1e-290;

/* ---- Before ---- */

static bool check_shape(Encoder *encoder) {
    Context *context = &encoder->writer.context;
    const bsmenc_mesh *mesh = encoder->mesh;
    if (mesh->vertices < 1 || mesh->vertices >= MOST_VERTICES || mesh->faces < 1 || mesh->faces > MOST_FACES)
        return FAIL(context, MISUSED, "a mesh cannot have # vertices and # faces", mesh->vertices, mesh->faces);
    if ((mesh->positions == NULL && mesh->positions_single == NULL) || mesh->corners == NULL)
        return FAIL(context, MISUSED, "the mesh has no positions or no corners");
    for (int64_t i = 0; i < 3 * mesh->faces; i++)
        if (mesh->corners[i] >= (uint64_t)mesh->vertices)
            return FAIL(context, MISUSED, "corner # is vertex # of #", i, mesh->corners[i], mesh->vertices);
    int64_t frames = largest(mesh->frames, 1);
    if (mesh->frames < 0 || frames > MOST_FRAMES / mesh->vertices)
        return FAIL(context, MISUSED, "a sequence cannot have # frames", mesh->frames);
    int64_t rows = frames * mesh->vertices;
    Doubles2 positions = {(double *)mesh->positions, rows, 3}; /* only read */
    if (mesh->positions == NULL) {
        if (!take_doubles2(&encoder->writer.arena, rows, 3, &positions)) return false;
        for (int64_t i = 0; i < 3 * rows; i++) positions.data[i] = mesh->positions_single[i];
    }
    for (int64_t i = 0; i < 3 * rows; i++)
        if (!is_finite(positions.data[i]))
            return FAIL(context, MISUSED, "a coordinate of vertex # is not finite", i / 3 % mesh->vertices);
    double low[3], high[3], extent = box_of(const_doubles2(positions), low, high);
    if (reach_of(low, high, 3) > MOST_COORDINATE)
        return FAIL(context, MISUSED, "the mesh is too far from the origin: scale it");
    if (extent > 0.0 && extent < LEAST_EXTENT) return FAIL(context, MISUSED, "the mesh is too small: scale it");
    encoder->given = (GivenMesh){mesh->vertices, mesh->faces, frames, const_doubles2(positions), mesh->corners};
    if (mesh->frames > 0 && encoder->options.positions == BSMENC_LOSSLESS)
        return FAIL(context, MISUSED, "frames of a sequence are not kept to the bit: take bits, or cells");
    return true;
}

static bool check_options(Context *context, const bsmenc_options *o) {
    if (o->positions < BSMENC_GRID || o->positions > BSMENC_LOSSLESS || o->bits < 0 || o->bits > MOST_GRID_BITS)
        return FAIL(context, MISUSED, "positions is unknown, or a grid has more than # bits", MOST_GRID_BITS);
    if (o->quick && o->positions == BSMENC_LOSSLESS)
        return FAIL(context, MISUSED, "quick and lossless exclude each other");
    if (o->positions != BSMENC_CELLS) return true;
    bool fits = o->cell >= LEAST_EXTENT && o->cell <= MOST_COORDINATE;
    for (int j = 0; j < 3; j++) fits = fits && o->origin[j] >= -MOST_COORDINATE && o->origin[j] <= MOST_COORDINATE;
    return fits || FAIL(context, MISUSED, "the cell of a grid, or its origin, is not from 1e-290 to 1e290");
}

static Span text_of(const char *text) { return (Span){(const uint8_t *)text, (int64_t)strlen(text)}; }

static bool check_metadata(Encoder *encoder) {
    Context *context = &encoder->writer.context;
    Arena *scratch = &encoder->writer.scratch;
    const bsmenc_mesh *mesh = encoder->mesh;
    int64_t count = (int64_t)mesh->metadata_count;
    Longs names;
    Ints first;
    if (mesh->metadata_count >= MOST_VERTICES || (count > 0 && mesh->metadata == NULL))
        return FAIL(context, MISUSED, "mesh.metadata is NULL or too long");
    if (!zero_longs(scratch, NAME_WORDS * count, &names) || !take_ints(scratch, count, &first)) return false;
    for (int64_t i = 0; i < count; i++) {
        const bsmdec_metadata *entry = mesh->metadata + i;
        bool text = entry->type == BSMDEC_TEXT, sized = text || entry->type == BSMDEC_BYTES;
        if (entry->name == NULL || strlen(entry->name) > MOST_NAME || !is_text(text_of(entry->name))
            || entry->type < BSMDEC_WHOLE || entry->type > BSMDEC_BYTES || (sized && entry->size > UINT32_MAX)
            || (sized && entry->size > 0 && entry->bytes == NULL))
            return FAIL(context, MISUSED, "metadata entry # has no short name, no value, or no type", i);
        if (text && !is_text((Span){entry->bytes, (int64_t)entry->size}))
            return FAIL(context, MISUSED, "metadata '$' is not UTF-8", .name = entry->name);
        if (entry->type == BSMDEC_NUMBER && !is_finite(entry->number))
            return FAIL(context, MISUSED, "metadata '$' is not finite", .name = entry->name);
        memcpy(names.data + NAME_WORDS * i, entry->name, strlen(entry->name));
    }
    int64_t different = number_rows(names.data, count, NAME_WORDS, scratch, first), twice = 0;
    if (different < 0 || different == count) return different == count;
    while (first.data[twice] == twice) twice++;
    return FAIL(context, MISUSED, "two metadata entries have the name '$'", .name = mesh->metadata[twice].name);
}

/* Whether floats are labels or ids: whole numbers, and few of them. */
static bool are_labels(Encoder *encoder, const bsmenc_attribute *a) {
    Arena *scratch = &encoder->writer.scratch;
    Longs numbers;
    Ints found;
    int64_t count = a->rows * a->components;
    for (int64_t i = 0; i < count; i++) {
        double value = load_number(a->values, i, a->kind);
        if (!(value <= MOST_LABEL && value >= -MOST_LABEL && value == (double)(int64_t)value)) return false;
    }
    Mark mark = mark_of(scratch);
    bool few = take_longs(scratch, count, &numbers) && take_ints(scratch, count, &found);
    for (int64_t i = 0; few && i < count; i++) numbers.data[i] = (int64_t)load_number(a->values, i, a->kind);
    if (few) few = number_rows(numbers.data, count, 1, scratch, found) <= MOST_LABELS;
    release_to(scratch, mark);
    return few;
}

/* The default quality. */
static void choose_quality(Encoder *encoder, bsmenc_attribute *a) {
    static const int BITS[] = {20, 16, 12, 14};
    if (a->quality != BSMENC_DEFAULT) return;
    bool rounds = a->kind >= BSMDEC_FLOAT32 && encoder->options.positions != BSMENC_LOSSLESS
        && !(a->semantic == BSMDEC_GENERIC && are_labels(encoder, a));
    a->quality = rounds ? BSMENC_BITS : BSMENC_EXACT;
    a->amount = rounds ? BITS[a->semantic] : 0.0;
}

static bool check_attribute(Encoder *encoder, const bsmenc_attribute *a) {
    Context *context = &encoder->writer.context;
    const bsmenc_mesh *mesh = encoder->mesh;
    if (a->name == NULL || *a->name == 0 || strlen(a->name) > MOST_NAME || !is_text(text_of(a->name)))
        return FAIL(context, MISUSED, "the name of an attribute must be UTF-8 of 1 to # bytes", MOST_NAME);
    if (a->domain < BSMDEC_VERTEX || a->domain > BSMDEC_FACE || a->semantic < BSMDEC_GENERIC
        || a->semantic > BSMDEC_TEXCOORD || !is_kind(a->kind) || a->components < 1 || a->components > MOST_COMPONENTS)
        return FAIL(context, MISUSED, "its domain, semantic, kind or number of components is unknown");
    int64_t rows = a->domain == BSMDEC_VERTEX ? mesh->vertices : a->domain == BSMDEC_FACE ? mesh->faces
        : a->indices == NULL ? 3 * mesh->faces : a->rows;
    if (a->rows != rows || a->rows < 1 || a->rows >= MOST_VERTICES || a->values == NULL
        || (a->indices != NULL && a->domain != BSMDEC_CORNER))
        return FAIL(context, MISUSED, "it has # rows where # belong, no values, or indices that are not of corners",
            a->rows, rows);
    for (int64_t i = 0; a->indices != NULL && i < 3 * mesh->faces; i++)
        if (a->indices[i] >= (uint64_t)a->rows)
            return FAIL(context, MISUSED, "corner # has row # of #", i, a->indices[i], a->rows);
    for (int64_t i = 0; a->kind >= BSMDEC_FLOAT32 && i < a->rows * a->components; i++)
        if (!is_finite(load_number(a->values, i, a->kind)))
            return FAIL(context, MISUSED, "a value of row # is not finite", i / a->components);
    if (a->quality == BSMENC_RECOMPUTE && a->domain == BSMDEC_FACE)
        return FAIL(context, MISUSED, "normals of faces cannot be recomputed");
    bool bits = a->quality == BSMENC_BITS, bound = a->quality >= BSMENC_BOUND && a->quality <= BSMENC_ANGLE;
    if (a->quality < BSMENC_DEFAULT || a->quality > BSMENC_OMIT
        || (bits && !(a->amount >= 1 && a->amount <= MOST_VALUE_BITS && a->amount == (double)(int)a->amount))
        || (bound && !(a->amount > 0.0 && is_finite(a->amount))))
        return FAIL(context, MISUSED, "its quality is unknown, or the amount is out of its range");
    return true;
}

static bool check_attributes(Encoder *encoder) {
    Context *context = &encoder->writer.context;
    const bsmenc_mesh *mesh = encoder->mesh;
    int64_t count = (int64_t)mesh->attribute_count;
    if (mesh->attribute_count >= MOST_ATTRIBUTES || (count > 0 && mesh->attributes == NULL))
        return FAIL(context, MISUSED, "mesh.attributes is NULL, or they are more than #", MOST_ATTRIBUTES - 1);
    if (!TAKE(&encoder->writer.arena, count, encoder->attributes)
        || !TAKE_ZEROS(&encoder->writer.arena, count, encoder->carried))
        return false;
    for (int64_t i = 0; i < count; i++) {
        bsmenc_attribute *kept = encoder->attributes + encoder->carried_count;
        *kept = mesh->attributes[i];
        if (!check_attribute(encoder, kept)) return name_attribute(context, kept->name != NULL ? kept->name : "");
        for (int64_t k = 0; k < i; k++)
            if (strcmp(mesh->attributes[k].name, kept->name) == 0)
                return FAIL(context, MISUSED, "two attributes have the name '$'", .name = kept->name);
        if (kept->quality == BSMENC_OMIT) continue;
        choose_quality(encoder, kept);
        encoder->carried_count++;
    }
    return !failed(context);
}

bool check_mesh(Encoder *encoder) {
    return check_options(&encoder->writer.context, &encoder->options) && check_shape(encoder)
        && check_metadata(encoder) && check_attributes(encoder);
}

/* ---- After ---- */

/* A decoder that has decoded the stream, and what it gives; `at`: the vertex of each corner of a given face that is
 * kept, in the order of the given faces. */
typedef struct {
    Encoder *encoder;
    bsmdec *decoder;
    int64_t vertices, faces;
    Doubles2 positions;
    Words corners;
    Arena arena;
} Proof;

/* Fail, because the decoder has no memory, or because it gives something else. */
static bool differs(Proof *proof, const char *what) {
    if (bsmdec_last_error(proof->decoder)->status == BSMDEC_NO_MEMORY)
        return FAIL(&proof->encoder->writer.context, NO_MEMORY, "out of memory");
    return FAIL(&proof->encoder->writer.context, FAULT, "$ differ after decoding; please report it, with the mesh",
        .name = what);
}

/* The given corner that corner k of decoded face f is. */
static int64_t given_corner(const Proof *proof, int64_t f, int64_t k) {
    const Encoder *encoder = proof->encoder;
    int turn = encoder->options.keep_order ? 0 : encoder->coded.turns.data[f];
    return 3 * (int64_t)encoder->stream.face_order[f] + (turn + k) % 3;
}

/* Faces join the vertices that they joined, and each vertex is where it was, but for rounding. */
static bool prove_shape(Proof *proof, int64_t frame) {
    Encoder *encoder = proof->encoder;
    const bsmenc_stream *stream = &encoder->stream;
    const Rounded *rounded = &encoder->rounded;
    const double *given = encoder->given.positions.data + 3 * encoder->given.vertices * frame;
    /* A place is within half a step. Coordinates in single precision add at most a 64th, and computing with them four
     * roundings of the largest place; doubles add their last digit. */
    double cells = largest(largest(rounded->largest[0], rounded->largest[1]), rounded->largest[2]) * 0x1p-22;
    double step = rounded->exact ? 0.0 : rounded->step * (0.5 + (encoder->mesh->frames > 0 ? 0.0 : 1.0 / 64.0 + cells));
    double farthest = encoder->stream.error;
    if (proof->vertices != stream->vertices || proof->faces != stream->faces) return differs(proof, "sizes");
    for (int64_t i = 0; i < 3 * proof->faces; i++) {
        uint32_t own = encoder->given.corners[given_corner(proof, i / 3, i % 3)], decoded = proof->corners.data[i];
        uint32_t wanted = (uint32_t)stream->vertex_order[decoded];
        if (encoder->joined.index.data[own] != encoder->joined.index.data[wanted]
            || (encoder->options.keep_order && own != wanted))
            return differs(proof, "faces");
        for (int j = 0; j < 3; j++) {
            double error = proof->positions.data[3 * (int64_t)decoded + j] - given[3 * (int64_t)own + j];
            if (error < 0.0) error = -error;
            double last = __builtin_fabs(given[3 * (int64_t)own + j]) + __builtin_fabs(rounded->origin[j]);
            if (!(error <= step + (rounded->exact ? 0.0 : 0x1p-50 * last))) return differs(proof, "positions");
            if (error > farthest) farthest = error;
        }
    }
    if (!rounded->exact) encoder->stream.error = farthest;
    for (int64_t v = 0; encoder->options.keep_order && v < encoder->given.vertices; v++)
        if (encoder->joined.index.data[v] < 0
            && memcmp(proof->positions.data + 3 * v, given + 3 * v, 3 * sizeof(double)) != 0)
            return differs(proof, "vertices in no face");
    return true;
}

/* Whether a decoded value is as near to a given one as the outcome says. */
static bool is_near(const bsmenc_attribute *a, const Quantized *q, int64_t row, const void *values, int64_t decoded) {
    double own[MOST_COMPONENTS], back[MOST_COMPONENTS];
    for (int j = 0; j < a->components; j++) {
        own[j] = load_number(a->values, row * a->components + j, a->kind);
        back[j] = load_number(values, decoded * a->components + j, a->kind);
        if (q->outcome.bits > 0) continue;
        double error = __builtin_fabs(own[j] - back[j]), slack = 1e-12 * (__builtin_fabs(own[j]) + q->outcome.error);
        if (a->kind < BSMDEC_FLOAT32) slack = 0.0;
        if (!(error <= q->outcome.error + (q->outcome.error > 0.0 ? slack : 0.0))) return false;
    }
    if (q->outcome.bits == 0) return true;
    double unit[3];
    if (q->declaration.coding == TANGENTS && own[3] != back[3]) return false;
    if (direction_of(own, unit) == 0.0) return back[0] == 0.0 && back[1] == 0.0 && back[2] == 0.0;
    return degrees_between(back, unit) <= q->outcome.error + 1e-6;
}

static bool prove_attribute(Proof *proof, int index) {
    Encoder *encoder = proof->encoder;
    const bsmenc_attribute *a = &encoder->attributes[index];
    const Quantized *q = &encoder->carried[index].quantized;
    bsmdec_attribute shape;
    Words rows = {0};
    void *values;
    if (bsmdec_attribute_at(proof->decoder, index, &shape) != BSMDEC_OK || strcmp(shape.name, a->name) != 0
        || shape.semantic != a->semantic || shape.kind != a->kind || shape.components != a->components)
        return differs(proof, "names or kinds");
    size_t bytes = bsmdec_kind_size(shape.kind) * (size_t)shape.components;
    if (!is_there(values = find_memory(&proof->arena, shape.rows, bytes))
        || !take_words(&proof->arena, shape.indices, &rows))
        return false;
    if (bsmdec_attribute_values(proof->decoder, index, values, bytes * (size_t)shape.rows) != BSMDEC_OK
        || (shape.indices > 0
            && bsmdec_attribute_indices(proof->decoder, index, rows.data, (size_t)shape.indices) != BSMDEC_OK))
        return differs(proof, "sizes");
    if (q->declaration.coding == RECOMPUTED) return true;
    for (int64_t f = 0; f < proof->faces; f++)
        for (int64_t k = 0; k < (a->domain == BSMDEC_FACE ? 1 : 3); k++) {
            int64_t corner = given_corner(proof, f, k), row = corner;
            int64_t decoded = shape.indices > 0 ? rows.data[3 * f + k] : proof->corners.data[3 * f + k];
            if (a->domain == BSMDEC_VERTEX) row = encoder->given.corners[corner];
            if (a->domain == BSMDEC_CORNER && a->indices != NULL) row = a->indices[corner];
            if (a->domain == BSMDEC_FACE) row = encoder->stream.face_order[f], decoded = f;
            if (!is_near(a, q, row, values, decoded)) return differs(proof, "values");
        }
    for (int64_t v = 0; encoder->options.keep_order && a->domain == BSMDEC_VERTEX && shape.indices == 0
        && v < encoder->given.vertices; v++)
        if (encoder->joined.index.data[v] < 0 && !is_near(a, q, v, values, v)) return differs(proof, "values");
    return true;
}

static bool prove_metadata(Proof *proof) {
    const bsmenc_mesh *mesh = proof->encoder->mesh;
    for (size_t i = 0; i < mesh->metadata_count; i++) {
        const bsmdec_metadata *own = mesh->metadata + i;
        bsmdec_metadata found;
        bool same = bsmdec_metadata_find(proof->decoder, own->name, &found) == BSMDEC_OK && found.type == own->type;
        if (same && own->type == BSMDEC_WHOLE) same = found.whole == own->whole;
        if (same && own->type == BSMDEC_NUMBER) same = found.number == own->number;
        if (same && own->type >= BSMDEC_TEXT)
            same = found.size == own->size && (own->size == 0 || memcmp(found.bytes, own->bytes, own->size) == 0);
        if (!same) return differs(proof, "metadata");
    }
    return true;
}

static bool prove_frame(Proof *proof, const bsmdec_event *event, int64_t frame) {
    proof->vertices = event->vertices;
    proof->faces = event->faces;
    release_all(&proof->arena);
    if (!take_doubles2(&proof->arena, proof->vertices, 3, &proof->positions)
        || !take_words(&proof->arena, 3 * proof->faces, &proof->corners))
        return false;
    if (bsmdec_faces(proof->decoder, proof->corners.data, (size_t)proof->corners.size) != BSMDEC_OK
        || bsmdec_positions(proof->decoder, proof->positions.data, (size_t)(3 * proof->vertices)) != BSMDEC_OK)
        return differs(proof, "sizes");
    return prove_shape(proof, frame);
}

/* The decoder's limits and memory are also the encoder's. */
static bool decode_all(Proof *proof) {
    Encoder *encoder = proof->encoder;
    Context *context = &encoder->writer.context;
    bsmdec_options options = BSMDEC_OPTIONS;
    bsmdec_event event = {BSMDEC_NEED_DATA, 0, 0, 0, 0, 0};
    options.limits = encoder->options.limits;
    options.allocator = &encoder->host;
    proof->decoder = bsmdec_open(&options);
    if (proof->decoder == NULL) return FAIL(context, NO_MEMORY, "out of memory");
    bsmdec_push(proof->decoder, encoder->out.bytes.data, (size_t)encoder->out.bytes.size);
    bsmdec_finish(proof->decoder);
    int64_t frames = 0;
    do {
        bsmdec_next(proof->decoder, &event);
        bool shown = event.type == (encoder->mesh->frames > 0 ? BSMDEC_FRAME : BSMDEC_END);
        if (shown && frames < encoder->given.frames && !prove_frame(proof, &event, frames++)) return false;
    } while (event.type != BSMDEC_END && event.type != BSMDEC_ERROR);
    const bsmdec_error *error = bsmdec_last_error(proof->decoder);
    if (error->status != BSMDEC_OK) {
        bool usual = error->status == BSMDEC_LIMIT || error->status == BSMDEC_NO_MEMORY
            || error->status == BSMDEC_MISUSED;
        context->error = *error;
        if (!usual) context->error.status = BSMDEC_FAULT;
        return false;
    }
    return frames == encoder->given.frames || differs(proof, "numbers of frames");
}

bool prove_stream(Encoder *encoder) {
    Proof proof = {.encoder = encoder, .arena = arena_of(&encoder->writer.context)};
    bool done = decode_all(&proof) && prove_metadata(&proof);
    if (done && bsmdec_attribute_count(proof.decoder) != encoder->carried_count)
        done = differs(&proof, "numbers of attributes");
    for (int i = 0; done && i < encoder->carried_count; i++)
        done = prove_attribute(&proof, i) || name_attribute(&encoder->writer.context, encoder->attributes[i].name);
    release_all(&proof.arena);
    bsmdec_close(proof.decoder);
    return done;
}

#endif
