/* Which vertices have moved since the caller last asked, which are final, and what a damaged stream has lost. */
#include "codec/blocks/blocks.h"
#include "codec/signal/signal.h"
#include "library/arithmetic.h"
#include "library/state.h"

/* Nanoseconds to look at an edge while rings are found, and to find rings at all. */
static const double LOOK = 18, CALL = 2e4;

/* Find the user's numbers of each coded vertex. */
static bool invert_numbering(Changes *changes, const Numbering *numbering, int64_t coded) {
    int64_t copies = numbering->source.size - numbering->loose.rows;
    if (changes->starts.size > 0 || numbering->source.size == 0) return true;
    Ints starts, members;
    if (!zero_ints(&changes->memory, coded + 1, &starts) || !take_ints(&changes->memory, copies, &members))
        return false;
    for (int64_t v = 0; v < numbering->source.size; v++)
        if (numbering->source.data[v] >= 0) starts.data[numbering->source.data[v]]++;
    int32_t end = 0;
    for (int64_t v = 0; v <= coded; v++) starts.data[v] = end += starts.data[v];
    for (int64_t v = numbering->source.size - 1; v >= 0; v--)
        if (numbering->source.data[v] >= 0) members.data[--starts.data[numbering->source.data[v]]] = (int32_t)v;
    changes->starts = starts;
    changes->members = members;
    return true;
}

static int64_t count_copies(const Changes *changes, ConstInts vertices) {
    int64_t count = 0;
    if (changes->starts.size == 0) return vertices.size;
    for (int64_t i = 0; i < vertices.size; i++) {
        const int32_t *start = changes->starts.data + vertices.data[i];
        count += start[1] - start[0];
    }
    return count;
}

/* Answer with coded vertices, all from row `final` on being final, as the user numbers them. */
static bool answer_with(bsmdec *decoder, ConstInts vertices, ConstDoubles2 positions, int64_t final,
    bsmdec_changes *answer) {
    Changes *changes = &decoder->changes;
    if (!invert_numbering(changes, &decoder->mesh.numbering, decoder->mesh.header.vertices)) return false;
    int64_t count = count_copies(changes, vertices), row = 0;
    Ints numbers;
    Doubles2 copies;
    Bytes marks;
    if (!take_ints(&changes->answer, count, &numbers) || !take_doubles2(&changes->answer, count, 3, &copies)
        || !take_bytes(&changes->answer, count, &marks))
        return false;
    for (int64_t i = 0; i < vertices.size; i++) {
        int32_t v = vertices.data[i];
        const int32_t *number = changes->starts.size > 0 ? changes->members.data + changes->starts.data[v] : &v;
        int64_t end = row + (changes->starts.size > 0 ? changes->starts.data[v + 1] - changes->starts.data[v] : 1);
        for (; row < end; row++) {
            numbers.data[row] = *number++;
            memcpy(copies.data + 3 * row, positions.data + 3 * i, 3 * sizeof(double));
            marks.data[row] = i >= final;
        }
    }
    *answer = (bsmdec_changes){count, numbers.data, copies.data, marks.data};
    return true;
}

static bool begin_watching(bsmdec *decoder) {
    const Mesh *mesh = &decoder->mesh;
    Changes *changes = &decoder->changes;
    Arena *memory = &changes->memory;
    int64_t n = mesh->graph.size;
    if (changes->begun) return true;
    if (!zero_ints(memory, n, &changes->missing) || !take_ints(memory, n, &changes->number)
        || !take_ints(memory, n, &changes->ringed) || !zero_bytes(memory, n, &changes->final)
        || !zero_bytes(memory, n, &changes->marks) || !zero_doubles2(memory, n, 3, &changes->blended))
        return false;
    for (int64_t i = 0; i < mesh->blocks.members.size; i++) changes->missing.data[mesh->blocks.members.data[i]]++;
    for (int64_t v = 0; v < n; v++) changes->number.data[v] = -1;
    return changes->begun = true;
}

/* Find `given` and all vertices at most `rings` edges away; they are numbered until `forget_rings`. */
static bool find(bsmdec *decoder, ConstInts given, int64_t rings, Longs *starts, int64_t *count) {
    const Graph *graph = &decoder->mesh.graph;
    Changes *changes = &decoder->changes;
    int64_t edges = 0;
    if (!take_longs(&changes->answer, rings + 1, starts)) return false;
    *count = find_rings(graph->offsets, graph->neighbors, changes->number, given, changes->ringed, *starts);
    for (int64_t i = 0; i < *count; i++) {
        const int32_t *offset = graph->offsets.data + changes->ringed.data[i];
        edges += offset[1] - offset[0];
    }
    changes->work += CALL + LOOK * (double)edges;
    return true;
}

