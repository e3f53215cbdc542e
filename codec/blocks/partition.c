/* Recursive bisection of a graph (specification, M 3): `codec/blocks/overlap.py` says what it is for.
 *
 * A segment lies between a low and a high end. Its vertices are sorted by distance to the low end minus distance to the
 * high end, and cut in two; each half keeps one end and the distances to it. */
#include "codec/blocks/blocks.h"

enum { LEAF = 8, DEPTH = 64, ROW = 8, USUAL = 6 };

typedef struct {
    const int32_t *offsets, *neighbors;
    int32_t *rows;      /* ROW neighbors of each vertex, or itself for want of more; -1 first where it has too many */
    int32_t *distances; /* two for each vertex: to the low and to the high end of the segment that it is in */
    uint16_t *open;     /* 1 for what a sweep has yet to find, 0 otherwise and between sweeps */
    uint32_t *queue, *digits, *buckets;
} Bisection;

typedef struct {
    int64_t first, last, part, parts;
    int kept;
} Segment;

/* Append those of some vertices that are open to a queue, and close them. Returns where the queue ends then. */
INLINE int64_t visit(const int32_t *vertices, int64_t count, uint16_t *open, uint32_t *queue, int64_t tail) {
    for (int64_t k = 0; k < count; k++) {
        /* Without a branch, which the processor could not predict: what is not new is overwritten. */
        int32_t w = vertices[k];
        queue[tail] = (uint32_t)w;
        tail += open[w];
        open[w] = 0;
    }
    return tail;
}

/* Breadth-first distances from `start` within a segment, to its end `side`; `queue` gets its vertices in the order of
 * discovery. Where the sweep comes to an end before all are found, it goes on, one step farther away, from the last
 * vertex of the segment that is still missing. */
static void sweep(Bisection *work, const uint32_t *segment, int64_t size, uint32_t start, int side) {
    const int32_t *offsets = work->offsets, *neighbors = work->neighbors, *rows = work->rows;
    uint16_t *open = work->open;
    uint32_t *queue = work->queue;
    int32_t *distances = work->distances + side, level = 0;
    for (int64_t i = 0; i < size; i++) open[segment[i]] = 1;
    open[start] = 0;
    queue[0] = start;
    int64_t tail = 1, end = 1, missing = size;
    for (int64_t head = 0; head < size; head++) {
        if (head == tail) {
            do missing--;
            while (open[segment[missing]] == 0);
            tail = visit((const int32_t *)segment + missing, 1, open, queue, tail);
        }
        level += head == end;
        end = head == end ? tail : end;
        uint32_t v = queue[head];
        const int32_t *row = rows + (int64_t)ROW * v;
        distances[2 * (int64_t)v] = level;
        if (tail == size) continue;
        if (row[0] >= 0) {
            tail = visit(row, USUAL, open, queue, tail);
            if ((uint32_t)row[USUAL] != v) tail = visit(row + USUAL, ROW - USUAL, open, queue, tail);
        } else tail = visit(neighbors + offsets[v], offsets[v + 1] - offsets[v], open, queue, tail);
    }
}

/* Sort a segment by distance to its low end minus distance to its high end, ties by place in `queue`: a counting sort,
 * in one pass unless there are far more values than vertices. No vertex is farther than `most` from both ends. */
static void sort_segment(Bisection *work, uint32_t *segment, int64_t size, uint32_t most) {
    const int32_t *distances = work->distances;
    uint32_t *source = work->queue, *target = segment, *buckets = work->buckets, *digits = work->digits;
    uint32_t span = 2 * most, bits = 1;
    while (span >> bits > 0 && (size << 1) >> bits > 0) bits++;
    uint32_t mask = (1u << bits) - 1;
    for (uint32_t shift = 0;;) {
        for (int64_t k = 0; k < (int64_t)mask + 2; k++) buckets[k] = 0;
        for (int64_t i = 0; i < size; i++) {
            const int32_t *low = distances + 2 * (int64_t)source[i], *high = low + 1;
            digits[i] = ((uint32_t)(*low - *high) + most) >> shift & mask;
            buckets[digits[i] + 1]++;
        }
        for (int64_t k = 0; k < (int64_t)mask; k++) buckets[k + 1] += buckets[k];
        for (int64_t i = 0; i < size; i++) target[buckets[digits[i]]++] = source[i];
        uint32_t *swapped = source;
        source = target;
        target = swapped;
        shift += bits;
        if (shift >= 32 || span >> shift == 0) break;
    }
    if (source != segment)
        for (int64_t i = 0; i < size; i++) segment[i] = source[i];
}

