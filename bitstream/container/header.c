/* The header: fields, legal values, contradictions (specification, F 4, F 10). */
#include "bitstream/container/container.h"

enum {
    VERTICES = 1, FACES, BLOCKS, BLOCK_SIZE, COEFFICIENTS, KEY_INTERVAL, STEP, CENTER, SCALE, SMOOTHING, REFINEMENT,
    ATTRIBUTES, GRID, LATTICE, CORNER, LIGHT_KEY, SEQUENCE, RUN, PAPER, ONORM = 21,
    CONGRUENCE, BRIEF, TURN, BRIEF_TURNED, BRIEF_METADATA, BASE, SWIFT, REPEATS,
};

static const Field FIELDS[] = {
    {.key = VERTICES, .type = INT_FIELD, .low = 1, .high = INT32_MAX, .required = true},
    {.key = FACES, .type = INT_FIELD, .low = 1, .high = INT32_MAX, .required = true},
    {.key = BLOCKS, .type = INT_FIELD, .high = INT32_MAX},
    {.key = BLOCK_SIZE, .type = INT_FIELD, .high = INT32_MAX},
    {.key = COEFFICIENTS, .type = INT_FIELD, .high = INT32_MAX},
    {.key = KEY_INTERVAL, .type = INT_FIELD, .high = INT32_MAX},
    {.key = STEP, .type = FLOAT_FIELD, .low = 0x1p-40, .high = 0x1p20, .fallback = 0x1p-8},
    {.key = CENTER, .type = FLOATS_FIELD, .low = -1e300, .high = 1e300, .least = 3, .most = 3},
    {.key = SCALE, .type = FLOAT_FIELD, .low = 1e-300, .high = 1e300, .fallback = 1},
    {.key = SMOOTHING, .type = FLOAT_FIELD, .high = 1e6},
    {.key = REFINEMENT, .type = FLOATS_FIELD, .high = 64, .most = 2},
    {.key = ATTRIBUTES, .type = INT_FIELD, .high = 255},
    {.key = GRID, .type = INTS_FIELD, .high = 0xfffff, .most = 3},
    {.key = LATTICE, .type = INTS_FIELD, .low = 1, .high = INT32_MAX, .most = 2},
    {.key = CORNER, .type = INTS_FIELD, .low = INT32_MIN, .high = INT32_MAX, .most = 3},
    {.key = LIGHT_KEY, .type = METHOD_FIELD, .high = 2},
    {.key = SEQUENCE, .type = INTS_FIELD, .high = INT32_MAX, .most = 2},
    {.key = RUN, .type = INTS_FIELD, .high = INT32_MAX, .most = 2},
    {.key = PAPER, .type = FLOATS_FIELD, .high = 0x1p30, .most = 8},
    {.key = ONORM, .type = INT_FIELD, .high = 64},
    {.key = CONGRUENCE, .type = INT_FIELD, .high = 68},
    {.key = TURN, .type = FLOATS_FIELD, .low = -1, .high = 1, .least = 3, .most = 3},
    {.key = BASE, .type = INTS_FIELD, .low = 1, .high = INT32_MAX, .most = 4},
    {.key = SWIFT, .type = METHOD_FIELD, .high = 2},
#if BSMDEC_LIGHT == 0 /* others refuse such streams: pages send them to the whole decoder */
    {.key = REPEATS, .type = METHOD_FIELD, .high = 1},
#endif
};
INSIDE const Fields HEADER_FIELDS = {FIELDS, sizeof FIELDS / sizeof *FIELDS};

#define BIT(key) (1u << (key))
static const uint32_t OF_GRIDS_ALONE = BIT(LATTICE) | BIT(CORNER) | BIT(LIGHT_KEY) | BIT(CONGRUENCE) | BIT(TURN);
static const uint32_t OF_A_GRID = BIT(VERTICES) | BIT(FACES) | BIT(CENTER) | BIT(SCALE) | BIT(ATTRIBUTES) | BIT(GRID)
    | BIT(SWIFT) | BIT(REPEATS) | OF_GRIDS_ALONE;
static const uint32_t OF_A_RUN = BIT(VERTICES) | BIT(FACES) | BIT(SEQUENCE) | BIT(RUN);
enum { MOST_HEADER = 1 << 16, MOST_REACH = 8, MOST_ROUNDS = 64, MOST_HALVINGS = 40 };

