/* Places of cells, spread to the vertices of a mesh by smoothing (specification, M 18.7). */
#include "codec/signal/decoding.h"

#include "codec/geometry/geometry.h"
#include "codec/signal/signal.h"

/* x becomes half of itself and half of the mean of its neighbors. */
KERNEL OFTEN static void smooth_once(ConstInts offsets, ConstInts neighbors, const FourSingles *from, FourSingles *to) {
    for (int64_t v = 0; v < offsets.size - 1; v++) {
        int32_t first = offsets.data[v], last = offsets.data[v + 1];
        FourSingles sum = {0.0f, 0.0f, 0.0f, 0.0f};
        for (int32_t i = first; i < last; i++) sum += from[neighbors.data[i]];
        float weight = last > first ? 0.5f / (float)(last - first) : 0.0f;
        to[v] = 0.5f * from[v] + weight * sum;
    }
}

/* `scratch` has eight numbers a vertex. */
int64_t prolong(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstDoubles2 places, int64_t rounds,
    Singles scratch, Doubles2 positions) {
    int64_t n = own.size;
    if (!fits_graph(offsets, neighbors) || offsets.size != n + 1 || places.columns != 3 || positions.rows != n
        || positions.columns != 3 || scratch.size < 8 * n)
        return MISUSED;
    FourSingles *from = (FourSingles *)scratch.data, *to = from + n;
    for (int64_t v = 0; v < n; v++) {
        const double *place = places.data + 3 * (int64_t)own.data[v];
        from[v] = (FourSingles){(float)place[0], (float)place[1], (float)place[2], 0.0f};
    }
    for (; rounds > 0; rounds--) {
        smooth_once(offsets, neighbors, from, to);
        FourSingles *other = from;
        from = to;
        to = other;
    }
    for (int64_t v = 0; v < n; v++)
        for (int d = 0; d < 3; d++) positions.data[3 * v + d] = (double)from[v][d];
    return 0;
}

bool prolong_cells(const Cells *cells, const Graph *graph, ConstDoubles2 places, int rounds, Arena *arena,
    Arena *scratch, Doubles2 *positions) {
    int64_t n = graph->size;
    Mark mark = mark_of(scratch);
    Singles room;
    bool done = take_doubles2(arena, n, 3, positions) && take_singles(scratch, 8 * n, &room);
    if (done) prolong(graph->offsets, graph->neighbors, cells->own, places, rounds, room, *positions);
    release_to(scratch, mark);
    return done;
}

bool mark_prolonged(const Cells *cells, const Graph *graph, ConstBytes marked, int rings, Arena *arena, Arena *scratch,
    Bytes *whole) {
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