static void fill_rows(const Bisection *work, int64_t size) {
    for (int64_t v = 0; v < size; v++) {
        int32_t *row = work->rows + ROW * v, first = work->offsets[v], count = work->offsets[v + 1] - first;
        for (int k = 0; k < ROW; k++) row[k] = k < count ? work->neighbors[first + k] : (int32_t)v;
        if (count > ROW) row[0] = -1;
    }
}

static bool open_work(Bisection *work, ConstInts offsets, ConstInts neighbors, Ints order, Ints bounds, Words scratch) {
    int64_t size = offsets.size - 1;
    if (size < 0 || bounds.size < 2 || order.size < size || scratch.size < bisection_scratch(size)) return false;
    if (neighbors.size < offsets.data[size]) return false;
    uint32_t *room = scratch.data;
    *work = (Bisection){.offsets = offsets.data, .neighbors = neighbors.data, .rows = (int32_t *)room};
    work->distances = (int32_t *)(room + ROW * size);
    work->open = (uint16_t *)(room + 10 * size);
    work->queue = room + 11 * size;
    work->digits = room + 12 * size + 1;
    work->buckets = room + 13 * size + 1;
    fill_rows(work, size);
    return true;
}

/* All vertices as one segment. */
static Segment begin(Bisection *work, uint32_t *segments, int64_t size, Ints bounds) {
    int64_t parts = bounds.size - 1;
    for (int64_t v = 0; v < size; v++) {
        segments[v] = (uint32_t)v;
        work->open[v] = 0;
    }
    for (int64_t p = 0; p < parts; p++) bounds.data[p] = 0;
    bounds.data[parts] = (int32_t)size;
    /* The low end of the whole is the vertex that a sweep from vertex 0 reaches last. */
    if (size > LEAF) {
        sweep(work, segments, size, 0, 1);
        sweep(work, segments, size, work->queue[size - 1], 0);
    }
    return (Segment){0, size, 0, parts, 0};
}

static Segment lower(Segment s, int64_t cut) { return (Segment){s.first, cut, s.part, s.parts / 2, 0}; }

static Segment upper(Segment s, int64_t cut) {
    return (Segment){cut, s.last, s.part + s.parts / 2, s.parts - s.parts / 2, 1};
}

/* Cut a segment of several parts in two; returns where. */
static int64_t cut_segment(Bisection *work, uint32_t *segments, Segment s) {
    uint32_t *segment = segments + s.first;
    int64_t count = s.last - s.first;
    if (count > LEAF) {
        const int32_t *distances = work->distances;
        uint32_t far = segment[0];
        int32_t most = -1;
        for (int64_t i = 0; i < count; i++) {
            int32_t own = distances[2 * (int64_t)segment[i] + s.kept];
            far = own > most ? segment[i] : far;
            most = own > most ? own : most;
        }
        sweep(work, segment, count, far, 1 - s.kept);
        uint32_t last = work->queue[count - 1];
        sort_segment(work, segment, count, (uint32_t)largest(most, distances[2 * (int64_t)last + 1 - s.kept]));
    }
    return s.first + count * (s.parts / 2) / s.parts;
}

/* Cut a segment into its parts. */
static void cut_on(Bisection *work, uint32_t *segments, Segment whole, Ints bounds) {
    Segment stack[DEPTH];
    stack[0] = whole;
    for (int depth = 1; depth > 0;) {
        Segment s = stack[--depth];
        if (s.parts == 1) continue;
        int64_t cut = cut_segment(work, segments, s);
        bounds.data[s.part + s.parts / 2] = (int32_t)cut;
        stack[depth++] = upper(s, cut);
        stack[depth++] = lower(s, cut);
    }
}

