/* One decoder for a page: what changes with each block, chains that other threads decode, and the header's numbers. */
#include "engine/wasm/page.h"

#include "codec/blocks/blocks.h"
#include "codec/signal/signal.h"
#include "engine/decoder.h"

#define EXPORT __attribute__((visibility("default")))

/* Nanoseconds for looking at an edge while rings are found, for finding them at all, and for telling of a vertex. */
static const double LOOK = 18, CALL = 2e4, COPY = 90;

/* What a page is given: rows of numbers in this memory. */
typedef struct {
    int32_t count;
    const void *vertices, *positions, *more;
} Rows;

static bsmdec *decoder;
static bsmdec_event event;
static Rows rows;
static double numbers[48];
/* What is remembered of the present mesh, to tell what changes; what is told, until the next event. */
static Arena watched, told;
static Ints missing, number, ringed;
static Bytes final, waits;
static Doubles2 blended;
static int64_t reached;

static void *allocate(void *host, size_t size) {
    (void)host;
    return page_take(size);
}

static void release(void *host, void *memory, size_t size) {
    (void)host;
    page_give(memory, size);
}

static void forget_mesh(void) {
    release_all(&told);
    release_all(&watched);
    missing.data = NULL;
    reached = 0;
}

/* `limits`: those of bsmdec.h in their order. Chains are shared by `among`, of whom this is `number`. */
EXPORT bool page_open(const double *limits, int tolerant, int number_of_share, int among) {
    static bool made;
    if (!made) {
        make_tables();
        make_value_tables();
        make_priors();
        made = true;
    }
    bsmdec_allocator host = {allocate, release, NULL};
    decoder = bsmdec_open(&(bsmdec_options){.limits = (const bsmdec_limits *)limits, .allocator = &host, .tolerant = tolerant});
    if (decoder == NULL) return false;
    decoder->share = (Share){.number = number_of_share, .among = among, .helps = number_of_share > 0};
    watched = told = arena_of(&decoder->context);
    missing.data = NULL;
    reached = 0;
    return true;
}

EXPORT void page_close(void) {
    forget_mesh();
    bsmdec_close(decoder);
}

EXPORT void page_share(int among) { decoder->share.among = among; }

EXPORT int page_push(const void *bytes, size_t size) { return bsmdec_push(decoder, bytes, size); }

EXPORT void page_finish(void) { bsmdec_finish(decoder); }

EXPORT const bsmdec_event *page_next(void) {
    release_all(&told);
    if (bsmdec_next(decoder, &event) == BSMDEC_OK && event.type == BSMDEC_HEADER) forget_mesh();
    return &event;
}

EXPORT const bsmdec_error *page_error(int of_loss) { return of_loss ? bsmdec_last_loss(decoder) : bsmdec_last_error(decoder); }

/* Bytes that were made use of, work that was charged, vertices that the faces so far have. */
EXPORT const double *page_state(void) {
    numbers[0] = (double)decoder->reader.offset;
    numbers[1] = decoder->context.spent.spent;
    numbers[2] = (double)decoder->context.spent.vertices;
    return numbers;
}

EXPORT const double *page_header(void) {
    const Header *h = &decoder->reader.headers[decoder->reader.header];
    const double all[] = {
        (double)h->vertices, (double)h->faces, (double)h->blocks, (double)h->block_size, (double)h->coefficients, (double)h->key_interval,
        h->step, h->scale, h->smoothing, (double)h->attributes, h->light, (double)h->frames, (double)h->gop_frames, (double)h->run,
        (double)h->again, h->center[0], h->center[1], h->center[2], h->refined, h->refinement[0], h->refinement[1], h->on_grid,
        h->grid[0], h->grid[1], h->grid[2], (double)h->cells, (double)h->points, h->counted, (double)h->corner[0], (double)h->corner[1],
        (double)h->corner[2], h->paper.bits, h->paper.coarser, h->paper.exact, h->paper.power, h->paper.iterations,
        h->paper.key_iterations, h->paper.shift, h->paper.springs,
    };
    memcpy(numbers, all, sizeof all);
    return numbers;
}

static const Rows *row_of(int64_t count, const void *vertices, const void *positions, const void *more) {
    rows = (Rows){(int32_t)count, vertices, positions, more};
    return &rows;
}

