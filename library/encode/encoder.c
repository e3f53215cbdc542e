/* The functions of bsmenc.h. */
#include "library/encode/encoding.h"

#include "library/arithmetic.h"
#include "bitstream/payloads/payloads.h"

#ifdef BSMDEC_WRITES

/* Vertices of the first section of a grid, and of each that follows: large meshes are seen early while they arrive. */
enum { FIRST_CHUNK = 1 << 12, CHUNK = 1 << 13, USUAL_BITS = 14 };
static const double LOST_OF_DIAGONAL = 1e-6, LOST_OF_EDGE = 1e-3; /* by rounding to single precision, at most */
/* What is done, of all, after each step. */
static const double JOINED = 0.05, FACES_CODED = 0.2, ATTRIBUTES_CODED = 0.5, POSITIONS_CODED = 0.7;

const char *bsmenc_version(void) { return BSMENC_VERSION; }

static bool report(Encoder *encoder, double part) {
    if (encoder->options.progress == NULL || encoder->options.progress(encoder->options.host, part) == 0) return true;
    return FAIL(&encoder->writer.context, STOPPED, "stopped");
}

/* ---- Positions ---- */

/* Whether more than half of the faces have a first edge that is shorter. */
static bool are_edges_shorter(const GivenMesh *given, double length) {
    int64_t shorter = 0;
    for (int64_t f = 0; f < given->faces; f++) {
        const double *a = given->positions.data + 3 * (int64_t)given->corners[3 * f];
        const double *b = given->positions.data + 3 * (int64_t)given->corners[3 * f + 1];
        double square = 0.0;
        for (int j = 0; j < 3; j++) square += (a[j] - b[j]) * (a[j] - b[j]);
        shorter += square < length * length;
    }
    return 2 * shorter > given->faces;
}

/* Round coordinates to single precision, unless that moves some visibly: far from the origin, it is coarse. */
static bool make_single(Encoder *encoder) {
    Context *context = &encoder->writer.context;
    ConstDoubles2 wide = encoder->given.positions;
    double low[3], high[3], diagonal = 0.0;
    Doubles2 narrow;
    if (!take_doubles2(&encoder->writer.arena, wide.rows, 3, &narrow)) return false;
    for (int64_t i = 0; i < 3 * wide.rows; i++) {
        double value = wide.data[i];
        if (!(value <= FLT_MAX && value >= -FLT_MAX))
            return FAIL(context, MISUSED,
                "a coordinate is beyond the range of single precision, which lossless keeps; scale the mesh");
        narrow.data[i] = in_single(value);
        double error = __builtin_fabs(narrow.data[i] - value);
        encoder->stream.moved += error > 0.0;
        if (error > encoder->stream.error) encoder->stream.error = error;
        if (i < 3 || value < low[i % 3]) low[i % 3] = value;
        if (i < 3 || value > high[i % 3]) high[i % 3] = value;
    }
    for (int j = 0; j < 3; j++) diagonal += (high[j] - low[j]) * (high[j] - low[j]);
    double error = encoder->stream.error;
    if (error > 0.0 && (error > LOST_OF_DIAGONAL * __builtin_sqrt(diagonal)
        || are_edges_shorter(&encoder->given, error / LOST_OF_EDGE)))
        return FAIL(context, UNREACHABLE,
            "lossless keeps single precision, which moves vertices visibly; cells of a grid are more exact");
    encoder->given.positions = const_doubles2(narrow);
    return true;
}

/* Make a grid of so many cells of positions, of which a decoder will have those in `encoder->positions`. */
static bool round_positions(Encoder *encoder) {
    Context *context = &encoder->writer.context;
    const bsmenc_options *options = &encoder->options;
    Rounded *rounded = &encoder->rounded;
    Doubles2 *positions = &encoder->positions;
    ConstDoubles2 exact = const_doubles2(*positions);
    if (!take_ints2(&encoder->writer.arena, exact.rows, 3, &rounded->places)) return false;
    if (options->positions == BSMENC_LOSSLESS) return round_exactly(context, exact, rounded);
    bool done = options->positions == BSMENC_CELLS
        ? round_to_cells(context, exact, options->cell, options->origin, rounded)
        : round_to_bits(context, exact, options->bits, rounded);
    for (int64_t i = 0; done && i < 3 * exact.rows; i++)
        positions->data[i] = rounded_at(rounded, i / 3, (int)(i % 3));
    return done;
}

