/* Positions on a grid (specification, V 7 to V 10, V 12, V 15 to V 18). */
#include "bitstream/payloads/payloads.h"

#include "bitstream/costs.h"

enum { AXES = 3, SUM_LEARNERS = 48, SIZE_LEARNERS = 12, FLOAT_SLOTS = 27 };

/* Of the largest axis. */
static int32_t most_of(const Header *header) {
    return (int32_t)largest(largest(header->grid[0], header->grid[1]), header->grid[2]);
}

static bool charge_grid(Context *context, const Header *header) {
    double n = (double)header->vertices, m = (double)header->faces, span = most_of(header);
    double images = 2 * transforms_of(header), bytes = is_congruent(header) ? twins_bytes(n, images) : 0;
    double work = method_of(header) == LIGHT ? light_work(n, m) : grid_work(n, m);
    if (is_congruent(header)) work += twins_work(n, images);
    if (!reserve(context, grid_memory(n, m) + bytes, 0) || !charge(context, work, 0)
        || !WITHIN(context, field_bytes, grid_field_bytes(n, m) + bytes))
        return false;
    return method_of(header) != EXACT_FLOATS
        || (reserve(context, 24 * (span + 1), 0) && charge(context, floats_work(n, span), 0));
}

static bool begin_twins(GridField *field, Arena *arena) {
    int64_t n = field->header->vertices, transforms = transforms_of(field->header), images = 2 * transforms;
    Twins *twins;
    if (!TAKE_ZEROS(arena, 1, twins) || !TAKE(arena, least(MOST_ECHOES, ECHOES * n + 1), twins->echo)
        || !TAKE_ZEROS(arena, ECHO_HEADS, twins->echo_head)
        || !zero_ints2(arena, transforms, TRANSFORM_ROW, &field->transforms))
        return false;
    field->twins = field->grid.twins = field->light.twins = twins;
    twins->asks_whole = asks_whole(field->header);
    if (method_of(field->header) != LIGHT) start_learnt(&field->model, field->grid.learners);
    start_whole(twins);
    for (int i = 0; i < 2 * WHOLE_CONTEXTS * CONTEXT_SIZE; i++) twins->whole_slot[i] = 1u << 31;
    twins->echo[0] = (Echo){.chain = {0}}; /* the end of chains */
    if (images == 0) return true;
    twins->head_bits = 2; /* four times as many as vertices: few hold more than one cell */
    while (INT64_C(1) << (twins->head_bits - 2) < n && twins->head_bits < 26) twins->head_bits++;
    int64_t heads = INT64_C(1) << twins->head_bits;
    if (!TAKE(arena, n * images, twins->twin) || !TAKE_ZEROS(arena, n, twins->has) || !TAKE(arena, heads, twins->head)
        || !TAKE(arena, n, twins->next) || !TAKE_ZEROS(arena, n, twins->hit)
        || !TAKE_ZEROS(arena, 1 << (NEAR_BITS - 6), twins->near))
        return false;
    for (int64_t i = 0; i < heads; i++) twins->head[i] = -1;
    return true;
}

static bool begin_full(GridField *field, const GridField *like, Arena *arena, Arena *scratch) {
    Grid *grid = &field->grid;
    int64_t n = field->header->vertices, words = most_of(field->header) / 64 + 1;
    if ((like == NULL && !order_mesh(&field->corners, arena, scratch, &field->order))
        || !make_value_model(arena, &field->model, is_congruent(field->header)))
        return false;
    *grid = (Grid){.largest = const_ints(field->largest), .order = const_ints(field->order), .values = field->values};
    if (!zero_ints2(arena, n, AXES, &grid->gaps) || !zero_longs2(arena, n, 4, &grid->sums)
        || !zero_longs2(arena, AXES, words, &grid->seen)
        || !make_learners(arena, SUM_LEARNERS + SIZE_LEARNERS, &grid->learners))
        return false;
    if (is_congruent(field->header)) return begin_twins(field, arena);
    for (int k = 0; k < SUM_LEARNERS + SIZE_LEARNERS; k++) start_learner(grid->learners, k, 0, 49152);
    for (int k = SUM_LEARNERS; k < SUM_LEARNERS + SIZE_LEARNERS; k++) start_learner(grid->learners, k, 1, 8192);
    return true;
}

