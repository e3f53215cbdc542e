/* Parts of a moving mesh: the weights of their edges, what they hang on, their dictionaries (S 3, S 8.2). */
#include "codec/sequence/gops.h"

#include "codec/signal/signal.h"
#include "codec/basis/patches.h"
#include "codec/geometry/geometry.h"
#include "codec/sequence/temporal.h"

static const double TETHER = 0x1p-16, SITE_MEMORY = 6000, ROW_MEMORY = 352, UNCODED_WORK = 8e4;

/* Number the vertices around a part, ascending; `place`, one for each vertex of the mesh, holds -1 before and after. */
static bool number_around(Ints outer, Ints place, Arena *scratch, Ints *around) {
    if (!take_ints(scratch, outer.size, around)) return false;
    around->size = 0;
    for (int64_t i = 0; i < outer.size; i++) {
        if (place.data[outer.data[i]] < 0) around->data[around->size++] = outer.data[i];
        place.data[outer.data[i]] = 0;
    }
    sort_ascending(around->data, around->size);
    for (int64_t i = 0; i < around->size; i++) place.data[around->data[i]] = (int32_t)i;
    for (int64_t i = 0; i < outer.size; i++) outer.data[i] = place.data[outer.data[i]];
    for (int64_t i = 0; i < around->size; i++) place.data[around->data[i]] = -1;
    return true;
}

/* S 3.2. */
static bool hang_part(const Graph *graph, ConstDoubles weights, ConstInts rank, Ints place, Arena *scratch,
    Site *part) {
    Patch *patch = &part->patch;
    int64_t n = patch->size, room = 0;
    for (int64_t r = 0; r < n; r++)
        room += graph->offsets.data[patch->vertices.data[r] + 1] - graph->offsets.data[patch->vertices.data[r]];
    Doubles inner;
    if (!take_doubles(scratch, patch->neighbors.size, &inner) || !take_doubles(scratch, n, &part->springs)
        || !take_ints(scratch, n + 1, &part->starts) || !take_ints(scratch, room, &part->outer)
        || !take_doubles(scratch, room, &part->stiffness))
        return false;
    part->outer.size = part->stiffness.size = hold(graph->offsets, graph->neighbors, weights, rank, patch->vertices,
        patch->offsets, patch->neighbors, inner, part->springs, part->starts, part->outer, part->stiffness);
    if (!number_around(part->outer, place, scratch, &part->around)) return false;
    patch->weights = const_doubles(inner);
    for (int64_t r = 0; r < n; r++) {
        patch->diagonal.data[r] = 0.0;
        for (int64_t i = patch->offsets.data[r]; i < patch->offsets.data[r + 1]; i++)
            patch->diagonal.data[r] += inner.data[i];
    }
    return true;
}

/* A copy in an arena of `bytes` bytes, or NULL. */
static void *copied(Arena *arena, const void *data, int64_t bytes) {
    uint8_t *copy;
    if (TAKE(arena, bytes, copy) && bytes > 0) memcpy(copy, data, (size_t)bytes);
    return copy;
}

/* What stays of a part, from where it was made. */
#define STAYS(arena, array)                                                                                            \
    is_there((array).data = copied(arena, (array).data, (array).size * (int64_t)sizeof *(array).data))

static bool keep_part(Arena *arena, Site *part) {
    Patch *patch = &part->patch;
    Fronts *fronts = &patch->fronts;
    return STAYS(arena, patch->vertices) && STAYS(arena, patch->offsets) && STAYS(arena, patch->neighbors)
        && STAYS(arena, patch->weights) && STAYS(arena, patch->diagonal) && STAYS(arena, fronts->rows)
        && STAYS(arena, fronts->steps) && STAYS(arena, fronts->owners) && STAYS(arena, fronts->firsts)
        && STAYS(arena, fronts->starts) && STAYS(arena, fronts->borders) && STAYS(arena, fronts->places)
        && STAYS(arena, fronts->sums) && STAYS(arena, part->springs) && STAYS(arena, part->stiffness)
        && STAYS(arena, part->starts) && STAYS(arena, part->outer) && STAYS(arena, part->around);
}

static bool find_part(Parts *parts, int64_t index, ConstDoubles weights, ConstInts rank, Ints place, Arena *scratch,
    Site *part) {
    Context *context = parts->context;
    int64_t size = parts->blocks->cores.data[index];
    *part = (Site){.work = -1, .first = parts->rows};
    if (!charge(context, block_work((double)size, (double)parts->blocks->edges.data[index], 0) - UNCODED_WORK, 0)
        || !order_patch(parts->graph, members_of(parts->blocks, index, size), scratch, &part->patch)
        || !hang_part(parts->graph, weights, rank, place, scratch, part)
        || !find_patch_fronts(context, scratch, &part->patch))
        return false;
    const Fronts *fronts = &part->patch.fronts;
    double factor = fronts->places.data[fronts->places.size - 1];
    part->memory = SITE_MEMORY + ROW_MEMORY * (double)size + 8 * factor;
    if (!reserve(context, part->memory, 0)
        || !charge(context, 2 * factor_work(fronts), 0) || !keep_part(parts->arena, part))
        return false;
    part->width = least(parts->header->coefficients, size);
    part->making = patch_memory(fronts, part->width);
    return factorize_patch(&part->patch, const_doubles(part->springs), TETHER, parts->arena, &part->factor);
}