/* Code frames with the error of such a grid at most. */
static bool code_frames(Encoder *encoder) {
    const bsmenc_options *options = &encoder->options;
    ConstDoubles2 positions = const_doubles2(encoder->positions);
    double low[3], high[3], extent = box_of(positions, low, high);
    int64_t cells = (INT64_C(1) << options->bits) - 1, frames = encoder->given.frames;
    if (options->keep_order && encoder->joined.loose > 0)
        return FAIL(&encoder->writer.context, MISUSED, "frames keep no vertices in no face: leave them out");
    encoder->rounded.step = options->positions == BSMENC_CELLS ? options->cell
        : (extent > 0.0 ? extent : 1.0) / (double)cells;
    return code_motion(&encoder->writer, const_ints2(encoder->coded.faces),
        (ConstDoubles2){positions.data, frames, 3 * positions.rows / frames}, encoder->rounded.step / 2,
        &encoder->motion);
}

/* Put positions, of all frames, in the order of coding, and code frames, or make a grid. */
static bool prepare_positions(Encoder *encoder) {
    int64_t n = encoder->coded.vertex_order.size, rows = encoder->given.frames * n;
    if (!take_doubles2(&encoder->writer.arena, rows, 3, &encoder->positions)) return false;
    for (int64_t i = 0; i < rows; i++) {
        int64_t from = encoder->joined.first.data[encoder->coded.vertex_order.data[i % n]];
        memcpy(encoder->positions.data + 3 * i,
            encoder->given.positions.data + 3 * (encoder->given.vertices * (i / n) + from), 3 * sizeof(double));
    }
    return encoder->mesh->frames > 0 ? code_frames(encoder) : round_positions(encoder);
}

static bool write_grid(Encoder *encoder) {
    PayloadWriter *writer = &encoder->writer;
    Context *context = &writer->context;
    const CodedMesh *coded = &encoder->coded;
    const Rounded *rounded = &encoder->rounded;
    int64_t n = coded->vertex_order.size;
    int light = rounded->exact ? EXACT_FLOATS : encoder->options.quick ? LIGHT : 0;
    Buffer *payload = &encoder->out.payload;
    CodedField *field;
    if (!TAKE_ZEROS(&writer->arena, 1, field)) return false;
    Source given = {coded->faces.data, rounded->places.data, coded->faces.rows, n, 3};
    bool done = begin_positions(field, NULL, context, given, rounded->largest, light, rounded->origin, rounded->step,
        rounded->exact ? encoder->positions.data : NULL, NULL, 0);
    for (int64_t first = 0, count; done && first < n; first += count) {
        Payload writing;
        count = least(first == 0 ? FIRST_CHUNK : CHUNK, n - first);
        done = begin_payloads(context, room_of_chunk(field, count), &writing)
            && code_chunk(field, first, count, (Span){0}, &writing);
        if (done) {
            put_varint(payload, first);
            put_varint(payload, count);
            if (writing.count > 1) put_varint(payload, writing.ends[0]);
            put_bytes(payload, (Span){writing.data, writing.size});
            put_section(&encoder->out, GRID_FRAME);
        }
        end_payloads(context, &writing);
        double part = (double)(first + count) / (double)n;
        done = done && report(encoder, ATTRIBUTES_CODED + part * (POSITIONS_CODED - ATTRIBUTES_CODED));
    }
    end_field(field);
    return done && !failed(context);
}

/* Write sections of the motion from number `first` on, before number `end`. */
static void write_motion(Encoder *encoder, FrameType type, int64_t first, int64_t end) {
    const CodedMotion *motion = &encoder->motion;
    for (int64_t i = first; i < end; i++) {
        int64_t start = i > 0 ? motion->ends.data[i - 1] : 0;
        put_bytes(&encoder->out.payload, (Span){motion->bytes.data + start, motion->ends.data[i] - start});
        put_section(&encoder->out, type);
    }
}

/* ---- Faces and their order ---- */

