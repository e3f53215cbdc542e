/* The graph of a mesh, compressed rows in ascending order (specification, M 2). */
#include "codec/geometry/geometry.h"

/* Edges of `faces`, whose entries are below `offsets.size - 1`. Returns the number of neighbors kept in `ends`, which
 * has room for six a face; `filled` and `second` are scratch, one entry a vertex and six a face. */
int64_t collect_edges(ConstInts2 faces, Ints offsets, Ints filled, Ints ends, Ints second) {
    int64_t size = offsets.size - 1;
    for (int64_t v = 0; v <= size; v++) offsets.data[v] = 0;
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        int32_t a = face[0], b = face[1], c = face[2];
        offsets.data[a + 1] += (a != b) + (a != c);
        offsets.data[b + 1] += (b != c) + (b != a);
        offsets.data[c + 1] += (c != a) + (c != b);
    }
    for (int64_t v = 0; v < size; v++) {
        filled.data[v] = offsets.data[v];
        offsets.data[v + 1] += offsets.data[v];
    }
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        for (int i = 0; i < 3; i++) {
            int32_t a = face[i], b = face[i < 2 ? i + 1 : 0], c = face[i > 0 ? i - 1 : 2];
            if (a != b) second.data[filled.data[a]++] = b;
            if (a != c) second.data[filled.data[a]++] = c;
        }
    }
    /* Each row is complete now, but in no order, and an edge stands in it once for every face beside it. Turned over,
     * the rows are ascending: vertex v comes to its neighbors after all vertices before it. A row holds as many
     * entries as come to it, so that what is written twice stays within it. */
    for (int64_t v = 0; v < size; v++) filled.data[v] = offsets.data[v];
    for (int64_t v = 0; v < size; v++) {
        for (int64_t i = offsets.data[v]; i < offsets.data[v + 1]; i++) {
            int32_t w = second.data[i], at = filled.data[w];
            bool is_new = at == offsets.data[w] || ends.data[at - 1] != v;
            ends.data[at] = (int32_t)v;
            filled.data[w] = at + is_new;
        }
    }
    int64_t kept = 0;
    for (int64_t v = 0; v < size; v++) {
        int64_t first = offsets.data[v], last = filled.data[v];
        offsets.data[v] = (int32_t)kept;
        for (int64_t i = first; i < last; i++) ends.data[kept++] = ends.data[i];
    }
    offsets.data[size] = (int32_t)kept;
    return kept;
}

/* The connected component of each vertex, in the order of their first vertices; `waiting` has an entry a vertex, too.
 * Returns how many there are. */
int64_t label_components(ConstInts offsets, ConstInts neighbors, Ints waiting, Ints labels) {
    int64_t n = offsets.size - 1, count = 0;
    if (n < 0 || waiting.size != n || labels.size != n) return MISUSED;
    for (int64_t v = 0; v < n; v++) labels.data[v] = -1;
    for (int64_t first = 0; first < n; first++) {
        if (labels.data[first] >= 0) continue;
        int64_t end = 0;
        labels.data[first] = (int32_t)count;
        waiting.data[end++] = (int32_t)first;
        for (int64_t i = 0; i < end; i++)
            for (int32_t k = offsets.data[waiting.data[i]]; k < offsets.data[waiting.data[i] + 1]; k++) {
                int32_t other = neighbors.data[k];
                if (labels.data[other] >= 0) continue;
                labels.data[other] = (int32_t)count;
                waiting.data[end++] = other;
            }
        count++;
    }
    return count;
}

/* Whether there is a way from vertex 0 to all others; `scratch` has two entries a vertex, and one more. */
bool reaches_all(ConstInts offsets, ConstInts neighbors, Ints scratch) {
    int64_t n = offsets.size - 1, tail = 1;
    int32_t *unseen = scratch.data, *waiting = scratch.data + n;
    for (int64_t v = 0; v < n; v++) unseen[v] = v > 0;
    waiting[0] = 0;
    for (int64_t head = 0; head < tail && tail < n; head++) {
        int32_t v = waiting[head];
        for (int32_t i = offsets.data[v]; i < offsets.data[v + 1]; i++) {
            /* Without a branch, which the processor could not predict: what is not new is overwritten. */
            int32_t w = neighbors.data[i];
            waiting[tail] = w;
            tail += unseen[w];
            unseen[w] = 0;
        }
    }
    return tail == n;
}

INLINE bool comes_first(const int32_t *row, int64_t k) {
    for (int64_t i = 0; i < k; i++)
        if (row[i] == row[k]) return false;
    return true;
}

/* Faces, or other rows of vertices, around each vertex, each once. Entries are below `starts.size - 1`; `members` has
 * room for all of them. */
void vertex_faces(ConstInts2 faces, Longs starts, Ints members) {
    int64_t n = starts.size - 1, sides = faces.columns;
    for (int64_t v = 0; v <= n; v++) starts.data[v] = 0;
    for (const int32_t *row = faces.data; row < faces.data + sides * faces.rows; row += sides)
        for (int64_t k = 0; k < sides; k++) starts.data[row[k] + 1] += comes_first(row, k);
    for (int64_t v = 0; v < n; v++) starts.data[v + 1] += starts.data[v];
    int64_t all = starts.data[n]; /* ends of rows, one place on, become starts while these are filled from behind */
    for (int32_t f = (int32_t)faces.rows; f-- > 0;)
        for (int64_t row = sides * f, k = 0; k < sides; k++)
            if (comes_first(faces.data + row, k)) members.data[--starts.data[faces.data[row + k] + 1]] = f;
    for (int64_t v = 0; v < n; v++) starts.data[v] = starts.data[v + 1];
    starts.data[n] = all;
}