static bool begin_light(GridField *field, Arena *arena) {
    Light *light = &field->light;
    bool lean = is_congruent(field->header);
    field->order = field->corners.rank;
    *light = (Light){.largest = const_ints(field->largest), .values = field->values};
    if (!zero_ints2(arena, field->header->vertices, AXES, &light->gaps)
        || !take_words(arena, lean ? LEAN_SLOTS : LIGHT_SLOTS, &light->slots))
        return false;
    for (int64_t i = 0; i < light->slots.size; i++) light->slots.data[i] = 1u << 31;
    if (!lean) return true;
    if (!TAKE(arena, LEAN_NODES * LEAN_INPUTS, light->weights)) return false;
    for (int i = 0; i < LEAN_NODES * LEAN_INPUTS; i++) light->weights[i] = ONE * 3 / 8;
    return begin_twins(field, arena);
}

static bool begin_floats(GridField *field, Arena *arena) {
    Floats *floats = &field->floats;
    int64_t span = most_of(field->header) + 1;
    if (!take_words(arena, FLOAT_SLOTS, &floats->slots) || !zero_longs(arena, AXES, &floats->latest)
        || !take_longs2(arena, AXES, span, &floats->known))
        return false;
    for (int64_t i = 0; i < FLOAT_SLOTS; i++) floats->slots.data[i] = 1u << 31;
    for (int64_t i = 0; i < AXES * span; i++) floats->known.data[i] = NO_FLOAT;
    return true;
}

/* The transforms, which precede the first value (V 17.2). */
static void code_twins(GridField *field, RangeCoder *coder) {
    code_transforms(coder, const_ints(field->largest), field->transforms);
    list_images(const_ints(field->largest), const_ints2(field->transforms), field->twins);
}

bool begin_grid(GridField *field, const GridField *like, Context *context, const Header *header, ConstInts2 faces,
    Arena *arena, Arena *scratch) {
    int64_t n = header->vertices;
    *field = (GridField){.context = context, .header = header, .faces = faces};
    if (like != NULL) field->corners = like->corners, field->order = like->order;
    if (!charge_grid(context, header)) return false;
    if (like == NULL && !link_mesh(context, faces, n, arena, scratch, &field->corners)) return false;
    if (!take_ints(arena, AXES, &field->largest) || !zero_ints2(arena, n, AXES, &field->values)
        || !take_doubles2(arena, n, AXES, &field->positions))
        return false;
    for (int64_t i = 0; i < AXES * n; i++) field->positions.data[i] = __builtin_nan("");
    memcpy(field->largest.data, header->grid, sizeof header->grid);
    if (method_of(header) == LIGHT) return begin_light(field, arena);
    return begin_full(field, like, arena, scratch) && (method_of(header) != EXACT_FLOATS || begin_floats(field, arena));
}

bool code_grid_values(GridField *field, int64_t first, int64_t count, Span payload) {
    Coding coding;
    if (!begin_coding(field->context, payload, &coding)) return false;
    if (first == 0 && field->twins != NULL) code_twins(field, &coding.coder);
    int64_t looks = (int64_t)(work_left(field->context) / LOOK_WORK);
    if (field->twins != NULL) field->twins->looks = looks;
    int64_t done = method_of(field->header) == LIGHT
        ? code_light(&coding.coder, field->corners, field->light, first, count)
        : code_grid(&coding.coder, field->model, field->corners, field->grid, first, count);
    return (field->twins == NULL || charge(field->context, LOOK_WORK * (double)(looks - field->twins->looks), 0))
        && check_chunk_done(&coding, done, count);
}