/* CONNECTIVITY stays in `writing` until the header is known. */
static bool code_faces_first(Encoder *encoder, Payload *writing) {
    PayloadWriter *writer = &encoder->writer;
    CodedMesh *coded = &encoder->coded;
    int64_t n = encoder->joined.first.size;
    *coded = (CodedMesh){.given = &encoder->given, .joined = &encoder->joined, .keeps = encoder->options.keep_order,
        .repeats = encoder->carried_count > 0 ? AS_CORNERS : WHERE_SMALLER}; /* values follow the order of faces */
    return order_faces(writer, NULL, n, writing, coded)
        && (encoder->carried_count == 0
            || link_mesh(&writer->context, const_ints2(coded->faces), n, &writer->arena, &writer->scratch,
                &coded->corners));
}

/* ---- Metadata ---- */

/* Write entries, bytes or all others, in sections of so many as a map may have, each in the order of its names. */
static void write_metadata(Encoder *encoder, bool bytes) {
    const bsmenc_mesh *mesh = encoder->mesh;
    const bsmdec_metadata *some[MOST_ENTRIES];
    int count = 0;
    for (size_t i = 0; i <= mesh->metadata_count; i++) {
        bool last = i == mesh->metadata_count;
        if (count == MOST_ENTRIES || (last && count > 0)) {
            put_metadata(&encoder->out.payload, some, count);
            put_section(&encoder->out, METADATA_FRAME);
            count = 0;
        }
        if (last || (mesh->metadata[i].type == BSMDEC_BYTES) != bytes) continue;
        int at = count++;
        for (; at > 0 && strcmp(mesh->metadata[i].name, some[at - 1]->name) < 0; at--) some[at] = some[at - 1];
        some[at] = mesh->metadata + i;
    }
}

/* ---- Attributes ---- */

/* The values of an attribute in chunks, predicted from positions or not, whichever takes fewer bytes. */
typedef struct {
    Buffer bytes;
    Longs ends;
} Chunks;

static bool code_attribute(Encoder *encoder, int index, Chunks *chunks) {
    PayloadWriter *writer = &encoder->writer;
    Carried *carried = &encoder->carried[index];
    Declaration *d = &carried->quantized.declaration;
    Chunks leaning = {.bytes = {.context = &writer->context}};
    chunks->bytes = leaning.bytes;
    int64_t count = (d->rows + VALUES_CHUNK - 1) / VALUES_CHUNK;
    if (d->coding == RECOMPUTED) return true;
    if (encoder->coded.swift > 0
        && !turn_carried(writer, &encoder->coded, encoder->rounded.places.data, index, encoder->carried))
        return false;
    if (!take_longs(&writer->arena, count, &chunks->ends) || !take_longs(&writer->arena, count, &leaning.ends)
        || !code_carried(writer, &encoder->coded, carried, NULL, &chunks->bytes, chunks->ends))
        return false;
    bool done = true;
    if (can_lean(d) && encoder->mesh->frames == 0) {
        done = code_carried(writer, &encoder->coded, carried, encoder->rounded.places.data, &leaning.bytes,
            leaning.ends);
        if (done && leaning.bytes.size < chunks->bytes.size) {
            Chunks plain = *chunks;
            *chunks = leaning;
            leaning = plain;
            d->leans = true;
        }
        give_buffer(&leaning.bytes);
    }
    return done;
}

static void write_values(Encoder *encoder, int index, const Chunks *chunks) {
    int64_t rows = encoder->carried[index].quantized.declaration.rows;
    Buffer *payload = &encoder->out.payload;
    for (int64_t first = 0, chunk = 0; first < rows; first += VALUES_CHUNK, chunk++) {
        int64_t start = chunk > 0 ? chunks->ends.data[chunk - 1] : 0;
        put_varint(payload, index);
        put_varint(payload, first);
        put_varint(payload, least(VALUES_CHUNK, rows - first));
        put_bytes(payload, (Span){chunks->bytes.data + start, chunks->ends.data[chunk] - start});
        put_section(&encoder->out, VALUES_FRAME);
    }
}

/* ---- All of it ---- */

