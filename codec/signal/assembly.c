#include "codec/signal/decoding.h"

#include "codec/blocks/blocks.h"
#include "codec/signal/signal.h"

bool begin_assembly(Assembly *assembly, int64_t vertices, int64_t blocks, Arena *arena) {
    assembly->lossy = false;
    return zero_doubles2(arena, vertices, 3, &assembly->blend.sums)
        && zero_doubles(arena, vertices, &assembly->blend.weights) && zero_bytes(arena, vertices, &assembly->lost)
        && zero_bytes(arena, blocks, &assembly->added);
}

void add_block(Assembly *assembly, const DecodedBlock *block) {
    add_copies(assembly->blend.sums, assembly->blend.weights, block->vertices, block->positions, block->weights);
    assembly->added.data[block->index] = 1;
}

void lose_block(Assembly *assembly, const Blocks *blocks, int64_t index) {
    ConstInts members = members_of(blocks, index, size_of_block(blocks, index));
    for (int64_t i = 0; i < members.size; i++) assembly->lost.data[members.data[i]] = 1;
    assembly->lossy = true;
}

bool blend_all(const Assembly *assembly, const Header *header, const Graph *graph, Arena *arena, Arena *scratch,
    Doubles2 *positions) {
    int64_t n = graph->size;
    Mark mark = mark_of(scratch);
    bool smoothing = header->smoothing > 0.0, done = take_doubles2(arena, n, 3, positions);
    Doubles2 blended = *positions;
    Doubles room = {NULL, 0};
    if (smoothing) done = done && take_doubles2(scratch, n, 3, &blended) && take_doubles(scratch, 6 * n + 2, &room);
    if (done) {
        for (int64_t i = 0; i < 3 * n; i++) {
            double weight = assembly->blend.weights.data[i / 3];
            blended.data[i] = weight > 0.0 ? assembly->blend.sums.data[i] / weight : 0.0;
        }
        if (smoothing)
            smooth_all(graph->offsets, graph->neighbors, const_doubles2(blended), header->smoothing, room, *positions);
    }
    release_to(scratch, mark);
    return done;
}

bool spread_marks(const Graph *graph, Bytes marks, int rings, Arena *scratch) {
    Bytes before;
    if (!take_bytes(scratch, marks.size, &before)) return false;
    for (; rings > 0; rings--) {
        memcpy(before.data, marks.data, (size_t)marks.size);
        for (int64_t v = 0; v < graph->size; v++)
            for (int64_t i = graph->offsets.data[v]; i < graph->offsets.data[v + 1]; i++)
                marks.data[v] |= before.data[graph->neighbors.data[i]];
    }
    return true;
}

bool mark_whole(const Assembly *assembly, const Header *header, const Graph *graph, Arena *arena, Arena *scratch,
    int beyond, Bytes *whole) {
    *whole = (Bytes){NULL, 0};
    if (!assembly->lossy) return true;
    Mark mark = mark_of(scratch);
    bool done = take_bytes(arena, graph->size, whole);
    if (done) {
        memcpy(whole->data, assembly->lost.data, (size_t)graph->size);
        done = spread_marks(graph, *whole, (header->smoothing > 0.0 ? DEGREE : 0) + beyond, scratch);
        for (int64_t v = 0; v < graph->size; v++) whole->data[v] = !whole->data[v];
    }
    release_to(scratch, mark);
    return done;
}

bool prolong_cells(const CellMesh *cells, const Graph *graph, ConstDoubles2 places, int rounds, Arena *arena,
    Arena *scratch, Doubles2 *positions) {
    int64_t n = graph->size;
    Mark mark = mark_of(scratch);
    Singles room;
    bool done = take_doubles2(arena, n, 3, positions) && take_singles(scratch, 8 * n, &room);
    if (done) prolong(graph->offsets, graph->neighbors, cells->own, places, rounds, room, *positions);
    release_to(scratch, mark);
    return done;
}

bool prolong_some(const CellMesh *cells, const Graph *graph, ConstDoubles2 places, int rounds, ConstInts vertices,
    Arena *arena, Arena *scratch, Doubles2 *positions) {
    int64_t n = graph->size;
    Mark mark = mark_of(scratch);
    Singles room;
    Ints number, rows;
    Longs ends;
    bool done = take_doubles2(arena, vertices.size, 3, positions) && take_singles(scratch, 8 * n, &room)
        && take_ints(scratch, n, &number) && take_ints(scratch, n, &rows) && take_longs(scratch, rounds + 1, &ends);
    if (done) {
        memset(number.data, -1, (size_t)n * sizeof *number.data);
        rows.size = find_rings(graph->offsets, graph->neighbors, number, vertices, rows, ends);
        const FourSingles *found = prolong_rows(graph->offsets, graph->neighbors, cells->own, places, rounds,
            const_ints(rows), (ConstLongs){ends.data, ends.size}, room);
        for (int64_t i = 0; i < vertices.size; i++)
            for (int d = 0; d < 3; d++) positions->data[3 * i + d] = (double)found[vertices.data[i]][d];
    }
    release_to(scratch, mark);
    return done;
}

bool mark_prolonged(const CellMesh *cells, const Graph *graph, ConstBytes marked, int rings, Arena *arena,
    Arena *scratch, Bytes *whole) {
    *whole = (Bytes){NULL, 0};
    if (marked.size == 0) return true;
    Mark mark = mark_of(scratch);
    bool done = take_bytes(arena, graph->size, whole);
    for (int64_t v = 0; done && v < graph->size; v++) whole->data[v] = !marked.data[cells->own.data[v]];
    done = done && spread_marks(graph, *whole, rings, scratch);
    for (int64_t v = 0; done && v < graph->size; v++) whole->data[v] = !whole->data[v];
    release_to(scratch, mark);
    return done;
}

/* Breadth-first from all cells whose places are known. */
bool fill_unknown(const Graph *graph, ConstDoubles weights, Arena *scratch, Doubles2 places) {
    int64_t end = 0;
    Ints waiting;
    Bytes known;
    Mark mark = mark_of(scratch);
    bool done = take_ints(scratch, graph->size, &waiting) && take_bytes(scratch, graph->size, &known);
    for (int64_t c = 0; done && c < graph->size; c++) {
        known.data[c] = weights.data[c] > 0.0;
        waiting.data[end] = (int32_t)c;
        end += known.data[c];
    }
    for (int64_t head = 0; end < graph->size && head < end; head++) {
        int32_t c = waiting.data[head];
        for (int32_t i = graph->offsets.data[c]; i < graph->offsets.data[c + 1]; i++) {
            int32_t other = graph->neighbors.data[i];
            if (known.data[other]) continue;
            known.data[other] = 1;
            memcpy(places.data + 3 * (int64_t)other, places.data + 3 * (int64_t)c, 3 * sizeof(double));
            waiting.data[end++] = other;
        }
    }
    release_to(scratch, mark);
    return done;
}

bool into_unit(Context *context, const Header *header, Doubles2 positions) {
    double scale = header->scale, spoiled[3] = {0.0}; /* infinity minus itself is not a number */
    for (int64_t v = 0; v < positions.rows; v++)
        for (int d = 0; d < 3; d++) {
            double *place = positions.data + 3 * v + d;
            *place = *place * scale + header->center[d];
            spoiled[d] += *place - *place;
        }
    return spoiled[0] + spoiled[1] + spoiled[2] == 0.0
        || FAIL(context, NUMERIC, "positions are not finite in the unit of the mesh");
}
