/* The corners of a mesh, and the order in which a grid is coded (specification, V 1, V 2). */
#include "bitstream/fields/fields.h"

enum { MOST_CORNERS = 1 << 30, QUEUES = 4 };

/* Fill starts and corners: those of each vertex, in order. Checks the faces. */
int64_t gather_corners(Corners c) {
    const int32_t *vertex = c.faces.data;
    int32_t *starts = c.starts.data;
    int64_t n = c.rank.size;
    if (c.corners.size > MOST_CORNERS) return MISUSED;
    if (!all_below(vertex, c.corners.size, n)) return MISUSED;
    for (int64_t v = 0; v <= n; v++) starts[v] = 0;
    for (int64_t k = 0; k < c.corners.size; k++) starts[vertex[k]]++;
    for (int64_t v = 0; v < n; v++) starts[v + 1] += starts[v];
    for (int64_t k = c.corners.size - 1; k >= 0; k--) c.corners.data[--starts[vertex[k]]] = (int32_t)k;
    return 0;
}

typedef struct { /* the edge to a vertex from the last vertex that had one */
    int32_t from, facing; /* the corner that faces it and waits for a partner, or -1 */
} WaitingEdge;

/* Pair the corners that face the edges from v to vertices of higher number, as they come. `edges`: by that vertex.
 * Returns whether more than two corners face one. */
OFTEN static bool pair_corners(const Corners *c, int32_t v, WaitingEdge *edges) {
    const int32_t *vertex = c->faces.data;
    bool crowded = false;
    for (int32_t i = c->starts.data[v]; i < c->starts.data[v + 1]; i++) {
        int32_t next = next_corner(c->corners.data[i]), previous = previous_corner(c->corners.data[i]);
        for (int side = 0; side < 2; side++) {
            int32_t u = vertex[side == 0 ? next : previous], facing = side == 0 ? previous : next;
            WaitingEdge *edge = edges + u;
            if (u <= v) continue;
            if (edge->from != v) {
                *edge = (WaitingEdge){.from = v, .facing = facing};
            } else if (edge->facing < 0) {
                crowded = true;
                edge->facing = facing;
            } else {
                c->opposite.data[facing] = edge->facing;
                c->opposite.data[edge->facing] = facing;
                edge->facing = -1;
            }
        }
    }
    return crowded;
}

/* Fill opposite as well; scratch: 2 n. */
int64_t link_corners(Corners *c, Ints scratch) {
    int64_t n = c->rank.size;
    WaitingEdge *edges = (WaitingEdge *)scratch.data;
    if (gather_corners(*c) != 0) return MISUSED;
    for (int64_t k = 0; k < c->corners.size; k++) c->opposite.data[k] = -1;
    for (int64_t i = 0; i < scratch.size; i++) scratch.data[i] = -1;
    for (int64_t v = 0; v < n; v++) c->crowded |= pair_corners(c, (int32_t)v, edges);
    return 0;
}

/* The same where vertices are parts of those of a mesh that is not crowded: corners are partners if they are there. */
int64_t link_parts(const Corners *c, const Corners *whole) {
    const int32_t *vertex = c->faces.data;
    if (gather_corners(*c) != 0) return MISUSED;
    for (int32_t k = 0; k < c->corners.size; k++) {
        int32_t beyond = whole->opposite.data[k];
        c->opposite.data[k] = -1;
        if (beyond < 0) continue;
        int32_t a = vertex[next_corner(k)], b = vertex[previous_corner(k)];
        int32_t p = vertex[next_corner(beyond)], q = vertex[previous_corner(beyond)];
        if ((a == p && b == q) || (a == q && b == p)) c->opposite.data[k] = beyond;
    }
    return 0;
}

typedef struct { /* vertices that wait to be coded, by how many flaps they have, first come first served */
    int32_t first[QUEUES], last[QUEUES];
    int32_t *next, *previous, *queue; /* by vertex; queue -1: does not wait */
} Waiting;

static void leave(Waiting *w, int32_t v) {
    int32_t queue = w->queue[v], next = w->next[v], previous = w->previous[v];
    if (queue < 0) return;
    if (previous < 0) w->first[queue] = next;
    else w->next[previous] = next;
    if (next < 0) w->last[queue] = previous;
    else w->previous[next] = previous;
    w->queue[v] = -1;
}

static void enter(Waiting *w, int32_t v, int32_t queue) {
    int32_t previous = w->last[queue];
    w->next[v] = -1;
    w->previous[v] = previous;
    w->queue[v] = queue;
    if (previous < 0) w->first[queue] = v;
    else w->next[previous] = v;
    w->last[queue] = v;
}

/* A vertex has come to touch a coded edge, or to have a flap more. */
static void promote(Waiting *w, int32_t v, bool flap) {
    int32_t queue = (int32_t)least(largest(w->queue[v], 0) + flap, QUEUES - 1);
    if (queue == w->queue[v]) return;
    leave(w, v);
    enter(w, v, queue);
}

