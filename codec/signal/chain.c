/* One chain of blocks (specification, M 7, M 9, M 10). */
#include "codec/signal/decoding.h"

#include "codec/blocks/blocks.h"
#include "codec/signal/signal.h"
#include "bitstream/payloads/payloads.h"

enum { LEVEL_BYTES = 64 }; /* more than a level can take */
enum { PRIOR_WEIGHTS = EXPECTATIONS * SITUATIONS * NEIGHBORS, PRIOR_MIXES = SELECTORS * NODES * EXPECTATIONS };

bool begin_chains(Chains *chains, Context *context, const Header *header, const Graph *graph, const Blocks *blocks,
    Arena *arena) {
    *chains = (Chains){.context = context, .header = header, .graph = graph, .blocks = blocks, .number = -1};
    chains->chain = chains->subspaces[0] = chains->subspaces[1] = arena_of(context);
    chains->knows = header->paper.springs && header->key_interval != 1;
    if (!chains->knows) return true;
    return zero_doubles2(arena, graph->size, 3, &chains->known.sums)
        && zero_doubles(arena, graph->size, &chains->known.weights) && zero_bytes(arena, graph->size, &chains->inside);
}

void end_chains(Chains *chains) {
    release_all(&chains->chain);
    release_all(&chains->subspaces[0]);
    release_all(&chains->subspaces[1]);
}

static uint16_t prior(int64_t place) { return (uint16_t)(PRIORS[2 * place] | PRIORS[2 * place + 1] << 8); }

/* What the coder starts from (M 9.1, M 9.2). */
static void learn_beforehand(Chains *chains) {
    for (int64_t i = 0; i < PRIOR_WEIGHTS; i++) chains->expectations.data[i] = prior(i);
    for (int64_t i = 0; i < PRIOR_MIXES; i++) chains->bank.weights[i] = 16 * (int16_t)prior(PRIOR_WEIGHTS + i);
    for (int64_t i = 0; i < LEVEL_SLOTS; i++) {
        uint32_t stored = prior(PRIOR_WEIGHTS + PRIOR_MIXES + i);
        chains->bank.slots[i] = (stored >> 4) << 20 | 1u << 19 | (stored & 15) << 2;
    }
}

/* Forget the positions of the previous chain: of its decoded blocks, and of a spoilt one. */
static void forget_positions(Chains *chains) {
    const int64_t *starts = chains->blocks->starts.data;
    int64_t start = starts[chains->first], end = starts[least(chains->next + 1, chains->blocks->count)];
    for (int64_t i = start; i < end; i++) {
        int64_t v = chains->blocks->members.data[i];
        chains->known.weights.data[v] = 0.0;
        for (int d = 0; d < 3; d++) chains->known.sums.data[3 * v + d] = 0.0;
    }
}

void leave_chain(Chains *chains) {
    if (chains->knows && chains->number >= 0) forget_positions(chains);
    chains->number = -1;
    chains->subspace = (Singles2){NULL, 0, 0};
    end_chains(chains);
}

static void enter_chain(Chains *chains, int64_t number) {
    leave_chain(chains);
    chains->number = number;
    chains->first = chains->next = number * chain_length(chains->header);
    chains->elsewhere = false;
}

bool begin_chain(Chains *chains, int64_t number) {
    Arena *arena = &chains->chain;
    Past *past = &chains->past;
    int64_t width = chains->header->coefficients, size = 3 * (ABOVE + width + BEYOND);
    Ints magnitudes;
    enter_chain(chains, number);
    if (!make_bank(arena, BLOCK_BANK, &chains->bank)
        || !zero_ints(arena, 3 * size, &magnitudes) || !take_ints(arena, PRIOR_WEIGHTS, &chains->expectations))
        return false;
    int32_t *first = magnitudes.data + 3 * ABOVE;
    *past = (Past){first, first + size, first + 2 * size, width, 0};
    learn_beforehand(chains);
    return !chains->knows || charge(chains->context, chain_work((double)chains->graph->size), 0);
}