static void forget_rings(const Changes *changes, int64_t count) {
    for (int64_t i = 0; i < count; i++) changes->number.data[changes->ringed.data[i]] = -1;
}

static bool find_around(bsmdec *decoder, ConstInts given, int64_t rings, Ints *found) {
    Changes *changes = &decoder->changes;
    Longs starts;
    int64_t count;
    if (!find(decoder, given, rings, &starts, &count)) return false;
    forget_rings(changes, count);
    if (!take_ints(&changes->answer, count, found)) return false;
    memcpy(found->data, changes->ringed.data, (size_t)count * sizeof *found->data);
    return true;
}

/* Find the vertices that the last copies of `complete` make final (M 12.4): smoothing misses no copy. */
static bool find_final(bsmdec *decoder, ConstInts complete, Ints *finished) {
    Changes *changes = &decoder->changes;
    Ints all, near, waiting;
    int64_t count = 0;
    if (!find_around(decoder, complete, 2 * (int64_t)DEGREE, &all) || !find_around(decoder, complete, DEGREE, &near))
        return false;
    for (int64_t i = 0; i < all.size; i++)
        if (changes->missing.data[all.data[i]] > 0) all.data[count++] = all.data[i];
    if (!find_around(decoder, (ConstInts){all.data, count}, DEGREE, &waiting)) return false;
    for (int64_t i = 0; i < waiting.size; i++) changes->marks.data[waiting.data[i]] = 1;
    *finished = (Ints){near.data, 0};
    for (int64_t i = 0; i < near.size; i++)
        if (!changes->final.data[near.data[i]] && !changes->marks.data[near.data[i]])
            near.data[finished->size++] = near.data[i];
    for (int64_t i = 0; i < waiting.size; i++) changes->marks.data[waiting.data[i]] = 0;
    return true;
}

/* Filter the positions of some vertices, in BSM units (M 12.2). */
static bool smooth_some(bsmdec *decoder, ConstInts vertices, Doubles2 smoothed) {
    const Graph *graph = &decoder->mesh.graph;
    Changes *changes = &decoder->changes;
    Longs starts;
    Doubles2 current, following;
    double powers[POWERS];
    int64_t count;
    if (!find(decoder, vertices, DEGREE, &starts, &count) || !take_doubles2(&changes->answer, count, 3, &current)
        || !take_doubles2(&changes->answer, starts.data[DEGREE - 1], 3, &following))
        return false;
    filter_polynomial(decoder->mesh.header.smoothing, powers);
    for (int64_t i = 0; i < count; i++) changes->number.data[changes->ringed.data[i]] = (int32_t)i;
    Rings rings = {const_ints(changes->number), {changes->ringed.data, count}, {starts.data, starts.size}};
    filter_rows(graph->offsets, graph->neighbors, rings, const_doubles2(changes->blended),
        (ConstDoubles){powers, POWERS}, current, following, smoothed);
    forget_rings(changes, count);
    return true;
}

/* List all vertices that are complete, and not final yet. */
static bool find_late(Changes *changes, Ints *found) {
    if (!take_ints(&changes->answer, changes->missing.size, found)) return false;
    found->size = 0;
    for (int64_t v = 0; v < changes->missing.size; v++)
        if (changes->missing.data[v] == 0 && !changes->final.data[v]) found->data[found->size++] = (int32_t)v;
    return true;
}

/* Find which vertices are final once some are complete. Answers may take as much work as decoding; what they find then
 * waits for the last block, so that the stream's own verdict is the same however often a host asks. */
static bool find_finished(bsmdec *decoder, Ints complete, Ints *finished) {
    Changes *changes = &decoder->changes;
    *finished = complete;
    if (!(decoder->mesh.header.smoothing > 0.0)) return true;
    bool over = decoder->mesh.next_block == decoder->mesh.header.blocks;
    if (!over && changes->work > granted_work(&decoder->context)) {
        finished->size = 0;
        return changes->late = true;
    }
    if (over && changes->late && !find_late(changes, &complete)) return false;
    return find_final(decoder, const_ints(complete), finished);
}