static bool write_body(Encoder *encoder, const Payload *connectivity, Chunks *chunks) {
    StreamWriter *out = &encoder->out;
    const Rounded *rounded = &encoder->rounded;
    Header header = {.vertices = encoder->coded.vertex_order.size, .faces = encoder->coded.faces.rows,
        .scale = rounded->step,
        .light = rounded->exact ? EXACT_FLOATS : encoder->options.quick ? LIGHT : 0};
    memcpy(header.center, rounded->origin, sizeof header.center);
    memcpy(header.grid, rounded->largest, sizeof header.grid);
    bool moves = encoder->mesh->frames > 0;
    if (moves) header = encoder->motion.header;
    header.attributes = encoder->carried_count;
    encoder->coded.swift = moves ? 0 : encoder->options.quick ? 1 : 2;
    header.swift = header.attributes > 0 ? encoder->coded.swift : 0;
    header.repeats = encoder->coded.repeats;
    for (int k = 0; k < encoder->carried_count; k++) {
        double part = (double)(k + 1) / encoder->carried_count;
        if (!code_attribute(encoder, k, &chunks[k])
            || !report(encoder, FACES_CODED + part * (ATTRIBUTES_CODED - FACES_CODED)))
            return false;
    }
    start_stream(out, &encoder->writer.context, header.swift + header.repeats > 0 ? MINOR_OF_SWIFT : 0);
    const Record record = header_record(&header);
    put_record(&out->payload, HEADER_FIELDS, &record);
    put_section(out, HEADER_FRAME);
    write_metadata(encoder, false);
    put_bytes(&out->payload, (Span){connectivity->data, connectivity->size});
    put_section(out, CONNECTIVITY_FRAME);
    if (encoder->options.keep_order) {
        put_order(&out->payload, &encoder->coded, &encoder->writer.scratch);
        put_section(out, ORDER_FRAME);
    }
    for (int k = 0; k < encoder->carried_count; k++)
        if (!declare_carried(&encoder->writer, &encoder->coded, k, encoder->carried, out)) return false;
    if (!moves && !write_grid(encoder)) return false;
    write_motion(encoder, BLOCK_FRAME, 0, header.blocks);
    for (int k = 0; k < encoder->carried_count; k++) write_values(encoder, k, &chunks[k]);
    write_motion(encoder, GOP_FRAME, header.blocks, encoder->motion.ends.size);
    write_metadata(encoder, true);
    ConstDoubles2 positions = const_doubles2(encoder->positions);
    end_stream(out, moves ? encoder->motion.sum : crc32_of_positions(&out->sums, positions, 0));
    return !failed(&encoder->writer.context);
}

/* Tell the user which of his vertices and faces are the decoder's. */
static bool tell_orders(Encoder *encoder) {
    const JoinedMesh *joined = &encoder->joined;
    const CodedMesh *coded = &encoder->coded;
    bsmenc_stream *stream = &encoder->stream;
    bool keeps = encoder->options.keep_order, split = keeps && (joined->merged > 0 || joined->loose > 0);
    Ints vertices, faces;
    stream->vertices = split ? encoder->given.vertices : coded->vertex_order.size;
    stream->faces = coded->faces.rows;
    if (!take_ints(&encoder->writer.arena, stream->vertices, &vertices)
        || !take_ints(&encoder->writer.arena, stream->faces, &faces))
        return false;
    for (int64_t v = 0; v < stream->vertices; v++)
        vertices.data[v] = split ? (int32_t)v : joined->first.data[keeps ? v : coded->vertex_order.data[v]];
    for (int64_t f = 0; f < stream->faces; f++)
        faces.data[f] = joined->kept.data[keeps ? f : coded->face_order.data[f]];
    stream->vertex_order = vertices.data;
    stream->face_order = faces.data;
    stream->merged = keeps ? 0 : joined->merged;
    stream->loose = keeps ? 0 : joined->loose;
    stream->collapsed = joined->collapsed;
    return true;
}

