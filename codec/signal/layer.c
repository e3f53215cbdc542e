/* Levels that refine what blocks decoded to (specification, V 11, M 17). */
#include "codec/signal/decoding.h"

#include "codec/signal/signal.h"
#include "bitstream/costs.h"
#include "bitstream/payloads/payloads.h"

enum { AXES = 3, LEARNERS = 12, LEVEL_SLOTS_ALL = 2 * 5 * 512 * 32, LEVEL_SELECTORS = 2 * 32, LEVEL_INPUTS = 5,
    LEVEL_RATE = 16, BENT_BY = 2 };

bool begin_levels(Layer *layer, Context *context, LayerPlan plan, Arena *scratch) {
    int64_t n = plan.vertices;
    *layer = (Layer){.context = context, .plan = plan, .own = arena_of(context), .models = arena_of(context),
        .begun = true};
    Arena *models = &layer->models;
    Levels *levels = &layer->levels;
    if (!link_mesh(context, plan.faces, n, models, scratch, &layer->corners)
        || !make_bank(models, (BankPlan){.slots = LEVEL_SLOTS_ALL, .selectors = LEVEL_SELECTORS, .inputs = LEVEL_INPUTS,
            .rate = LEVEL_RATE}, &layer->bank)
        || !zero_ints2(&layer->own, n, AXES, &levels->levels) || !zero_ints2(models, n, AXES, &levels->gaps)
        || !zero_ints2(models, n, AXES, &levels->means) || !make_learners(models, LEARNERS, &levels->learners))
        return false;
    for (int k = 0; k < LEARNERS; k++) {
        start_learner(levels->learners, k, 0, 52000);
        if (k % 4 > 0) start_learner(levels->learners, k, 1, 28000);
    }
    return true;
}

void end_layer(Layer *layer) {
    release_all(&layer->own);
    release_all(&layer->models);
}

bool find_frames(Context *context, ConstInts2 faces, Arena *arena, Refined *refined) {
    int64_t n = refined->base.rows;
    double size = (double)n, m = (double)faces.rows;
    if (!reserve(context, layer_memory(size, m), 0) || !charge(context, layer_work(size, m, AXES), 0)
        || !WITHIN(context, field_bytes, layer_field_bytes(size, m))
        || !take_doubles2(arena, n, AXES * AXES, &refined->frames))
        return false;
    local_frames(const_doubles2(refined->base), faces, refined->frames);
    return true;
}

bool begin_layer(Layer *layer, Context *context, LayerPlan plan, Refined refined, Arena *arena, Arena *scratch) {
    int64_t n = plan.vertices;
    if (!layer->begun && !begin_levels(layer, context, plan, scratch)) return false;
    layer->refined = refined;
    if (!take_doubles2(arena, n, AXES, &layer->positions)) return false;
    memcpy(layer->positions.data, refined.base.data, (size_t)(n * AXES) * sizeof(double));
    return true;
}

/* Levels of some vertices, 0 for those that are not marked. */
static bool mark_levels(const Layer *layer, Bytes marked, int64_t first, int64_t count, Arena *scratch,
    ConstInts2 *levels) {
    *levels = (ConstInts2){layer->levels.levels.data + AXES * first, count, AXES};
    if (marked.size == 0) return true;
    Ints2 some;
    if (!zero_ints2(scratch, count, AXES, &some)) return false;
    for (int64_t v = 0; v < count; v++)
        if (marked.data[first + v]) memcpy(some.data + AXES * v, levels->data + AXES * v, AXES * sizeof(int32_t));
    *levels = const_ints2(some);
    return true;
}

bool fit_vertices(const Layer *layer, Arena *scratch, Bytes *fit) {
    *fit = layer->refined.whole;
    for (int round = 0; fit->size > 0 && round < BENT_BY; round++) {
        Bytes next;
        if (!take_bytes(scratch, fit->size, &next)) return false;
        memcpy(next.data, fit->data, (size_t)fit->size);
        for (int64_t f = 0; f < layer->plan.faces.rows; f++) {
            const int32_t *face = layer->plan.faces.data + 3 * f;
            if (!(fit->data[face[0]] && fit->data[face[1]] && fit->data[face[2]]))
                next.data[face[0]] = next.data[face[1]] = next.data[face[2]] = 0;
        }
        *fit = next;
    }
    return true;
}

/* Move vertices along the surface by steps that follow from all heights (M 17.4). */
static bool slide(Layer *layer, Arena *scratch) {
    int64_t n = layer->positions.rows;
    const LayerPlan *plan = &layer->plan;
    Doubles2 room, upright = layer->positions;
    Doubles steps;
    Bytes fit;
    ConstInts2 some;
    if (!take_doubles2(scratch, n, 8, &room) || !take_doubles(scratch, n, &steps)
        || !fit_vertices(layer, scratch, &fit) || !mark_levels(layer, fit, 0, n, scratch, &some))
        return false;
    if (fit.size > 0) { /* where the base is lost, heights moved no vertex */
        if (!take_doubles2(scratch, n, AXES, &upright)) return false;
        memcpy(upright.data, layer->refined.base.data, (size_t)(n * AXES) * sizeof(double));
        add_heights(upright, const_doubles2(layer->refined.frames), const_ints2(layer->levels.levels), plan->step);
    }
    tangent_steps(const_doubles2(upright), plan->faces, plan->step, plan->ratio, room, steps);
    add_slides(layer->positions, const_doubles2(layer->refined.frames), some, const_doubles(steps));
    return true;
}

bool code_layer(Layer *layer, int64_t first, int64_t count, Span payload) {
    Coding coding;
    return begin_coding(layer->context, payload, &coding)
        && check_chunk_done(&coding,
            code_levels(&coding.coder, &layer->bank, layer->corners, layer->levels, first, count), count);
}

bool decode_layer(Layer *layer, int64_t first, int64_t count, Span payload, Arena *scratch) {
    Context *context = layer->context;
    if (!charge(context, chunk_work((double)payload.size, 0), (double)payload.size)) return false;
    if (layer->coded == layer->positions.rows) return FAIL(context, CORRUPT, "levels follow the last vertex");
    if (first != layer->coded)
        return FAIL(context, CORRUPT, "the layer lacks the vertices before #: the rest is lost", first);
    if (first + count > layer->read && !code_layer(layer, first, count, payload)) return false;
    layer->coded += count;
    ConstInts2 some;
    if (!mark_levels(layer, layer->refined.whole, first, count, scratch, &some)) return false;
    ConstDoubles2 frames = const_doubles2(rows_from(layer->refined.frames, first, count));
    add_heights(rows_from(layer->positions, first, count), frames, some, layer->plan.step);
    if (layer->coded < layer->positions.rows) return true;
    release_all(&layer->models);
    return slide(layer, scratch);
}

bool close_layer(Layer *layer, Arena *arena, Arena *scratch) {
    int64_t n = layer->positions.rows;
    Bytes *whole = &layer->refined.whole;
    if (layer->coded == n) return true;
    if (whole->size == 0) {
        if (!take_bytes(arena, n, whole)) return false;
        memset(whole->data, 1, (size_t)n);
    }
    memset(whole->data + layer->coded, 0, (size_t)(n - layer->coded));
    layer->coded = n;
    layer->lossy = true;
    release_all(&layer->models);
    return slide(layer, scratch);
}