/* Blend the members of a block; list them, and those of which every copy has come. */
static void take_block(bsmdec *decoder, int64_t index, Ints *touched, Ints *complete) {
    const Mesh *mesh = &decoder->mesh;
    const Blended *blend = &mesh->assembly.blend;
    Changes *changes = &decoder->changes;
    ConstInts members = members_of(&mesh->blocks, index, size_of_block(&mesh->blocks, index));
    for (int64_t i = 0; i < members.size; i++) {
        int32_t v = members.data[i];
        for (int d = 0; d < 3; d++)
            changes->blended.data[3 * v + d] = blend->sums.data[3 * v + d] / blend->weights.data[v];
        if (--changes->missing.data[v] == 0) complete->data[complete->size++] = v;
        touched->data[touched->size++] = v;
    }
}

/* Vertices that moved, each once, in front of those that are final now. */
static bool list_changed(Changes *changes, ConstInts touched, ConstInts finished, Ints *listed) {
    Ints vertices;
    int64_t count = 0;
    if (!take_ints(&changes->answer, touched.size + finished.size, &vertices)) return false;
    for (int64_t i = 0; i < finished.size; i++) changes->final.data[finished.data[i]] = 1;
    for (int64_t i = 0; i < touched.size; i++) {
        int32_t v = touched.data[i];
        if (changes->final.data[v] || changes->marks.data[v]) continue;
        changes->marks.data[v] = 1;
        vertices.data[count++] = v;
    }
    for (int64_t i = 0; i < count; i++) changes->marks.data[vertices.data[i]] = 0;
    if (finished.size > 0) memcpy(vertices.data + count, finished.data, (size_t)finished.size * sizeof *finished.data);
    *listed = (Ints){vertices.data, count + finished.size};
    return true;
}

static bool read_blocks(bsmdec *decoder, bsmdec_changes *answer) {
    const Mesh *mesh = &decoder->mesh;
    Changes *changes = &decoder->changes;
    int64_t total = 0, first = changes->blocks;
    for (int64_t i = first; i < mesh->next_block; i++) total += size_of_block(&mesh->blocks, i);
    Ints touched, complete, finished, vertices;
    Doubles2 positions;
    if (!take_ints(&changes->answer, total, &touched) || !take_ints(&changes->answer, total, &complete)
        || !begin_watching(decoder))
        return false;
    touched.size = complete.size = 0;
    changes->blocks = mesh->next_block;
    for (int64_t i = first; i < mesh->next_block; i++)
        if (mesh->assembly.added.data[i]) take_block(decoder, i, &touched, &complete);
    if (!find_finished(decoder, complete, &finished)
        || !list_changed(changes, const_ints(touched), const_ints(finished), &vertices)
        || !take_doubles2(&changes->answer, vertices.size, 3, &positions))
        return false;
    int64_t moved = vertices.size - finished.size;
    for (int64_t i = 0; i < vertices.size; i++)
        memcpy(positions.data + 3 * i, changes->blended.data + 3 * vertices.data[i], 3 * sizeof(double));
    if (mesh->header.smoothing > 0.0 && finished.size > 0
        && !smooth_some(decoder, const_ints(finished), (Doubles2){positions.data + 3 * moved, finished.size, 3}))
        return false;
    bool lasting = mesh->header.gop_frames == 0; /* frames move them later */
    return into_unit(&decoder->context, &mesh->header, positions)
        && answer_with(decoder, const_ints(vertices), const_doubles2(positions), lasting ? moved : vertices.size,
            answer);
}

/* Cells that are there, spread to vertices: after the first block, twice as many each time, and the last. */
static bool read_cells(bsmdec *decoder, bsmdec_changes *answer) {
    const Mesh *mesh = &decoder->mesh;
    Changes *changes = &decoder->changes;
    bool over = mesh->next_block == mesh->header.blocks;
    int64_t count = 0, n = mesh->next_block < 2 * changes->blocks && !over ? 0 : mesh->graph.size;
    if (changes->blocks == mesh->next_block) n = 0;
    Ints vertices;
    Doubles2 positions = {NULL, 0, 3};
    if (!take_ints(&changes->answer, n, &vertices)) return false;
    for (int64_t v = 0; v < n; v++)
        if (is_placed(mesh, v)) vertices.data[count++] = (int32_t)v;
    vertices.size = count;
    if (n > 0 && !place_some(decoder, const_ints(vertices), &changes->answer, &positions)) return false;
    if (n > 0) changes->blocks = mesh->next_block;
    return into_unit(&decoder->context, &mesh->header, positions)
        && answer_with(decoder, const_ints(vertices), const_doubles2(positions), over ? 0 : count, answer);
}