static bool agrees(Context *context, bool is_so, const char *what) {
    return is_so || FAIL(context, CORRUPT, what);
}

static void set_header(const Record *record, Header *header) {
    const double(*number)[MOST_LIST] = record->number;
    const int *count = record->count;
    *header = (Header){
        .brief = header->brief, .connectivity = header->connectivity, .values = header->values,
        .metadata = header->metadata, .record = *record,
        .vertices = (int64_t)number[VERTICES][0], .faces = (int64_t)number[FACES][0],
        .blocks = (int64_t)number[BLOCKS][0],
        .block_size = (int64_t)number[BLOCK_SIZE][0], .coefficients = (int64_t)number[COEFFICIENTS][0],
        .key_interval = (int64_t)number[KEY_INTERVAL][0], .attributes = (int64_t)number[ATTRIBUTES][0],
        .step = number[STEP][0], .scale = number[SCALE][0], .smoothing = number[SMOOTHING][0],
        .refined = count[REFINEMENT] > 0, .on_grid = count[GRID] > 0, .is_sequence = count[SEQUENCE] > 0,
        .refinement = {number[REFINEMENT][0], number[REFINEMENT][1]},
        .onorm = (int)number[ONORM][0], .light = (int)number[LIGHT_KEY][0], .swift = (int)number[SWIFT][0],
        .repeats = (int)number[REPEATS][0],
        .congruence = (int)number[CONGRUENCE][0],
        .counted = count[CORNER] > 0,
        .base = {(int64_t)number[BASE][0], (int)number[BASE][1], (int)number[BASE][2], (int)number[BASE][3]},
        .frames = (int64_t)number[SEQUENCE][0], .gop_frames = (int64_t)number[SEQUENCE][1],
        .run = (int64_t)number[RUN][0], .mesh_of = count[RUN] > 1 ? (int64_t)number[RUN][1] : -1,
        .paper = {.power = 3, .iterations = count[SEQUENCE] > 0 ? 2 : 1, .key_iterations = 2, .springs = 1,
            .shift = count[SEQUENCE] > 0 ? 0x1p-5 : 0x1p-7},
    };
    if (count[LATTICE] == 2) {
        header->cells = (int64_t)number[LATTICE][0];
        header->points = (int64_t)number[LATTICE][1];
    }
    for (int j = 0; j < 3; j++) {
        header->center[j] = number[CENTER][j];
        header->grid[j] = (int32_t)number[GRID][j];
        header->corner[j] = (int64_t)number[CORNER][j];
        header->turn[j] = number[TURN][j];
    }
}

#ifdef BSMDEC_WRITES
Record header_record(const Header *h) {
    const double *center = h->center;
    const int32_t *grid = h->grid;
    return (Record){
        .number = {[VERTICES] = {(double)h->vertices}, [FACES] = {(double)h->faces}, [SCALE] = {h->scale},
            [CENTER] = {center[0], center[1], center[2]}, [ATTRIBUTES] = {(double)h->attributes},
            [GRID] = {grid[0], grid[1], grid[2]}, [LIGHT_KEY] = {h->light}, [SWIFT] = {h->swift},
            [REPEATS] = {h->repeats},
            [BLOCKS] = {(double)h->blocks},
            [BLOCK_SIZE] = {(double)h->block_size}, [COEFFICIENTS] = {(double)h->coefficients}, [STEP] = {h->step},
            [SEQUENCE] = {(double)h->frames, (double)h->gop_frames}},
        .count = {[VERTICES] = 1, [FACES] = 1, [SCALE] = 1, [CENTER] = 3, [ATTRIBUTES] = 1,
            [GRID] = h->is_sequence ? 0 : 3, [LIGHT_KEY] = 1, [SWIFT] = 1, [REPEATS] = 1, [BLOCKS] = 1,
            [BLOCK_SIZE] = 1, [COEFFICIENTS] = 1,
            [STEP] = h->is_sequence, [SEQUENCE] = h->is_sequence ? 2 : 0}};
}
#endif