/* V 18. */
static void turn_place(const double *q, double *place) {
    double t[3], share = 2.0 / (1.0 + q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
    for (int j = 0, k = 1, l = 2; j < 3; k = l, l = j++) t[j] = q[k] * place[l] - q[l] * place[k];
    for (int j = 0, k = 1, l = 2; j < 3; k = l, l = j++) place[j] += share * (t[j] + (q[k] * t[l] - q[l] * t[k]));
}

/* V 12. */
static bool place_values(GridField *field, ConstInts vertices) {
    const Header *header = field->header;
    double spoiled = 0.0;
    for (int64_t i = 0; i < vertices.size; i++) {
        double *place = field->positions.data + AXES * (int64_t)vertices.data[i];
        for (int j = 0; j < AXES; j++) {
            int64_t value = field->values.data[AXES * (int64_t)vertices.data[i] + j];
            int64_t cell =
                header->points > 0 ? (2 * value * header->cells + header->points) / (2 * header->points) : value;
            double product = (double)(cell + header->corner[j]) * header->scale;
            place[j] = product + header->center[j];
        }
        if (method_of(header) != LIGHT) turn_place(header->turn, place);
        spoiled += place[0] * 0.0 + place[1] * 0.0 + place[2] * 0.0;
    }
    return spoiled == 0.0 || FAIL(field->context, NUMERIC, "positions are not finite in the unit of the mesh");
}

static double float_of(int64_t number) {
    uint32_t bits = (uint32_t)(number < 0 ? (int64_t)INT32_MAX - number : number);
    float single;
    memcpy(&single, &bits, sizeof single);
    return single;
}

/* Which float of the cell of its value each coordinate is (V 16). */
bool place_floats(GridField *field, ConstInts vertices, Span payload, Arena *scratch) {
    const Header *header = field->header;
    int64_t count = vertices.size;
    Ints2 values;
    Longs2 low, near, high, chosen;
    Coding coding;
    if (!take_ints2(scratch, count, AXES, &values) || !take_longs2(scratch, count, AXES, &low)
        || !take_longs2(scratch, count, AXES, &near) || !take_longs2(scratch, count, AXES, &high)
        || !take_longs2(scratch, count, AXES, &chosen) || !begin_coding(field->context, payload, &coding))
        return false;
    for (int64_t i = 0; i < AXES * count; i++) {
        int j = (int)(i % AXES);
        int32_t value = values.data[i] = field->values.data[AXES * (int64_t)vertices.data[i / AXES] + j];
        double down = (value - 0.5) * header->scale, middle = value * header->scale, up = (value + 0.5) * header->scale;
        low.data[i] = number_of_float(down + header->center[j]);
        near.data[i] = number_of_float(middle + header->center[j]);
        high.data[i] = number_of_float(up + header->center[j]);
        chosen.data[i] = number_of_float(field->positions.data[AXES * (int64_t)vertices.data[i / AXES] + j]);
    }
    int64_t done = code_floats(&coding.coder, field->floats, const_ints2(values), const_longs2(low), const_longs2(near),
        const_longs2(high), chosen);
    if (!check_chunk_done(&coding, done, count)) return false;
    double spoiled = 0.0;
    for (int64_t i = 0; i < AXES * count; i++) {
        double place = float_of(chosen.data[i]);
        field->positions.data[AXES * (int64_t)vertices.data[i / AXES] + i % AXES] = place;
        spoiled += place * 0.0;
    }
    return spoiled == 0.0 || FAIL(field->context, NUMERIC, "positions are not finite in the unit of the mesh");
}

bool decode_grid(GridField *field, int64_t first, int64_t count, Span payload, Arena *scratch) {
    Context *context = field->context;
    double bytes = (double)payload.size;
    if (!charge(context, method_of(field->header) == LIGHT ? light_chunk_work(bytes) : grid_chunk_work(bytes), bytes))
        return false;
    if (first != field->coded)
        return FAIL(context, CORRUPT, "positions from number # on are missing; others depend on them", field->coded);
    bool exact = method_of(field->header) == EXACT_FLOATS;
    Cursor cursor = {context, payload};
    Span values = exact ? take_span(&cursor, take_varint(&cursor)) : payload;
    if (failed(context) || !code_grid_values(field, first, count, values)) return false;
    field->coded += count;
    ConstInts vertices = {field->order.data + first, count};
    return exact ? place_floats(field, vertices, take_rest(&cursor), scratch) : place_values(field, vertices);
}
