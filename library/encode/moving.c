/* Frames that share their faces, as a sequence (encoder only; specification, S): GOPs of a few frames each, which are
 * predicted from those before. */
#include "library/encode/encoding.h"

#include "bitstream/payloads/payloads.h"
#include "codec/sequence/gops.h"
#include "codec/signal/decoding.h"
#include "codec/signal/signal.h"

#ifdef BSMDEC_WRITES

/* Frames of a GOP, and between key frames; vertices of a block, about; attempts at a step. */
enum { TOGETHER = 8, LONGEST = 256, BLOCK = 320, TRIES = 8 };
/* Steps of the first attempt, in bounds, and of the next one, in those that would have met it; of the first frame, in
 * those of the others, which follow from it. */
static const double FIRST = 1.0, NEARER = 0.9, FIRST_FRAME = 0.3, ROUNDED_UP = 1.0 + 4e-6;
static const double LEAST_STEP = 0x1p-40, MOST_STEP = 0x1p20; /* in headers */

/* The input, and the state of a decoder. */
typedef struct {
    PayloadWriter *writer;
    ConstInts2 faces;
    ConstDoubles2 frames;
    float step;
    Graph graph;
    Blocks blocks;
    Chains chains;
    Assembly assembly;
    Gops gops;
    Payload writing;
    CodedMotion *motion;
} MovingEncoder;

void give_motion(CodedMotion *motion) {
    if (motion->bytes.context != NULL) give_buffer(&motion->bytes);
}

/* Center and diagonal of the first frame, the unit of what is coded. */
static void measure_frame(ConstDoubles2 frames, Header *header) {
    double low[3], high[3], square = 0.0;
    box_of((ConstDoubles2){frames.data, header->vertices, 3}, low, high);
    for (int j = 0; j < 3; j++) {
        header->center[j] = low[j] / 2 + high[j] / 2;
        square += (high[j] - low[j]) * (high[j] - low[j]);
    }
    header->scale = square > 0.0 ? __builtin_sqrt(square) * ROUNDED_UP : 1.0;
}

static bool cut_mesh(MovingEncoder *encoding, Arena *arena) {
    Context *context = &encoding->writer->context;
    Arena *scratch = &encoding->writer->scratch;
    Header *header = &encoding->motion->header;
    Ints2 faces = {(int32_t *)encoding->faces.data, header->faces, 3}; /* only read */
    Ints labels;
    Longs sizes;
    if (!make_graph(faces, header->vertices, arena, scratch, &encoding->graph)
        || !take_ints(arena, header->vertices, &labels) || !zero_longs(scratch, header->blocks, &sizes)
        || !derive_labels(context, &encoding->graph, header->blocks, scratch, labels))
        return false;
    for (int64_t v = 0; v < labels.size; v++)
        header->block_size = largest(header->block_size, ++sizes.data[labels.data[v]]);
    header->coefficients = header->block_size;
    return make_blocks(context, header, &encoding->graph, labels, arena, scratch, &encoding->blocks);
}

/* Let a kernel write the payload of the next section. */
static void write_anew(MovingEncoder *encoding) {
    encoding->writing.size = encoding->writing.count = 0;
    encoding->writer->context.writing = &encoding->writing;
}

/* Append that payload to the numbers at the start of the section. */
static void keep_section(MovingEncoder *encoding) {
    CodedMotion *motion = encoding->motion;
    encoding->writer->context.writing = NULL;
    put_bytes(&motion->bytes, (Span){encoding->writing.data, encoding->writing.size});
    motion->ends.data[motion->ends.size++] = motion->bytes.size;
}

/* Code a block of the first frame, as decoders will see it. */
static bool code_block_at(MovingEncoder *encoding, int64_t index) {
    Arena *scratch = &encoding->writer->scratch;
    Chains *chains = &encoding->chains;
    const Header *header = chains->header;
    int64_t n = size_of_block(&encoding->blocks, index);
    Suspended block;
    Singles2 dictionary;
    Doubles2 coefficients, positions;
    int64_t rows;
    if (!hang_block(chains, index, scratch, &block) || !make_dictionary(chains, &block, n, scratch, &dictionary)
        || !take_doubles2(scratch, n, 3, &coefficients) || !take_doubles2(scratch, n, 3, &positions))
        return false;
    for (int64_t i = 0; i < 3 * n; i++) {
        double place = encoding->frames.data[3 * block.patch.vertices.data[i / 3] + i % 3] - header->center[i % 3];
        positions.data[i] = place / header->scale - block.continued.data[i];
    }
    project(const_singles2(dictionary), const_doubles2(positions), coefficients);
    write_anew(encoding);
    if (!write_levels(chains, const_doubles2(block.continued), const_singles2(dictionary), const_doubles2(coefficients),
            false, scratch, &rows, positions))
        return false;
    put_varint(&encoding->motion->bytes, index);
    put_varint(&encoding->motion->bytes, rows);
    keep_section(encoding);
    DecodedBlock decoded = {index, block.patch.vertices, const_doubles2(positions), const_doubles(block.weights)};
    commit_block(chains, first_columns(dictionary, rows), &decoded);
    add_block(&encoding->assembly, &decoded);
    chains->next++;
    return true;
}