/* The paper's constants in the place of the law's (F 10). */
static bool set_paper(Context *context, const Record *record, Paper *paper) {
    static const double LOW[] = {0, 0, 0, 1, 1, 1, 0x1p-30, 0}, HIGH[] = {32, 30, 1, 64, 1024, 1024, 0x1p30, 1};
    const double *number = record->number[PAPER];
    if (!agrees(context, record->number[ONORM][0] == 0 || number[0] > 0, "onorm without packed coefficients"))
        return false;
    if (record->count[PAPER] == 0) return true;
    if (!agrees(context, record->count[PAPER] == 8, "a paper that is not eight numbers")) return false;
    for (int k = 0; k < 8; k++) {
        bool whole = k == 6 || number[k] == (double)(int64_t)number[k];
        if (!(number[k] >= LOW[k] && number[k] <= HIGH[k] && whole))
            return FAIL(context, CORRUPT, "number # of the paper is not legal", k);
    }
    Paper law = *paper;
    *paper = (Paper){(int)number[0], (int)number[1], (int)number[2], (int)number[3], (int)number[4], (int)number[5],
        (int)number[7], number[6]};
    bool same = paper->bits == 0 && paper->coarser == 0 && paper->exact == 0 && paper->power == law.power
        && paper->springs == 1 && paper->iterations == law.iterations && paper->key_iterations == law.key_iterations
        && paper->shift == law.shift;
    return agrees(context, !same, "constants of a paper that equal the defaults");
}

/* F 4.6. */
static bool check_grid(Context *context, const Header *header) {
    const int *count = header->record.count;
    uint32_t stored = header->record.stored;
    int32_t most = 0;
    bool centered = false;
    for (int j = 0; j < 3; j++) {
        if (header->grid[j] > most) most = header->grid[j];
        centered = centered || header->center[j] != 0.0;
    }
    return agrees(context, count[GRID] == 3, "a grid of other than three axes")
        && agrees(context, count[LATTICE] != 1, "a lattice that is not cells and points") && agrees(context,
            header->points == 0 || header->points >= most, "a lattice with fewer points than the grid has values")
        && agrees(context, header->points <= header->cells, "a lattice of more points than cells")
        && agrees(context, count[CORNER] % 3 == 0, "a corner of other than three axes")
        && agrees(context, !(header->counted && centered), "a corner and a center") && agrees(context,
            header->light != EXACT_FLOATS || count[LATTICE] + count[CORNER] == 0, "floats in cells that are counted")
        && agrees(context, header->light == 0 || (stored & BIT(TURN)) == 0, "a turn of a light or exact grid")
        && agrees(context, (stored & ~OF_A_GRID) == 0, "a grid, and fields of blocks");
}

/* M 18.1. */
static bool check_base(Context *context, const Header *header) {
    const Coarse *base = &header->base;
    uint32_t strange = BIT(SEQUENCE) | BIT(PAPER) | BIT(ONORM);
    if (header->record.count[BASE] == 0) return true;
    return agrees(context, header->record.count[BASE] == 4, "a base that is not four numbers")
        && agrees(context, base->reach <= MOST_REACH && base->rounds <= MOST_ROUNDS
            && base->halvings <= MOST_HALVINGS, "a base whose numbers are out of their ranges")
        && agrees(context, base->cells <= header->vertices, "more cells than vertices")
        && agrees(context, header->refined, "a base without refinement")
        && agrees(context, (header->record.stored & strange) == 0, "a base, and fields of the paper or of sequences");
}

static bool check_blocks(Context *context, const Header *header) {
    const int *count = header->record.count;
    double rows = (double)header->blocks * (double)header->block_size, step = header->refinement[0];
    int64_t ground = ground_size(header);
    return check_base(context, header) && agrees(context, header->blocks > 0 && header->block_size > 0
            && header->coefficients > 0, "neither blocks nor a grid")
        && agrees(context, (header->record.stored & OF_GRIDS_ALONE) == 0, "what belongs to a grid, without one")
        && agrees(context, header->blocks <= ground, "more blocks than vertices")
        && agrees(context, header->block_size <= ground, "blocks larger than the mesh")
        && agrees(context, rows >= (double)ground, "blocks too small to cover the mesh") && agrees(context,
            rows <= (double)MOST_COPIES * (double)ground + FREE_COPIES, "blocks that overlap too much")
        && agrees(context, header->coefficients <= header->block_size, "more coefficients than a block has vertices")
        && agrees(context, count[REFINEMENT] != 1, "a refinement that is not a step and a ratio")
        && agrees(context, !header->refined || (step >= 0x1p-40
            && step <= 1.0), "a step of a refinement out of its range") && agrees(context, !header->refined
            || header->refinement[1] >= 0x1p-4, "a ratio of a refinement out of its range")
        && agrees(context, !(header->refined && header->is_sequence), "refinement of a sequence");
}