static bool encode(Encoder *encoder) {
    PayloadWriter *writer = &encoder->writer;
    Context *context = &writer->context;
    bool lossless = encoder->options.positions == BSMENC_LOSSLESS;
    Payload connectivity = {0};
    Chunks *chunks;
    if (!check_mesh(encoder) || (lossless && !make_single(encoder))
        || !join_mesh(&encoder->given, lossless, encoder->options.keep_order, writer, &encoder->joined)
        || !report(encoder, JOINED) || !TAKE_ZEROS(&writer->arena, encoder->carried_count, chunks))
        return false;
    bool done = begin_payloads(context, 1 << 16, &connectivity) && code_faces_first(encoder, &connectivity)
        && report(encoder, FACES_CODED) && prepare_positions(encoder);
    for (int k = 0; done && k < encoder->carried_count; k++)
        done = carry_attribute(writer, &encoder->coded, &encoder->attributes[k], k, encoder->carried);
    done = done && write_body(encoder, &connectivity, chunks);
    end_payloads(context, &connectivity);
    for (int k = 0; k < encoder->carried_count; k++)
        if (chunks[k].bytes.context != NULL) give_buffer(&chunks[k].bytes);
    return done && tell_orders(encoder) && prove_stream(encoder) && report(encoder, 1.0);
}

/* The outcomes of all attributes, also of those that are left out. */
static bool tell_outcomes(Encoder *encoder) {
    int64_t count = (int64_t)encoder->mesh->attribute_count;
    bsmenc_outcome *outcomes;
    if (!TAKE_ZEROS(&encoder->writer.arena, count, outcomes)) return false;
    for (int64_t i = 0, next = 0; i < count; i++) {
        outcomes[i].index = -1;
        if (encoder->mesh->attributes[i].quality == BSMENC_OMIT) continue;
        outcomes[i] = encoder->carried[next].quantized.outcome;
        outcomes[i].recomputed = encoder->carried[next].quantized.declaration.coding == RECOMPUTED;
        outcomes[i].index = (int)next++;
    }
    encoder->stream.outcomes = outcomes;
    return true;
}

EXACTLY(bsmenc_status, bsmenc_encode,
    (const bsmenc_mesh *mesh, const bsmenc_options *options, bsmenc_stream **stream), (mesh, options, stream)) {
    bsmdec_allocator host = library_allocator();
    bsmenc_options known = BSMENC_OPTIONS;
    bool sized = options == NULL || options->size == sizeof known;
    if (sized && options != NULL) known = *options;
    if (known.bits == 0) known.bits = USUAL_BITS;
    bool allocates = known.allocator == NULL
        || (known.allocator->size >= sizeof host && known.allocator->allocate != NULL
            && known.allocator->release != NULL);
    if (allocates && known.allocator != NULL) host = *known.allocator;
    if (stream == NULL) return BSMENC_MISUSED;
    Encoder *encoder = host.allocate(host.host, sizeof *encoder);
    *stream = NULL;
    if (encoder == NULL) return BSMENC_NO_MEMORY;
    memset(encoder, 0, sizeof *encoder);
    open_writer(&encoder->writer, host);
    Context *context = &encoder->writer.context;
    encoder->host = host;
    encoder->mesh = mesh;
    encoder->options = known;
    encoder->out.bytes.context = encoder->out.payload.context = context;
    if (!sized) FAIL(context, MISUSED, "options.size is not sizeof(bsmenc_options)");
    if (!allocates) FAIL(context, MISUSED, "allocator.size is not sizeof(bsmdec_allocator), or a function is NULL");
    if (mesh == NULL || mesh->size != sizeof *mesh) FAIL(context, MISUSED, "mesh.size is not sizeof(bsmenc_mesh)");
    bool done = !failed(context) && encode(encoder) && tell_outcomes(encoder);
    if (!done) encoder->stream = (bsmenc_stream){0};
    else encoder->stream.bytes = encoder->out.bytes.data, encoder->stream.size = (size_t)encoder->out.bytes.size;
    encoder->stream.status = (bsmenc_status)context->error.status;
    encoder->stream.message = context->error.message;
    release_all(&encoder->writer.scratch);
    *stream = &encoder->stream;
    return encoder->stream.status;
}

void bsmenc_release(bsmenc_stream *stream) {
    Encoder *encoder = (Encoder *)stream;
    if (encoder == NULL) return;
    bsmdec_allocator host = encoder->host;
    give_stream(&encoder->out);
    give_motion(&encoder->motion);
    close_writer(&encoder->writer);
    host.release(host.host, encoder, sizeof *encoder);
}

#endif