static bool has_unread_blocks(const bsmdec *decoder) {
    const Mesh *mesh = &decoder->mesh;
    int64_t i = decoder->changes.blocks;
    while (i < mesh->next_block && !mesh->assembly.added.data[i]) i++;
    return i < mesh->next_block;
}

/* Vertices that refinement moved, or all that are known where changes of blocks before it were not read. */
static bool read_layer(bsmdec *decoder, bsmdec_changes *answer) {
    const Mesh *mesh = &decoder->mesh;
    const Layer *layer = &mesh->layer;
    Changes *changes = &decoder->changes;
    bool all = (has_base(mesh) && !changes->spread) || has_unread_blocks(decoder);
    int64_t end = all ? layer->positions.rows : layer->coded, count = 0;
    int64_t start = all || layer->coded == layer->positions.rows ? 0 : changes->reached;
    Bytes whole = layer->refined.whole;
    Ints vertices;
    Doubles2 positions;
    if (!take_ints(&changes->answer, end - start, &vertices)) return false;
    changes->blocks = mesh->header.blocks;
    changes->reached = layer->coded;
    changes->spread = true;
    for (int64_t v = start; v < end; v++) {
        bool known = all ? is_placed(mesh, v) : whole.size == 0 || whole.data[v];
        if (known) vertices.data[count++] = (int32_t)v;
    }
    vertices.size = count;
    if (!take_doubles2(&changes->answer, count, 3, &positions)) return false;
    for (int64_t i = 0; i < count; i++)
        memcpy(positions.data + 3 * i, layer->positions.data + 3 * vertices.data[i], 3 * sizeof(double));
    return into_unit(&decoder->context, &mesh->header, positions)
        && answer_with(decoder, const_ints(vertices), const_doubles2(positions), count, answer);
}

static bool read_grid(bsmdec *decoder, bsmdec_changes *answer) {
    const GridField *grid = &decoder->mesh.grid;
    Changes *changes = &decoder->changes;
    ConstInts vertices = {grid->order.data + changes->reached, grid->coded - changes->reached};
    Doubles2 positions;
    if (!take_doubles2(&changes->answer, vertices.size, 3, &positions)) return false;
    for (int64_t i = 0; i < vertices.size; i++)
        memcpy(positions.data + 3 * i, grid->positions.data + 3 * (int64_t)vertices.data[i], 3 * sizeof(double));
    changes->reached = grid->coded;
    return answer_with(decoder, vertices, const_doubles2(positions), 0, answer);
}

static bool can_answer(bsmdec *decoder, const void *answer) {
    if (decoder == NULL) return false;
    if (answer == NULL) return REFUSE(decoder, "the structure is NULL"), false;
    return decoder->mesh.announced || (REFUSE(decoder, "vertices are known after CONNECTIVITY"), false);
}

EXACTLY(bsmdec_status, bsmdec_read_changes, (bsmdec *decoder, bsmdec_changes *changes), (decoder, changes)) {
    if (!can_answer(decoder, changes)) return BSMDEC_MISUSED;
    if (failed(&decoder->context)) return decoder->context.error.status;
    const Mesh *mesh = &decoder->mesh;
    release_all(&decoder->changes.answer);
    bool done = mesh->has_grid ? read_grid(decoder, changes)
        : mesh->has_layer      ? read_layer(decoder, changes)
        : has_base(mesh)       ? read_cells(decoder, changes)
                               : read_blocks(decoder, changes);
    int64_t block = done || mesh->has_grid || mesh->has_layer ? -1 : mesh->next_block - 1;
    if (!done) locate(&decoder->context.error, decoder->reader.last_offset, decoder->reader.last_frame, block);
    return decoder->context.error.status;
}

bsmdec_status bsmdec_read_loose(bsmdec *decoder, bsmdec_changes *changes) {
    if (!can_answer(decoder, changes)) return BSMDEC_MISUSED;
    const Numbering *numbering = &decoder->mesh.numbering;
    Arena *answer = &decoder->changes.answer;
    release_all(answer);
    int64_t count = 0, size = numbering->source.size > 0 ? numbering->loose.rows : 0;
    Ints vertices;
    Bytes final;
    if (!take_ints(answer, size, &vertices) || !take_bytes(answer, size, &final)) return decoder->context.error.status;
    for (int64_t v = 0; v < numbering->source.size; v++)
        if (numbering->source.data[v] < 0) vertices.data[count++] = (int32_t)v;
    memset(final.data, 1, (size_t)size);
    *changes = (bsmdec_changes){size, vertices.data, numbering->loose.data, final.data};
    return BSMDEC_OK;
}