static bool check_header(Context *context, const Header *header) {
    const int *count = header->record.count;
    if (header->congruence > 0 && header->congruence < LEAST_CONGRUENCE)
        return FAIL(context, UNSUPPORTED, "congruent parts of a draft of 1.1, older than its release: encode it again");
    if (!(agrees(context, header->vertices <= 3 * header->faces, "more vertices than the corners of its faces")
        && agrees(context, !header->is_sequence
            || header->gop_frames > 0, "a sequence that is not frames and a length for GOPs")
        && agrees(context, count[RUN] == 0 || header->is_sequence, "a run of a static mesh")
        && agrees(context, count[RUN] != 1 || header->run > 0, "a run that is stored although it is the first")))
        return false;
    if (!agrees(context, header->swift == 0 || header->attributes > 0, "swift attributes, and none")) return false;
    if (header->on_grid) return check_grid(context, header);
    if (header->mesh_of < 0) return check_blocks(context, header);
    return agrees(context, header->mesh_of < header->run, "the mesh of a run that comes later")
        && agrees(context, (header->record.stored & ~OF_A_RUN) == 0, "the mesh of another run, and fields of its own");
}

/* The header of a brief stream, all of whose fields are one of bytes, and what follows it there (F 11). */
static bool parse_brief(Context *context, const Map *map, Record *record, Header *header) {
    static const uint8_t KEYS[] = {VERTICES, FACES, GRID, GRID, GRID, CONGRUENCE, SCALE, CENTER, CENTER, CENTER, TURN,
        TURN, TURN};
    Cursor cursor = {context, map->value[0].bytes};
    const Value *last = &map->value[map->count - 1];
    if (!agrees(context, map->value[0].kind == BINARY && last->kind == BINARY && last->bytes.size > 0,
            "a brief header with other values than bytes"))
        return false;
    *record = (Record){0};
    for (int i = 0; i < (map->key[0].whole == BRIEF ? 10 : 13); i++) {
        double number = i < 6 ? (double)take_varint(&cursor) : take_single(&cursor, 0xca).number;
        record->stored |= BIT(KEYS[i]);
        record->number[KEYS[i]][record->count[KEYS[i]]++] = number;
    }
    header->connectivity = take_span(&cursor, take_varint(&cursor));
    header->values = take_rest(&cursor);
    if (map->count > 1) header->metadata = last->bytes;
    return !failed(context) && complete_record(context, HEADER_FIELDS, record);
}

bool parse_header(Context *context, Span payload, Arena *scratch, Header *header) {
    Record record;
    Mark mark = mark_of(scratch);
    Map *map = NULL;
    bool brief = !BSMDEC_LONG && payload.size > 1 && (payload.data[1] == BRIEF || payload.data[1] == BRIEF_TURNED);
    if (payload.size > MOST_HEADER) return FAIL(context, CORRUPT, "a header of # bytes is too long", payload.size);
    bool parsed = !brief || (TAKE(scratch, 1, map) && parse_map(context, payload, map));
    brief = brief && parsed && (map->count == 1 || (map->count == 2 && map->key[1].whole == BRIEF_METADATA));
    *header = (Header){.brief = brief};
    parsed = parsed && (brief ? parse_brief(context, map, &record, header)
        : parse_record(context, payload, HEADER_FIELDS, scratch, &record));
    release_to(scratch, mark);
    if (!parsed) return false;
    set_header(&record, header);
#ifdef BSMDEC_LACKS /* by a smaller build for pages */
    if (BSMDEC_LACKS) return FAIL(context, UNSUPPORTED, "");
#endif
    return set_paper(context, &header->record, &header->paper) && check_header(context, header)
        && WITHIN(context, vertices, header->vertices) && WITHIN(context, faces, header->faces)
        && WITHIN(context, blocks, header->blocks) && WITHIN(context, block_size, header->block_size)
        && WITHIN(context, coefficients, header->coefficients) && WITHIN(context, frames, header->frames)
        && WITHIN(context, gop_frames, header->gop_frames) && WITHIN(context, attributes, header->attributes);
}
