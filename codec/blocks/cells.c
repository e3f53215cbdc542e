/* Cells of vertices, their graph and their faces, all integers (specification, M 18). */
#include "codec/blocks/blocks.h"

#include "codec/geometry/geometry.h"

/* The cell of each vertex; returns how many cells there are. `far`, of each vertex, becomes how many edges the nearest
 * center is away: where no center comes nearer, nothing is visited again, so that an edge is visited `reach` times at
 * most. `waiting` has an entry a vertex; `reach` is below 255. */
int64_t find_cells(ConstInts offsets, ConstInts neighbors, int64_t reach, Bytes far, Ints waiting, Ints own) {
    int64_t n = offsets.size - 1, cells = 0, end = 0;
    int32_t *queue = waiting.data;
    for (int64_t v = 0; v < n; v++) far.data[v] = UINT8_MAX;
    for (int64_t v = 0; v < n; v++) {
        own.data[v] = -1;
        if (far.data[v] <= reach) continue;
        own.data[v] = (int32_t)cells++;
        far.data[v] = 0;
        queue[0] = (int32_t)v;
        for (int64_t head = 0, tail = 1; head < tail; head++) {
            int32_t u = queue[head];
            int next = far.data[u] + 1;
            for (int32_t i = offsets.data[u]; next <= reach && i < offsets.data[u + 1]; i++) {
                int32_t w = neighbors.data[i];
                if (far.data[w] <= next) continue;
                far.data[w] = (uint8_t)next;
                queue[tail++] = w;
            }
        }
    }
    for (int64_t v = 0; v < n; v++)
        if (far.data[v] == 0) queue[end++] = (int32_t)v;
    for (int64_t head = 0; head < end; head++) {
        int32_t u = queue[head];
        for (int32_t i = offsets.data[u]; i < offsets.data[u + 1]; i++) {
            int32_t w = neighbors.data[i];
            if (own.data[w] >= 0) continue;
            own.data[w] = own.data[u];
            queue[end++] = w;
        }
    }
    return cells;
}

/* The graph of the cells, in ascending order; returns the ends of its edges. `links` has their number of vertices less
 * one; `found` and `ends` have room for all ends of edges of the mesh, `filled` an entry a cell, `bounds` one more, and
 * `order` an entry a vertex. */
int64_t link_cells(ConstInts offsets, ConstInts neighbors, ConstInts own, Ints bounds, Ints order, Ints filled,
    Ints found, Ints links, Ints ends) {
    int64_t cells = links.size - 1, count = 0;
    group_by_label(own, bounds, order);
    for (int64_t c = 0; c < cells; c++) filled.data[c] = -1;
    for (int64_t c = 0; c < cells; c++) {
        links.data[c] = (int32_t)count;
        filled.data[c] = (int32_t)c;
        for (int32_t k = bounds.data[c]; k < bounds.data[c + 1]; k++) {
            int32_t v = order.data[k];
            for (int32_t i = offsets.data[v]; i < offsets.data[v + 1]; i++) {
                int32_t other = own.data[neighbors.data[i]];
                found.data[count] = other;
                count += filled.data[other] != c;
                filled.data[other] = (int32_t)c;
            }
        }
    }
    links.data[cells] = (int32_t)count;
    /* Turned over, rows are ascending: a cell comes to its neighbors after all before it. */
    for (int64_t c = 0; c < cells; c++) filled.data[c] = links.data[c];
    for (int64_t c = 0; c < cells; c++)
        for (int32_t i = links.data[c]; i < links.data[c + 1]; i++)
            if (filled.data[found.data[i]] < links.data[found.data[i] + 1])
                ends.data[filled.data[found.data[i]]++] = (int32_t)c;
    return count;
}

/* Sort numbers of triples by one of their entries, below `counts.size - 1`; stable. */
static void sort_by_entry(const int32_t *triples, int entry, Ints counts, Ints order, Ints sorted) {
    for (int64_t c = 0; c < counts.size; c++) counts.data[c] = 0;
    for (int64_t i = 0; i < order.size; i++) counts.data[triples[3 * i + entry] + 1]++;
    for (int64_t c = 1; c < counts.size; c++) counts.data[c] += counts.data[c - 1];
    for (int64_t i = 0; i < order.size; i++)
        sorted.data[counts.data[triples[3 * (int64_t)order.data[i] + entry]]++] = order.data[i];
}

/* The faces whose corners are in three cells, of these cells, each three once; returns their number. `triples` has room
 * for all faces, `order` and `sorted` an entry a face, `counts` one more than cells. */
int64_t cell_faces(ConstInts2 faces, ConstInts own, Ints counts, Ints2 triples, Ints order, Ints sorted, Ints2 kept) {
    int64_t count = 0, last = 0;
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        int32_t a = own.data[face[0]], b = own.data[face[1]], c = own.data[face[2]];
        if (a == b || b == c || c == a) continue;
        int32_t *row = kept.data + 3 * count, *triple = triples.data + 3 * count;
        int32_t low = a < b ? a : b, high = a < b ? b : a;
        row[0] = a, row[1] = b, row[2] = c;
        triple[0] = low < c ? low : c;
        triple[1] = low > c ? low : high < c ? high : c;
        triple[2] = high > c ? high : c;
        order.data[count] = (int32_t)count;
        count++;
    }
    order.size = sorted.size = count;
    for (int entry = 2; entry >= 0; entry--) {
        sort_by_entry(triples.data, entry, counts, order, sorted);
        Ints other = order;
        order = sorted;
        sorted = other;
    }
    for (int64_t i = 0; i < count; i++) sorted.data[i] = 1;
    for (int64_t i = 1; i < count; i++) {
        const int32_t *triple = triples.data + 3 * (int64_t)order.data[i],
                      *before = triples.data + 3 * (int64_t)order.data[i - 1];
        sorted.data[order.data[i]] = triple[0] != before[0] || triple[1] != before[1] || triple[2] != before[2];
    }
    for (int64_t i = 0; i < count; i++)
        if (sorted.data[i]) {
            for (int j = 0; j < 3; j++) kept.data[3 * last + j] = kept.data[3 * i + j];
            last++;
        }
    return last;
}