/* Packed coefficients (F 6, M 9.10), `count` rows of three, times the step. */
static bool read_packed(Chains *chains, Span payload, int64_t count, Arena *scratch, Doubles2 coefficients) {
    Context *context = chains->context;
    int bits = chains->header->paper.bits;
    int64_t size = (3 * count * bits + 7) / 8;
    Bytes packed;
    if (!take_bytes(scratch, size, &packed) || !unpack_zstd(context, payload, packed.data, size, scratch)) return false;
    int64_t at = 0;
    for (int64_t i = 0; i < 3 * count; i++) {
        int64_t value = 0;
        for (int k = 0; k < bits; k++, at++) value = 2 * value + (packed.data[at >> 3] >> (7 - (at & 7)) & 1);
        int64_t level = value - (INT64_C(1) << (bits - 1));
        if (i < 3) level *= INT64_C(1) << chains->header->paper.coarser;
        coefficients.data[i] = (double)level * chains->header->step;
    }
    for (; at < 8 * size; at++)
        if (packed.data[at >> 3] >> (7 - (at & 7)) & 1)
            return FAIL(context, CORRUPT, "the bits behind the last packed coefficient are not 0");
    return true;
}

/* Coded coefficients (M 9.1 to M 9.11), rows of three. */
static bool code_coefficients(Chains *chains, Span payload, Ints2 levels) {
    Coding coding;
    if (levels.rows > chains->header->coefficients)
        return FAIL(chains->context, CORRUPT, "# coefficients are too many", levels.rows);
    if (!begin_coding(chains->context, payload, &coding) || !room_to_write(&coding, 3 * LEVEL_BYTES * levels.rows))
        return false;
    code_block(&coding.coder, &chains->bank, &chains->past, chains->expectations.data, levels);
    return finish_coding(&coding);
}

/* Springs at each row, the factor of L + S + shift, and what continues what they hang on (M 7.3, M 7.4). */
static bool suspend_block(Chains *chains, Arena *scratch, Suspended *block) {
    const Patch *patch = &block->patch;
    int64_t n = patch->size;
    Singles room;
    if (!zero_doubles(scratch, n, &block->springs) || !zero_doubles2(scratch, n, 3, &block->pulls)
        || !take_doubles2(scratch, n, 3, &block->continued) || !take_doubles(scratch, n, &block->weights)
        || !take_singles(scratch, solving_space(n, 3), &room))
        return false;
    if (chains->knows)
        look_around(chains->graph->offsets, chains->graph->neighbors, patch->vertices, chains->inside,
            const_doubles2(chains->known.sums), const_doubles(chains->known.weights), block->springs, block->pulls);
    if (!factorize_patch(patch, const_doubles(block->springs), chains->header->paper.shift, scratch, &block->factor))
        return false;
    continue_known(patch->fronts, block->factor.values, const_singles(block->factor.inverse),
        const_doubles(block->springs), const_doubles2(block->pulls), room, block->continued);
    for (int64_t r = 0; r < n; r++)
        block->weights.data[r] = patch->diagonal.data[r] > 1.0 ? patch->diagonal.data[r] : 1.0;
    return true;
}

bool make_dictionary(Chains *chains, const Suspended *block, int64_t width, Arena *scratch, Singles2 *dictionary) {
    Arena *arena = &chains->subspaces[!chains->present];
    const Patch *patch = &block->patch;
    if (!take_singles2(arena, patch->size, width, dictionary)) return false;
    if (chains->subspace.rows == patch->size)
        return following_dictionary(
            chains->context, chains->header, patch, &block->factor, chains->subspace, scratch, *dictionary);
    return key_dictionary(chains->context, chains->header, patch, const_doubles(block->springs), &block->factor,
        scratch, *dictionary);
}

void commit_block(Chains *chains, Singles2 dictionary, const DecodedBlock *decoded) {
    chains->subspace = dictionary;
    release_all(&chains->subspaces[chains->present]);
    chains->present = !chains->present;
    if (chains->knows)
        add_copies(chains->known.sums, chains->known.weights, decoded->vertices, decoded->positions, decoded->weights);
}