/* How the user numbers vertices: what each was coded as, positions of those that no face uses, and how many were coded. */
EXPORT const Rows *page_numbering(void) {
    const Numbering *numbering = &decoder->mesh.numbering;
    numbers[0] = (double)decoder->mesh.header.vertices;
    return row_of(numbering->source.size, numbering->source.data, numbering->loose.data, numbers);
}

EXPORT int page_faces(uint32_t *corners, size_t count) { return bsmdec_faces(decoder, corners, count); }
EXPORT int page_positions(double *coordinates, size_t count) { return bsmdec_positions(decoder, coordinates, count); }
EXPORT int page_metadata(int index, bsmdec_metadata *entry) { return bsmdec_metadata_at(decoder, index, entry); }
EXPORT int page_attribute(int index, bsmdec_attribute *attribute) { return bsmdec_attribute_at(decoder, index, attribute); }
EXPORT int page_values(int index, void *values, size_t size) { return bsmdec_attribute_values(decoder, index, values, size); }
EXPORT int page_indices(int index, uint32_t *indices, size_t count) { return bsmdec_attribute_indices(decoder, index, indices, count); }

/* The block that a helper decoded last. */
EXPORT const Rows *page_handed(void) {
    const DecodedBlock *block = &decoder->share.handed;
    return row_of(block->vertices.size, block->vertices.data, block->positions.data, block->weights.data);
}

/* Room for a block that a helper decoded; `page_add` adds it. */
EXPORT const Rows *page_room(int count) {
    Ints vertices = take_ints(&told, count);
    Doubles2 positions = take_doubles2(&told, count, 3);
    Doubles weights = take_doubles(&told, count);
    return failed(&decoder->context) ? NULL : row_of(count, vertices.data, positions.data, weights.data);
}

EXPORT bool page_add(int index) {
    const Mesh *mesh = &decoder->mesh;
    const int32_t *vertices = rows.vertices;
    if (!mesh->has_chains || index < 0 || index >= mesh->blocks.count || rows.count != size_of_block(&mesh->blocks, index)) return false;
    for (int32_t i = 0; i < rows.count; i++)
        if (vertices[i] < 0 || vertices[i] >= mesh->graph.size) return false;
    DecodedBlock block = {index, {vertices, rows.count}, {rows.positions, rows.count, 3}, {rows.more, rows.count}};
    add_block(&decoder->mesh.assembly, &block);
    return true;
}

/* A block that a helper could not decode: whether that is borne. */
EXPORT bool page_lose(int index) {
    lose_block(&decoder->mesh.assembly, &decoder->mesh.blocks, index);
    return decoder->tolerant && decoder->mesh.header.gop_frames == 0;
}

static bool begin_watching(void) {
    const Mesh *mesh = &decoder->mesh;
    int64_t n = mesh->graph.size;
    if (missing.data != NULL) return true;
    Ints counts = zero_ints(&watched, n);
    number = take_ints(&watched, n);
    ringed = take_ints(&watched, n);
    final = zero_bytes(&watched, n);
    waits = zero_bytes(&watched, n);
    blended = zero_doubles2(&watched, n, 3);
    if (failed(&decoder->context)) return false;
    for (int64_t i = 0; i < mesh->blocks.members.size; i++) counts.data[mesh->blocks.members.data[i]]++;
    for (int64_t v = 0; v < n; v++) number.data[v] = -1;
    missing = counts;
    return true;
}

/* `given` and all others at most `starts` - 1 edges away; they are numbered until `forget_rings`. */
static int64_t find(ConstInts given, Longs starts) {
    const Graph *graph = &decoder->mesh.graph;
    int64_t edges = 0, count = find_rings(graph->offsets, graph->neighbours, number, given, ringed, starts);
    for (int64_t i = 0; i < count; i++) edges += graph->offsets.data[ringed.data[i] + 1] - graph->offsets.data[ringed.data[i]];
    spend(&decoder->context, CALL + LOOK * (double)edges, 0);
    return count;
}

static void forget_rings(int64_t count) {
    for (int64_t i = 0; i < count; i++) number.data[ringed.data[i]] = -1;
}