/* What is wrong with a coded vertex. */
enum { SOUND, MISSING, DEGRADED };

static bool judge_blocks(bsmdec *decoder, Bytes states) {
    const Mesh *mesh = &decoder->mesh;
    Arena *answer = &decoder->changes.answer;
    Bytes whole = {NULL, 0}, fit = {NULL, 0};
    int64_t n = mesh->graph.size;
    if (!mark_base(decoder, 0, answer, &whole)
        || (mesh->has_layer && mesh->layer.coded == n && !fit_vertices(&mesh->layer, answer, &fit)))
        return false;
    bool unrefined = (mesh->has_layer && mesh->layer.coded < n && (mesh->layer.coded > 0 || mesh->layer.lossy))
        || (mesh->has_cell_layer && mesh->cell_layer.coded < mesh->header.base.cells);
    for (int64_t v = 0; v < n; v++) {
        bool degraded = unrefined || (whole.size > 0 && !whole.data[v]) || (fit.size > 0 && !fit.data[v]);
        states.data[v] = !is_placed(mesh, v) ? MISSING : degraded ? DEGRADED : SOUND;
    }
    return true;
}

static int64_t list_states(const Numbering *numbering, ConstBytes states, int state, Ints vertices) {
    int64_t count = 0;
    for (int64_t v = 0; v < numbering->size; v++) {
        int64_t coded = numbering->source.size > 0 ? numbering->source.data[v] : v;
        if (coded >= 0 && states.data[coded] == state) vertices.data[count++] = (int32_t)v;
    }
    return count;
}

EXACTLY(bsmdec_status, bsmdec_read_losses, (bsmdec *decoder, bsmdec_losses *losses), (decoder, losses)) {
    if (!can_answer(decoder, losses)) return BSMDEC_MISUSED;
    const Mesh *mesh = &decoder->mesh;
    Context *context = &decoder->context;
    Arena *answer = &decoder->changes.answer;
    *losses = (bsmdec_losses){0, NULL, 0, NULL};
    if (failed(context)) return context->error.status;
    if (decoder->sequence.active || !(mesh->has_grid || mesh->has_chains)) return BSMDEC_OK;
    release_all(answer);
    Bytes states;
    Ints missing, degraded;
    if (!zero_bytes(answer, mesh->header.vertices, &states) || !take_ints(answer, mesh->numbering.size, &missing)
        || !take_ints(answer, mesh->numbering.size, &degraded))
        return context->error.status;
    for (int64_t i = mesh->has_grid ? mesh->grid.coded : states.size; i < states.size; i++)
        states.data[mesh->grid.order.data[i]] = MISSING;
    if (!mesh->has_grid && !judge_blocks(decoder, states)) return context->error.status;
    int64_t gone = list_states(&mesh->numbering, const_bytes(states), MISSING, missing);
    *losses = (bsmdec_losses){
        gone, missing.data, list_states(&mesh->numbering, const_bytes(states), DEGRADED, degraded), degraded.data};
    return BSMDEC_OK;
}

bsmdec_status bsmdec_read_values(bsmdec *decoder, int index, bsmdec_values *values) {
    const Attribute *attribute = started_attribute(decoder, index);
    if (attribute == NULL || !can_answer(decoder, values)) return BSMDEC_MISUSED;
    Context *context = &decoder->context;
    Arena *answer = &decoder->changes.answer;
    bsmdec_attribute shape = shape_of(decoder, attribute);
    release_all(answer);
    Longs coded;
    Ints rows;
    if (!take_longs(answer, shape.rows, &coded) || !take_ints(answer, shape.rows, &rows)
        || !given_rows(attribute, &decoder->mesh.numbering, answer, coded))
        return context->error.status;
    const Attributes *all = &decoder->mesh.attributes;
    rows.size = 0;
    for (int64_t i = 0; i < shape.rows && all->latest == attribute; i++)
        if (all->fresh.size == 0 || all->fresh.data[coded.data[i]]) rows.data[rows.size++] = (int32_t)i;
    size_t each = (size_t)shape.components * kind_size(shape.kind);
    char *copies;
    if (!TAKE(answer, rows.size * (int64_t)each, copies)) return context->error.status;
    for (int64_t i = 0; i < rows.size; i++)
        memcpy(copies + (size_t)i * each, (const char *)attribute->values + (size_t)coded.data[rows.data[i]] * each,
            each);
    *values = (bsmdec_values){shape, rows.size, rows.data, copies};
    return BSMDEC_OK;
}
