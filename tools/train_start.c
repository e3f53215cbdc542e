/* Where models of congruent grids end: `train_start START STREAM...` codes the grid of each stream again from a start,
 * and writes to the standard output, for each, the state at the end: weights, weights of learners, hit slots, weights
 * of whole vertices; then the bytes of the payload, all as 32-bit integers. Streams without such a grid are left out.
 */
#include <stdio.h>
#include <stdlib.h>

#include "bsm.c"

enum { WEIGHTS = START_ROWS * WEIGHT_ROW, LEARNT = START_LEARNERS * MOST_TERMS };
typedef struct { int32_t weight[WEIGHTS], learner[LEARNT], hit[TWIN_ROWS], whole[WHOLE_ROWS * WHOLE_CONTEXTS]; } State;
static Payload written = {.capacity = 1 << 26};

static void code(bsmdec *decoder, const State *start) {
    Context *context = &decoder->context;
    GridField *source = &decoder->mesh.grid, grid;
    const Header *header = &decoder->mesh.header;
    Arena arena = arena_of(context), scratch = arena_of(context);
    State end;
    if (!begin_grid(&grid, NULL, context, header, source->faces, &arena, &scratch)) abort();
    memcpy(grid.values.data, source->values.data, (size_t)(3 * header->vertices) * sizeof(int32_t));
    memcpy(grid.transforms.data, source->transforms.data,
        (size_t)(source->transforms.rows * TRANSFORM_ROW) * sizeof(int32_t));
    memcpy(grid.model.weights.data, start->weight, sizeof start->weight);
    Learner *learner = (Learner *)grid.grid.learners.data;
    for (int i = 0; i < LEARNT; i++)
        start_learner(grid.grid.learners, i / MOST_TERMS, i % MOST_TERMS, start->learner[i]);
    for (int i = 0; i < TWIN_ROWS; i++) grid.model.twins.data[TWIN_ROW * i + 2] = start->hit[i];
    memcpy(grid.twins->whole_weight, start->whole, sizeof start->whole);
    context->writing = &written;
    written.size = 0;
    if (!code_grid_values(&grid, 0, header->vertices, (Span){0})) abort();
    context->writing = NULL;
    memcpy(end.weight, grid.model.weights.data, sizeof end.weight);
    for (int i = 0; i < LEARNT; i++) end.learner[i] = (int32_t)learner[i / MOST_TERMS].weight[i % MOST_TERMS];
    for (int i = 0; i < TWIN_ROWS; i++) end.hit[i] = grid.model.twins.data[TWIN_ROW * i + 2];
    memcpy(end.whole, grid.twins->whole_weight, sizeof end.whole);
    int32_t size = (int32_t)written.size;
    fwrite(&end, sizeof end, 1, stdout);
    fwrite(&size, sizeof size, 1, stdout);
    release_all(&arena);
    release_all(&scratch);
}

int main(int count, char **names) {
    static State start;
    static char stream[1 << 24];
    written.data = malloc((size_t)written.capacity);
    FILE *file = fopen(names[1], "rb");
    if (fread(&start, sizeof start, 1, file) != 1) abort();
    fclose(file);
    for (int i = 2; i < count; i++) {
        file = fopen(names[i], "rb");
        size_t size = fread(stream, 1, sizeof stream, file);
        fclose(file);
        bsmdec_options options = {.size = sizeof options};
        bsmdec *decoder = bsmdec_open(&options);
        bsmdec_event event;
        bsmdec_push(decoder, stream, size);
        bsmdec_finish(decoder);
        do bsmdec_next(decoder, &event);
        while (event.type != BSMDEC_END && event.type != BSMDEC_ERROR && event.type != BSMDEC_NEED_DATA);
        if (event.type == BSMDEC_END && decoder->mesh.has_grid && is_congruent(&decoder->mesh.header))
            code(decoder, &start);
        bsmdec_close(decoder);
    }
    return 0;
}