#ifdef BSMDEC_WRITES
bool hang_block(Chains *chains, int64_t index, Arena *scratch, Suspended *block) {
    ConstInts members = members_of(chains->blocks, index, size_of_block(chains->blocks, index));
    return order_patch(chains->graph, members, scratch, &block->patch)
        && find_patch_fronts(chains->context, scratch, &block->patch) && suspend_block(chains, scratch, block);
}

Singles2 first_columns(Singles2 dictionary, int64_t width) {
    Singles2 first = {dictionary.data, dictionary.rows, width};
    for (int64_t r = 1; width < dictionary.columns && r < first.rows; r++)
        memmove(first.data + r * width, dictionary.data + r * dictionary.columns, (size_t)width * sizeof *first.data);
    return first;
}

/* Levels nearest to coefficients; returns the rows that they take, one at least. */
static int64_t round_coefficients(ConstDoubles2 coefficients, double step, Arena *scratch, Ints2 levels) {
    int64_t count = 3 * coefficients.rows, rows = 1;
    const double most = (double)MAX_LEVEL * TARGET_UNIT;
    Longs targets;
    int32_t *ways;
    uint8_t *origins;
    if (!take_longs(scratch, count, &targets) || !TAKE(scratch, count * TRELLIS_STATES, ways)
        || !TAKE(scratch, count * TRELLIS_STATES, origins))
        return 0;
    for (int64_t i = 0; i < count; i++) {
        double target = __builtin_rint(coefficients.data[i] * (TARGET_UNIT / step));
        targets.data[i] = (int64_t)(target > most ? most : target > -most ? target : -most);
    }
    nearest_levels((ConstLongs){targets.data, count}, ways, origins, levels.data);
    for (int64_t i = 0; i < count; i++)
        if (levels.data[i] != 0) rows = i / 3 + 1;
    return rows;
}

bool write_levels(Chains *chains, ConstDoubles2 prediction, ConstSingles2 dictionary, ConstDoubles2 coefficients,
    bool all, Arena *scratch, int64_t *rows, Doubles2 positions) {
    double step = chains->header->step;
    Ints2 levels;
    Doubles room;
    if (!take_ints2(scratch, coefficients.rows, 3, &levels) || !take_doubles(scratch, 3 * coefficients.rows, &room))
        return false;
    int64_t used = round_coefficients(coefficients, step, scratch, levels);
    *rows = levels.rows = all ? coefficients.rows : used;
    if (used == 0 || !code_coefficients(chains, (Span){0}, levels)) return false;
    place_block(prediction, dictionary, const_ints2(levels), step / 2, room, positions);
    return true;
}
#endif

/* Positions of a block whose levels are known (M 10.2). */
static bool place(Chains *chains, Suspended *block, int64_t index, int64_t width, Ints2 levels, Doubles2 coefficients,
    Arena *scratch, DecodedBlock *decoded) {
    Context *context = chains->context;
    const Patch *patch = &block->patch;
    int64_t n = patch->size;
    Doubles room;
    Doubles2 positions;
    Singles2 dictionary;
    if (!take_doubles(scratch, 3 * width, &room)
        || !take_doubles2(scratch, n, 3, &positions) || !suspend_block(chains, scratch, block))
        return false;
    if (!make_dictionary(chains, block, width, scratch, &dictionary)
        || !charge(context, ground_work(&patch->fronts, width), 0))
        return false;
    ConstDoubles2 continued = const_doubles2(block->continued);
    if (chains->header->paper.bits > 0) {
        reconstruct(const_singles2(dictionary), const_doubles2(coefficients), positions);
        for (int64_t i = 0; i < 3 * n; i++) positions.data[i] = continued.data[i] + positions.data[i];
    } else {
        place_block(continued, const_singles2(dictionary), const_ints2(levels), chains->header->step / 2, room,
            positions);
    }
    *decoded = (DecodedBlock){index, patch->vertices, const_doubles2(positions), const_doubles(block->weights)};
    commit_block(chains, dictionary, decoded);
    double spoiled = 0.0;
    for (int64_t i = 0; i < 3 * n; i++) spoiled += positions.data[i] * 0.0;
    return spoiled == 0.0 || FAIL(context, NUMERIC, "the coefficients reconstruct to positions that are not finite");
}