static Ints around(ConstInts given, int64_t rings) {
    Longs starts = take_longs(&told, rings + 1);
    if (failed(&decoder->context)) return (Ints){NULL, 0};
    int64_t count = find(given, starts);
    forget_rings(count);
    Ints found = take_ints(&told, count);
    if (failed(&decoder->context)) return (Ints){NULL, 0};
    memcpy(found.data, ringed.data, (size_t)count * sizeof *found.data);
    return found;
}

/* Of those that are complete and what lies around them, what becomes final (M 12.4), in `finished`. */
static void find_final(ConstInts complete, Ints *finished) {
    Ints all = around(complete, 2 * (int64_t)DEGREE), near = around(complete, DEGREE);
    int64_t count = 0;
    for (int64_t i = 0; i < all.size; i++)
        if (missing.data[all.data[i]] > 0) all.data[count++] = all.data[i];
    Ints waiting = around((ConstInts){all.data, count}, DEGREE);
    for (int64_t i = 0; i < waiting.size; i++) waits.data[waiting.data[i]] = 1;
    *finished = (Ints){near.data, 0};
    for (int64_t i = 0; i < near.size; i++)
        if (!final.data[near.data[i]] && !waits.data[near.data[i]]) near.data[finished->size++] = near.data[i];
    for (int64_t i = 0; i < waiting.size; i++) waits.data[waiting.data[i]] = 0;
}

/* Filtered positions of some vertices, in BSM units (M 12.2). */
static void smooth_some(ConstInts vertices, Doubles2 smoothed) {
    const Graph *graph = &decoder->mesh.graph;
    Longs starts = take_longs(&told, DEGREE + 1);
    double powers[POWERS];
    if (failed(&decoder->context)) return;
    int64_t count = find(vertices, starts);
    Doubles2 current = take_doubles2(&told, count, 3), following = take_doubles2(&told, starts.data[DEGREE - 1], 3);
    filter_polynomial(decoder->mesh.header.smoothing, powers);
    for (int64_t i = 0; i < count; i++) number.data[ringed.data[i]] = (int32_t)i;
    if (fine(&decoder->context))
        filter_rows(graph->offsets, graph->neighbours, const_ints(number), const_doubles2(blended), (ConstDoubles){powers, POWERS},
            (ConstInts){ringed.data, count}, (ConstLongs){starts.data, starts.size}, current, following, smoothed);
    forget_rings(count);
}

/* What a block changed: vertices that moved, then those that are final now. */
static const Rows *changes_of_block(int64_t index) {
    const Mesh *mesh = &decoder->mesh;
    const Blended *blend = &mesh->assembly.blend;
    Context *context = &decoder->context;
    int64_t n = size_of_block(&mesh->blocks, index), count = 0;
    ConstInts members = members_of(&mesh->blocks, index, n);
    Ints complete = take_ints(&told, n), finished = complete;
    if (!begin_watching() || failed(context)) return NULL;
    for (int64_t i = 0; i < n; i++) {
        int32_t v = members.data[i];
        for (int d = 0; d < 3; d++) blended.data[3 * v + d] = blend->sums.data[3 * v + d] / blend->weights.data[v];
        if (--missing.data[v] == 0) complete.data[count++] = v;
    }
    finished.size = count;
    if (mesh->header.smoothing > 0.0) find_final((ConstInts){complete.data, count}, &finished);
    for (int64_t i = 0; i < finished.size && fine(context); i++) final.data[finished.data[i]] = 1;
    Ints vertices = take_ints(&told, n + finished.size);
    Doubles2 positions = take_doubles2(&told, n + finished.size, 3);
    Bytes marks = zero_bytes(&told, n + finished.size);
    if (failed(context)) return NULL;
    int64_t moved = 0;
    for (int64_t i = 0; i < n; i++)
        if (!final.data[members.data[i]]) vertices.data[moved++] = members.data[i];
    for (int64_t i = 0; i < finished.size; i++) vertices.data[moved + i] = finished.data[i];
    positions.rows = moved + finished.size;
    bool lasting = !mesh->header.refined && mesh->header.gop_frames == 0; /* else levels or frames move it later */
    for (int64_t i = 0; i < positions.rows; i++) {
        memcpy(positions.data + 3 * i, blended.data + 3 * vertices.data[i], 3 * sizeof(double));
        marks.data[i] = lasting && i >= moved;
    }
    if (mesh->header.smoothing > 0.0 && finished.size > 0)
        smooth_some((ConstInts){vertices.data + moved, finished.size}, (Doubles2){positions.data + 3 * moved, finished.size, 3});
    if (failed(context) || !spend(context, COPY * (double)positions.rows, 0) || !into_unit(context, &mesh->header, positions)) return NULL;
    return row_of(positions.rows, vertices.data, positions.data, marks.data);
}