/* Measure a decoded frame, and add it to the checksum. */
static bool measure_error(MovingEncoder *encoding, int64_t t, const double *given) {
    CodedMotion *motion = encoding->motion;
    ConstDoubles2 frame;
    Sums sums;
    if (!show_frame(&encoding->gops, t, &encoding->writer->scratch, 0, &frame)
        || !into_unit(&encoding->writer->context, &motion->header, (Doubles2){(double *)frame.data, frame.rows, 3}))
        return false;
    for (int64_t i = 0; i < 3 * frame.rows; i++) {
        double error = __builtin_fabs(frame.data[i] - given[i]);
        if (!(error <= motion->farthest)) motion->farthest = error;
    }
    make_sums(&sums);
    motion->sum = crc32_of_positions(&sums, frame, motion->sum);
    return true;
}

/* Code some frames from number `first` on, as cosines over time. */
static bool code_gop(MovingEncoder *encoding, int64_t first) {
    Arena *scratch = &encoding->writer->scratch;
    CodedMotion *motion = encoding->motion;
    const Header *header = &motion->header;
    int64_t n = header->vertices, count = least(TOGETHER, header->frames - first), columns = 3 * count;
    int method = first % LONGEST == 0 ? KEY_FRAMES : NEXT_FRAMES;
    const double *frames = encoding->frames.data + 3 * n * first;
    Doubles2 wanted, time;
    uint32_t word;
    memcpy(&word, &encoding->step, sizeof word);
    if (!zero_doubles2(scratch, n, columns, &wanted) || !time_cosines(count, scratch, &time)) return false;
    for (int64_t i = 0; i < columns * n; i++) {
        int64_t t = i / (3 * n), j = i % 3;
        double place = (frames[i] - header->center[j]) / header->scale;
        for (int64_t f = 0; f < count; f++)
            wanted.data[i / 3 % n * columns + 3 * f + j] += time.data[t * count + f] * place;
    }
    GopField field = {.width = 3, .components = columns, .step = encoding->step};
    write_anew(encoding);
    if (!write_gop(&encoding->gops, method, count, field, const_doubles2(wanted), &encoding->writing, scratch))
        return false;
    put_varint(&motion->bytes, first);
    put_varint(&motion->bytes, method);
    put_varint(&motion->bytes, count);
    put_little(&motion->bytes, word, 4);
    if (method == NEXT_FRAMES) put_varint(&motion->bytes, 0);
    keep_section(encoding);
    for (int64_t t = 0; t < count; t++)
        if (!measure_error(encoding, t, frames + 3 * n * t)) return false;
    return true;
}

/* Code all with one step. */
static bool code_with(MovingEncoder *encoding, double step, Arena *arena) {
    Context *context = &encoding->writer->context;
    Arena *scratch = &encoding->writer->scratch;
    CodedMotion *motion = encoding->motion;
    Header *header = &motion->header;
    Doubles2 first;
    encoding->step = (float)(step > MOST_STEP ? MOST_STEP : step);
    header->step = (float)(FIRST_FRAME * encoding->step);
    motion->bytes.size = motion->ends.size = motion->sum = 0;
    motion->farthest = 0.0;
    if (!(header->step >= LEAST_STEP)) return FAIL(context, UNREACHABLE, "the grid is too fine for these frames");
    bool done = begin_chains(&encoding->chains, context, header, &encoding->graph, &encoding->blocks, arena)
        && begin_assembly(&encoding->assembly, header->vertices, header->blocks, arena)
        && begin_chain(&encoding->chains, 0);
    for (int64_t i = 0; done && i < header->blocks; i++) {
        release_all(scratch);
        done = code_block_at(encoding, i);
    }
    done = done && blend_all(&encoding->assembly, header, &encoding->graph, arena, scratch, &first)
        && begin_gops(&encoding->gops, context, header, &encoding->graph, &encoding->blocks, encoding->faces,
            const_doubles2(first), header->vertices, NULL, 0, scratch);
    for (int64_t t = 0; done && t < header->frames; t += TOGETHER) {
        release_all(scratch);
        done = code_gop(encoding, t);
    }
    context->writing = NULL;
    end_gops(&encoding->gops);
    end_chains(&encoding->chains);
    return done;
}

bool code_motion(PayloadWriter *writer, ConstInts2 faces, ConstDoubles2 frames, double bound, CodedMotion *motion) {
    Context *context = &writer->context;
    Arena arena = arena_of(context);
    MovingEncoder encoding = {.writer = writer, .faces = faces, .frames = frames, .motion = motion};
    int64_t n = frames.columns / 3, blocks = largest(1, (n + BLOCK / 2) / BLOCK);
    *motion = (CodedMotion){.header = {.vertices = n, .faces = faces.rows, .blocks = blocks, .frames = frames.rows,
        .gop_frames = TOGETHER, .is_sequence = true, .mesh_of = -1, .paper = {.power = 3, .iterations = 2,
        .key_iterations = 2, .springs = 1, .shift = 0x1p-5}}, .bytes = {.context = context}};
    measure_frame(frames, &motion->header);
    double step = FIRST * bound / motion->header.scale;
    bool done = take_longs(&writer->arena, blocks + (frames.rows + TOGETHER - 1) / TOGETHER, &motion->ends)
        && begin_payloads(context, 1 << 16, &encoding.writing) && cut_mesh(&encoding, &arena);
    Mark mark = mark_of(&arena);
    for (int k = 0; done && k < TRIES; k++) {
        release_to(&arena, mark);
        done = code_with(&encoding, step, &arena);
        if (motion->farthest <= bound) break;
        step *= NEARER * bound / motion->farthest;
    }
    end_payloads(context, &encoding.writing);
    release_all(&arena);
    return done && !failed(context)
        && (motion->farthest <= bound || FAIL(context, UNREACHABLE, "frames cannot be kept as near as is asked"));
}

#endif