/* Cut a graph into `bounds.size - 1` parts: part p is `order[bounds[p]:bounds[p + 1]]`. */
bool bisect(ConstInts offsets, ConstInts neighbors, Ints order, Ints bounds, Words scratch) {
    Bisection work;
    if (!open_work(&work, offsets, neighbors, order, bounds, scratch)) return false;
    uint32_t *segments = (uint32_t *)order.data;
    cut_on(&work, segments, begin(&work, segments, offsets.size - 1, bounds), bounds);
    return true;
}

/* The derived partition: boundary vertices move to where most of their neighbors are (specification, M 4). */

static int32_t better_part(ConstInts offsets, ConstInts neighbors, const int32_t *labels, const int64_t *sizes,
                           const int32_t *votes, int64_t room, int64_t v) {
    int32_t own = labels[v], best = own;
    for (int64_t i = offsets.data[v]; i < offsets.data[v + 1]; i++) {
        int32_t part = labels[neighbors.data[i]];
        if (part == own || part == best || sizes[part] >= room) continue;
        if (votes[part] > votes[best] || (votes[part] == votes[best] && sizes[part] + (best == own) < sizes[best]))
            best = part;
    }
    return best;
}

/* Greedy, `passes` times over all vertices: a vertex moves to the part that most of its neighbors have, unless that
 * part is full. On a draw it moves only from a larger part to one at least two smaller; a part holds at most 3 % more
 * than its share, and never less than one vertex. `sizes` and `votes` are scratch, one entry a part. */
void refine_partition(ConstInts offsets, ConstInts neighbors, Ints labels, int64_t passes, Longs sizes, Ints votes) {
    int64_t n = labels.size, parts = sizes.size, room = n * 103 / (parts * 100) + 1;
    for (int64_t p = 0; p < parts; p++) sizes.data[p] = votes.data[p] = 0;
    for (int64_t v = 0; v < n; v++) sizes.data[labels.data[v]]++;
    for (int64_t pass = 0; pass < passes; pass++) {
        for (int64_t v = 0; v < n; v++) {
            int32_t own = labels.data[v];
            int64_t first = offsets.data[v], last = offsets.data[v + 1], i = first;
            while (i < last && labels.data[neighbors.data[i]] == own) i++;
            if (i == last) continue;
            for (i = first; i < last; i++) votes.data[labels.data[neighbors.data[i]]]++;
            int32_t best = better_part(offsets, neighbors, labels.data, sizes.data, votes.data, room, v);
            for (i = first; i < last; i++) votes.data[labels.data[neighbors.data[i]]] = 0;
            if (best != own && sizes.data[own] > 1) {
                labels.data[v] = best;
                sizes.data[own]--;
                sizes.data[best]++;
            }
        }
    }
}

/* The part of each vertex, where part p is `order[bounds[p]:bounds[p + 1]]`. */
int64_t label_parts(ConstInts order, ConstInts bounds, Ints labels) {
    int64_t parts = bounds.size - 1;
    if (parts < 0 || bounds.data[0] < 0 || bounds.data[parts] > order.size || labels.size != order.size) return MISUSED;
    for (int64_t p = 0; p < parts; p++)
        for (int64_t i = bounds.data[p]; i < bounds.data[p + 1]; i++) labels.data[order.data[i]] = (int32_t)p;
    return 0;
}

/* Vertices label after label, ascending within each; labels are below `bounds.size - 1`. */
void group_by_label(ConstInts labels, Ints bounds, Ints order) {
    int64_t parts = bounds.size - 1;
    for (int64_t p = 0; p <= parts; p++) bounds.data[p] = 0;
    for (int64_t v = 0; v < labels.size; v++) bounds.data[labels.data[v]]++;
    int32_t before = 0;
    for (int64_t p = 0; p <= parts; p++) {
        int32_t count = bounds.data[p];
        bounds.data[p] = before;
        before += count;
    }
    for (int64_t v = 0; v < labels.size; v++) order.data[bounds.data[labels.data[v]]++] = (int32_t)v;
    /* Every bound has moved to the end of its part, which is where the next one begins. */
    for (int64_t p = parts; p > 0; p--) bounds.data[p] = bounds.data[p - 1];
    bounds.data[0] = 0;
}