/* What v, just coded, completes. */
OFTEN static void complete(const Corners *c, Waiting *w, int32_t v) {
    const int32_t *vertex = c->faces.data, *rank = c->rank.data;
    for (int32_t i = c->starts.data[v]; i < c->starts.data[v + 1]; i++) {
        int32_t k = c->corners.data[i], a = next_corner(k), b = previous_corner(k);
        bool has_a = rank[vertex[a]] >= 0, has_b = rank[vertex[b]] >= 0;
        if (has_a && has_b) { /* the face, which is a flap of what lies opposite v */
            int32_t beyond = c->opposite.data[k];
            if (beyond >= 0 && rank[vertex[beyond]] < 0) promote(w, vertex[beyond], true);
        } else if (has_a || has_b) { /* an edge: what lies behind it may be a flap of the third corner */
            int32_t third = has_a ? b : a, beyond = c->opposite.data[third];
            promote(w, vertex[third], beyond >= 0 && rank[vertex[beyond]] >= 0);
        }
    }
}

/* Fill rank and order: next is always a vertex with the most flaps (three or more count alike), of these the one that
 * has had them for longest; where none waits, the one of lowest number. scratch: 3 x n. */
int64_t order_vertices(Corners c, Ints order, Ints2 scratch) {
    int64_t n = c.rank.size;
    Waiting w = {.next = scratch.data, .previous = scratch.data + n, .queue = scratch.data + 2 * n};
    for (int q = 0; q < QUEUES; q++) w.first[q] = w.last[q] = -1;
    for (int64_t v = 0; v < n; v++) c.rank.data[v] = w.queue[v] = -1;
    int32_t fresh = 0;
    for (int32_t done = 0; done < n; done++) {
        int32_t v = -1;
        for (int q = QUEUES - 1; q >= 0 && v < 0; q--) v = w.first[q];
        if (v < 0) {
            while (c.rank.data[fresh] >= 0) fresh++;
            v = fresh;
        }
        leave(&w, v);
        c.rank.data[v] = done;
        order.data[done] = v;
        complete(&c, &w, v);
    }
    return 0;
}

/* The coded neighbors of a vertex and its flaps, in the order of its corners. */
void gather_around(const Corners *c, int32_t v, Around *around) {
    const int32_t *vertex = c->faces.data, *rank = c->rank.data;
    int32_t now = rank[v];
    around->neighbors = around->flaps = 0;
    for (int32_t i = c->starts.data[v]; i < c->starts.data[v + 1]; i++) {
        int32_t k = c->corners.data[i], ends[2] = {vertex[next_corner(k)], vertex[previous_corner(k)]};
        for (int side = 0; side < 2; side++) {
            bool skip = rank[ends[side]] >= now || around->neighbors == MOST_NEIGHBORS;
            for (int j = 0; j < around->neighbors && !skip; j++) skip = around->neighbor[j] == ends[side];
            if (!skip) around->neighbor[around->neighbors++] = ends[side];
        }
        int32_t beyond = c->opposite.data[k];
        if (rank[ends[0]] < now && rank[ends[1]] < now && beyond >= 0 && rank[vertex[beyond]] < now
            && around->flaps < MOST_FLAPS)
            around->flap[around->flaps++] = (Flap){ends[0], ends[1], vertex[beyond], beyond};
    }
}

enum { WORDS_SEARCHED = 4 };

int32_t nearest_seen(const int64_t *row, int64_t words, int32_t v) {
    const uint64_t *seen = (const uint64_t *)row;
    int32_t word = v >> 6, bit = v & 63, below = -1;
    uint64_t low = seen[word] & ((UINT64_C(2) << bit) - 1), high = seen[word] & ~((UINT64_C(1) << bit) - 1);
    for (int i = 0; i < WORDS_SEARCHED && below < 0; i++) {
        if (low != 0) below = ((word - i) << 6) + 63 - __builtin_clzll(low);
        if (word - i == 0) break;
        low = seen[word - i - 1];
    }
    for (int i = 0; i < WORDS_SEARCHED; i++) {
        if (high != 0) {
            int32_t above = ((word + i) << 6) + __builtin_ctzll(high);
            return below < 0 || above - v < v - below ? above : below;
        }
        if (word + i + 1 == words) break;
        high = seen[word + i + 1];
    }
    return below < 0 ? v : below;
}

enum { MOST_ERROR = 1 << 28 };

int32_t error_at(const Ints2 *gaps, int32_t v) {
    int64_t sum = 0;
    for (int j = 0; j < gaps->columns; j++) sum += size_of(gaps->data[gaps->columns * v + j]);
    return (int32_t)least(sum, MOST_ERROR);
}

void pass_on(const Corners *corners, const Ints2 *values, const Longs2 *sums, int32_t v) {
    int64_t columns = values->columns;
    for (int32_t i = corners->starts.data[v]; i < corners->starts.data[v + 1]; i++) {
        int64_t *sum = sums->data + (columns + 1) * corners->faces.data[next_corner(corners->corners.data[i])];
        for (int j = 0; j < columns; j++) sum[j] += values->data[columns * v + j];
        sum[columns]++;
    }
}

int32_t balance(const Corners *corners, const Ints2 *values, const Longs2 *sums, const Around *around, int j,
    int32_t otherwise) {
    int64_t columns = values->columns, total = 0;
    int32_t found = 0;
    for (int i = 0; i < around->neighbors; i++) {
        int32_t u = around->neighbor[i];
        const int64_t *sum = sums->data + (columns + 1) * u;
        if (faces_at(corners, u) - sum[columns] > 1) continue;
        total += limited(FINE * ((sum[columns] + 1) * values->data[columns * u + j] - sum[j]) - otherwise);
        found++;
    }
    return found > 0 ? divided(total, found) : 0;
}
