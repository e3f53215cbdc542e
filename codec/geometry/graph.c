/* The graph of a mesh, compressed rows in ascending order (specification, M 2). */
#include "codec/geometry/graph.h"

/* Sort a row: neighbours of a vertex are few and nearly always come nearly sorted. */
static void sort_row(int32_t *row, int64_t size) {
    /* Heap sort, so that no row, however large and in whatever order, takes more than n log n steps. */
    if (size <= 32) {
        for (int64_t i = 1; i < size; i++) {
            int32_t value = row[i];
            int64_t j = i;
            for (; j > 0 && row[j - 1] > value; j--) row[j] = row[j - 1];
            row[j] = value;
        }
        return;
    }
    for (int64_t start = size / 2, end = size; end > 1;) {
        if (start > 0) {
            start--;
        } else {
            end--;
            int32_t value = row[end];
            row[end] = row[0];
            row[0] = value;
        }
        int64_t root = start;
        int32_t value = row[root];
        for (int64_t child = 2 * root + 1; child < end; child = 2 * root + 1) {
            if (child + 1 < end && row[child + 1] > row[child]) child++;
            if (row[child] <= value) break;
            row[root] = row[child];
            root = child;
        }
        row[root] = value;
    }
}

/* Edges of `faces`, whose entries are below `offsets.size - 1`. Returns the number of neighbours kept in `ends`,
 * which has room for six a face; `filled` is scratch, one entry a vertex. */
int64_t collect_edges(ConstInts2 faces, Ints offsets, Ints filled, Ints ends) {
    int64_t size = offsets.size - 1;
    for (int64_t v = 0; v <= size; v++) offsets.data[v] = 0;
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        for (int i = 0; i < 3; i++) {
            int32_t a = face[i], b = face[(i + 1) % 3];
            if (a != b) {
                offsets.data[a + 1]++;
                offsets.data[b + 1]++;
            }
        }
    }
    for (int64_t v = 0; v < size; v++) {
        filled.data[v] = offsets.data[v];
        offsets.data[v + 1] += offsets.data[v];
    }
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        for (int i = 0; i < 3; i++) {
            int32_t a = face[i], b = face[(i + 1) % 3];
            if (a != b) {
                ends.data[filled.data[a]++] = b;
                ends.data[filled.data[b]++] = a;
            }
        }
    }
    /* Each row is now complete but unsorted, and an edge stands in it once for every face beside it. */
    int64_t kept = 0;
    for (int64_t v = 0; v < size; v++) {
        int64_t first = offsets.data[v], last = offsets.data[v + 1];
        sort_row(ends.data + first, last - first);
        offsets.data[v] = (int32_t)kept;
        int32_t previous = -1;
        for (int64_t i = first; i < last; i++) {
            if (ends.data[i] != previous) {
                previous = ends.data[i];
                ends.data[kept++] = previous;
            }
        }
    }
    offsets.data[size] = (int32_t)kept;
    return kept;
}

/* Vertices of each connected component; `seen` is zero, all three arrays have an entry a vertex. Returns how many there
 * are. */
int64_t component_sizes(ConstInts offsets, ConstInts neighbours, Bytes seen, Ints waiting, Ints sizes) {
    int64_t n = offsets.size - 1, count = 0;
    if (n < 0 || seen.size != n || waiting.size != n || sizes.size != n) return MISUSED;
    for (int64_t first = 0; first < n; first++) {
        if (seen.data[first]) continue;
        int64_t end = 0;
        seen.data[first] = 1;
        waiting.data[end++] = (int32_t)first;
        for (int64_t i = 0; i < end; i++)
            for (int32_t k = offsets.data[waiting.data[i]]; k < offsets.data[waiting.data[i] + 1]; k++) {
                int32_t other = neighbours.data[k];
                if (seen.data[other]) continue;
                seen.data[other] = 1;
                waiting.data[end++] = other;
            }
        sizes.data[count++] = (int32_t)end;
    }
    return count;
}