bool find_parts(Parts *parts, ConstInts2 faces, ConstDoubles2 first_frame, Arena *scratch) {
    Context *context = parts->context;
    const Graph *graph = parts->graph;
    const Blocks *blocks = parts->blocks;
    Doubles weights;
    Ints rank, place;
    if (!zero_doubles(scratch, graph->neighbors.size, &weights) || !take_ints(scratch, graph->size, &rank)
        || !take_ints(scratch, graph->size, &place) || !TAKE_ZEROS(parts->arena, blocks->count, parts->part))
        return false;
    parts->count = blocks->count;
    if (!weigh_by_cotangents(graph->offsets, graph->neighbors, faces, first_frame, weights))
        return FAIL(context, NUMERIC, "the first frame is too large for weights of its edges");
    for (int64_t v = 0; v < graph->size; v++) place.data[v] = -1;
    for (int64_t i = 0; i < blocks->count; i++) {
        ConstInts core = members_of(blocks, i, blocks->cores.data[i]);
        for (int64_t r = 0; r < core.size; r++) rank.data[core.data[r]] = (int32_t)i;
    }
    for (int64_t i = 0; i < blocks->count; i++) {
        Site *part = parts->part + i;
        Mark mark = mark_of(scratch);
        bool found = find_part(parts, i, const_doubles(weights), const_ints(rank), place, scratch, part);
        release_to(scratch, mark);
        if (!found) return false;
        parts->rows += part->around.size + part->width;
        parts->around += (double)part->around.size;
        parts->largest = largest(parts->largest, part->patch.size);
        parts->making = parts->making > part->making ? parts->making : part->making;
    }
    return true;
}

static double dictionary_memory(const Site *part) { return 8.0 * (double)part->patch.size * (double)part->width; }

/* Those that are kept are always the first ones. */
static void drop_from(Parts *parts, int64_t count) {
    if (count < parts->count && parts->part[count].dictionary.rows > 0)
        release_to(&parts->dictionaries, parts->part[count].before);
    for (int64_t i = count; i < parts->count; i++) parts->part[i].dictionary.rows = 0;
}

void release_dictionaries(Parts *parts) {
    if (parts->part != NULL) drop_from(parts, 0);
    parts->context->spent.reserved -= parts->reserved;
    parts->reserved = parts->use = 0;
    parts->kept = 0;
}

/* Make room for what comes next and keep as many dictionaries as fit besides; `work` is that of making others. */
bool reserve_dictionaries(Parts *parts, double memory, double use, double *work) {
    Context *context = parts->context;
    double free_memory = memory_left(context), room = free_memory + parts->reserved - memory - use - SPARE_MEMORY,
           all = 0, held = 0;
    bool whole = true;
    int64_t count = 0;
    for (int64_t i = 0; i < parts->count; i++) {
        whole = whole && parts->part[i].dictionary.rows > 0;
        all += dictionary_memory(parts->part + i);
    }
    double making = whole && all <= room ? 0 : parts->making;
    if (!fits_memory(context, free_memory - room + making)) return false;
    while (count < parts->count && held + dictionary_memory(parts->part + count) <= room - making)
        held += dictionary_memory(parts->part + count++);
    if (!reserve(context, memory + held - parts->reserved, 0)) return false;
    parts->reserved = memory + held;
    parts->use = use;
    drop_from(parts, count);
    *work = 0;
    for (int64_t i = least(parts->kept, count); i < parts->count; i++)
        *work += parts->part[i].work > 0 ? parts->part[i].work : 0;
    parts->kept = count;
    return true;
}

bool lend_dictionary(Parts *parts, int64_t index, Arena *scratch, Singles2 *dictionary) {
    Context *context = parts->context;
    Site *part = parts->part + index;
    *dictionary = part->dictionary;
    if (part->dictionary.rows > 0) return true;
    if (!fits_memory(context, part->making + parts->use)) return false;
    bool stays = index < parts->kept;
    Mark mark = mark_of(scratch);
    double before = context->spent.spent;
    part->before = mark_of(&parts->dictionaries);
    context->prepaid = part->work >= 0; /* by who has reserved */
    bool made = take_singles2(stays ? &parts->dictionaries : scratch, part->patch.size, part->width, dictionary)
        && key_dictionary(context, parts->header, &part->patch, const_doubles(part->springs), NULL, scratch,
            *dictionary);
    if (part->work < 0 && made) part->work = context->spent.spent - before;
    context->prepaid = false;
    if (stays) release_to(scratch, mark);
    if (stays && made) part->dictionary = *dictionary;
    if (!made) release_to(&parts->dictionaries, part->before);
    return made;
}

bool extend_part(const Site *part, ConstDoubles2 ends, Arena *scratch, Doubles2 extension) {
    int64_t n = part->patch.size, m = ends.columns;
    Mark mark = mark_of(scratch);
    Doubles2 pulls;
    Singles room;
    bool done = take_doubles2(scratch, n, m, &pulls) && take_singles(scratch, solving_space(n, m), &room);
    if (done) {
        pull(const_ints(part->starts), const_ints(part->outer), const_doubles(part->stiffness), ends, pulls);
        continue_known(part->patch.fronts, part->factor.values, const_singles(part->factor.inverse),
            const_doubles(part->springs), const_doubles2(pulls), room, extension);
    }
    release_to(scratch, mark);
    return done;
}