static bool decode_next(Chains *chains, int64_t index, int64_t width, Span payload, Arena *scratch,
    DecodedBlock *decoded) {
    Context *context = chains->context;
    int64_t rows = size_of_block(chains->blocks, index);
    double work = block_work((double)rows, (double)chains->blocks->edges.data[index], 3.0 * (double)width);
    Suspended block;
    Patch *patch = &block.patch;
    Ints2 levels = {NULL, 0, 3};
    Doubles2 coefficients = {NULL, 0, 3};
    if (!charge(context, work, (double)payload.size + BLOCK_FRAME_BYTES)
        || !order_patch(chains->graph, members_of(chains->blocks, index, rows), scratch, patch))
        return false;
    if (width < 1 || width > rows)
        return FAIL(context, CORRUPT, "# coefficients for a block of # vertices", width, rows);
    if (chains->header->paper.bits > 0) {
        if (!take_doubles2(scratch, width, 3, &coefficients)
            || !read_packed(chains, payload, width, scratch, coefficients))
            return false;
    } else {
        if (!zero_ints2(scratch, width, 3, &levels) || !code_coefficients(chains, payload, levels)) return false;
    }
    return find_patch_fronts(context, scratch, patch) && fits_memory(context, patch_memory(&patch->fronts, width))
        && place(chains, &block, index, width, levels, coefficients, scratch, decoded);
}

/* Once a block of a chain is missing or broken, the rest of the chain cannot be decoded. */
bool decode_block(Chains *chains, int64_t index, int64_t coefficients, Span payload, Arena *scratch,
    DecodedBlock *decoded) {
    int64_t number = index / chain_length(chains->header);
    if (number != chains->number && !begin_chain(chains, number)) return false;
    Ledger *ledger = chains->context->ledger;
    if (ledger != NULL && index == chains->first) ledger->begun = ledger->count;
    if (index != chains->next || chains->elsewhere) {
        FAIL(chains->context, CORRUPT, "the block depends on block #, which is lost", chains->next);
    } else if (decode_next(chains, index, coefficients, payload, scratch, decoded)) {
        chains->next++;
        return true;
    }
    locate(&chains->context->error, -1, -1, index);
    return false;
}

bool settle_block(Chains *chains, int64_t index, const Ledger *ledger) {
    int64_t number = index / chain_length(chains->header);
    if (number != chains->number) enter_chain(chains, number);
    chains->elsewhere = true;
    if (!charge_ledger(chains->context, ledger, 0, ledger->begun)) return false;
    if (charge_ledger(chains->context, ledger, ledger->begun, ledger->count)) {
        chains->next++;
        return true;
    }
    locate(&chains->context->error, -1, -1, index);
    return false;
}

bool copy_block(const DecodedBlock *block, Arena *arena, DecodedBlock *copy) {
    int64_t n = block->vertices.size;
    Ints vertices;
    Doubles2 positions;
    Doubles weights;
    if (!take_ints(arena, n, &vertices) || !take_doubles2(arena, n, 3, &positions) || !take_doubles(arena, n, &weights))
        return false;
    memcpy(vertices.data, block->vertices.data, (size_t)n * sizeof *vertices.data);
    memcpy(positions.data, block->positions.data, (size_t)(3 * n) * sizeof *positions.data);
    memcpy(weights.data, block->weights.data, (size_t)n * sizeof *weights.data);
    *copy = (DecodedBlock){block->index, const_ints(vertices), const_doubles2(positions), const_doubles(weights)};
    return true;
}
