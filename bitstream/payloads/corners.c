/* What all fields of integers begin with: corners, orders, models (specification, V 1 to V 6). */
#include "bitstream/payloads/payloads.h"

enum { CONTEXT_ROWS = CONTEXTS * CONTEXT_SIZE, UNLEARNED_HIT = 1 << 28, SLOT_WEIGHT = 6000 };

static bool take_corners(ConstInts2 faces, int64_t vertices, Arena *arena, Corners *corners) {
    *corners = (Corners){.faces = faces};
    if (!take_ints(arena, vertices + 1, &corners->starts) || !take_ints(arena, 3 * faces.rows, &corners->corners)
        || !take_ints(arena, vertices, &corners->rank))
        return false;
    for (int64_t v = 0; v < vertices; v++) corners->rank.data[v] = (int32_t)v;
    return true;
}

bool gather_mesh(Context *context, ConstInts2 faces, int64_t vertices, Arena *arena, Corners *corners) {
    return take_corners(faces, vertices, arena, corners)
        && (gather_corners(*corners) == 0 || FAIL(context, LIMIT, "# faces are too many", faces.rows));
}

bool link_mesh(Context *context, ConstInts2 faces, int64_t vertices, Arena *arena, Arena *scratch, Corners *corners) {
    Mark mark = mark_of(scratch);
    Ints room;
    bool done = take_corners(faces, vertices, arena, corners) && take_ints(arena, 3 * faces.rows, &corners->opposite)
        && take_ints(scratch, 2 * vertices, &room);
    done = done && (link_corners(corners, room) == 0 || FAIL(context, LIMIT, "# faces are too many", faces.rows));
    release_to(scratch, mark);
    return done;
}

bool link_parts_of(Context *context, const Corners *whole, ConstInts2 faces, int64_t vertices, Arena *arena,
    Arena *scratch, Corners *corners) {
    if (whole->crowded) return link_mesh(context, faces, vertices, arena, scratch, corners);
    return take_corners(faces, vertices, arena, corners) && take_ints(arena, 3 * faces.rows, &corners->opposite)
        && (link_parts(corners, whole) == 0 || FAIL(context, LIMIT, "# faces are too many", faces.rows));
}

bool order_mesh(Corners *corners, Arena *arena, Arena *scratch, Ints *order) {
    int64_t vertices = corners->rank.size;
    Mark mark = mark_of(scratch);
    Ints2 room;
    bool done = take_ints(arena, vertices, order) && take_ints2(scratch, 3, vertices, &room);
    if (done) order_vertices(*corners, *order, room);
    release_to(scratch, mark);
    return done;
}

bool make_value_model(Arena *arena, ValueModel *model, bool of_twins) {
    if (!take_words(arena, CONTEXT_ROWS * VALUE_NODES, &model->slots)
        || !TAKE_ZEROS(arena, CONTEXT_ROWS, model->begun) || !take_words(arena, HIT_CONTEXTS * MODEL_ROW, &model->hits)
        || !zero_ints2(arena, VALUE_NODES + WEIGHT_SETS * KINDS, WEIGHT_ROW, &model->weights)
        || !zero_ints2(arena, SCALE_CONTEXTS, MODEL_ROW, &model->scales)
        || (of_twins && !zero_ints2(arena, TWIN_ROWS, TWIN_ROW, &model->twins)))
        return false;
    for (int64_t i = 0; i < model->hits.size; i++) model->hits.data[i] = UNLEARNED_HIT;
    for (int row = 0; row < VALUE_NODES; row++) {
        int32_t *weight = model->weights.data + row * WEIGHT_ROW;
        for (int i = 0; i < PREDICTIONS; i++) weight[i] = ONE * 9 / (8 * PREDICTIONS);
        for (int i = CONSTANT_INPUT + 1; i < VALUE_INPUTS; i++) weight[i] = SLOT_WEIGHT;
    }
    return true;
}

bool make_learners(Arena *arena, int64_t count, Longs2 *learners) {
    return zero_longs2(arena, count, LEARNER_COLUMNS, learners);
}

bool check_chunk_done(Coding *coding, int64_t done, int64_t count) {
    if (overran(&coding->coder) || done < count) return nonsense(coding, "a value is out of its range");
    return finish_coding(coding);
}