/* The same of vertices whose positions lie row by row. */
static const Rows *changes_of(ConstInts vertices, ConstDoubles2 all, bool in_unit, bool lasting) {
    Doubles2 positions = take_doubles2(&told, vertices.size, 3);
    Bytes marks = take_bytes(&told, vertices.size);
    if (failed(&decoder->context)) return NULL;
    for (int64_t i = 0; i < vertices.size; i++) {
        memcpy(positions.data + 3 * i, all.data + 3 * vertices.data[i], 3 * sizeof(double));
        marks.data[i] = lasting;
    }
    if (!in_unit && !into_unit(&decoder->context, &decoder->mesh.header, positions)) return NULL;
    return row_of(vertices.size, vertices.data, positions.data, marks.data);
}

static const Rows *changes_of_layer(const Layer *layer, int64_t first) {
    int64_t start = layer->coded == layer->positions.rows ? 0 : first, count = 0;
    Ints vertices = take_ints(&told, layer->coded - start);
    for (int64_t v = start; v < layer->coded && fine(&decoder->context); v++)
        if (layer->whole.size == 0 || layer->whole.data[v]) vertices.data[count++] = (int32_t)v;
    return failed(&decoder->context) ? NULL : changes_of((ConstInts){vertices.data, count}, const_doubles2(layer->positions), false, false);
}

/* What the event changed; NULL, and there is an error, where that cannot be told. */
EXPORT const Rows *page_changes(void) {
    const Mesh *mesh = &decoder->mesh;
    const Rows *changed;
    int64_t first = reached;
    if (event.type == BSMDEC_REFINEMENT || mesh->has_grid) reached = mesh->has_grid ? mesh->grid.coded : mesh->layer.coded;
    if (event.type == BSMDEC_REFINEMENT) changed = changes_of_layer(&mesh->layer, first);
    else if (mesh->has_grid) changed = changes_of((ConstInts){mesh->grid.order.data + first, reached - first}, const_doubles2(mesh->grid.positions), true, true);
    else changed = changes_of_block(event.index);
    if (changed == NULL) locate(&decoder->context.error, decoder->reader.offset, decoder->reader.frames, event.type == BSMDEC_BLOCK && !mesh->has_grid ? event.index : -1);
    return changed;
}

/* At the end of a tolerant decoder: vertices without a position, and those that are less good than they were encoded. */
EXPORT const Rows *page_losses(void) {
    const Mesh *mesh = &decoder->mesh;
    if (mesh->has_grid) {
        int64_t coded = mesh->grid.coded;
        return row_of(mesh->header.vertices - coded, mesh->grid.order.data + coded, NULL, NULL);
    }
    if (decoder->sequence.is_one || !mesh->has_chains) return row_of(0, NULL, NULL, NULL);
    int64_t n = mesh->graph.size, gone = 0, worse = 0;
    Bytes whole = {NULL, 0}, fit = {NULL, 0};
    Ints lost = take_ints(&told, n), degraded = take_ints(&told, n + 1);
    if (failed(&decoder->context) || !mark_whole(&mesh->assembly, &mesh->header, &mesh->graph, &told, &decoder->scratch, 0, &whole)) return NULL;
    if (mesh->has_layer && mesh->layer.coded == n) fit = fit_vertices(&mesh->layer, &told);
    bool unrefined = mesh->has_layer && mesh->layer.coded > 0 && mesh->layer.coded < n;
    for (int64_t v = 0; v < n; v++) {
        if (!(mesh->assembly.blend.weights.data[v] > 0.0)) lost.data[gone++] = (int32_t)v;
        else if (unrefined || (whole.size > 0 && !whole.data[v]) || (fit.size > 0 && !fit.data[v])) degraded.data[1 + worse++] = (int32_t)v;
    }
    degraded.data[0] = (int32_t)worse;
    return row_of(gone, lost.data, degraded.data, NULL);
}
