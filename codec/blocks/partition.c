/* The derived partition: boundary vertices move to where most of their neighbours are (specification, M 4). */
#include "codec/blocks/partition.h"

static int32_t better_part(ConstInts offsets, ConstInts neighbours, const int32_t *labels, const int64_t *sizes,
                           const int32_t *votes, int64_t room, int64_t v) {
    int32_t own = labels[v], best = own;
    for (int64_t i = offsets.data[v]; i < offsets.data[v + 1]; i++) {
        int32_t part = labels[neighbours.data[i]];
        if (part == own || part == best || sizes[part] >= room) continue;
        if (votes[part] > votes[best] || (votes[part] == votes[best] && sizes[part] + (best == own) < sizes[best]))
            best = part;
    }
    return best;
}

/* Greedy, `passes` times over all vertices: a vertex moves to the part that most of its neighbours have, unless that
 * part is full. On a draw it moves only from a larger part to one at least two smaller; a part holds at most 3 % more
 * than its share, and never less than one vertex. `sizes` and `votes` are scratch, one entry a part. */
void refine_partition(ConstInts offsets, ConstInts neighbours, Ints labels, int64_t passes, Longs sizes, Ints votes) {
    int64_t n = labels.size, parts = sizes.size, room = n * 103 / (parts * 100) + 1;
    for (int64_t p = 0; p < parts; p++) sizes.data[p] = votes.data[p] = 0;
    for (int64_t v = 0; v < n; v++) sizes.data[labels.data[v]]++;
    for (int64_t pass = 0; pass < passes; pass++) {
        for (int64_t v = 0; v < n; v++) {
            int32_t own = labels.data[v];
            int64_t first = offsets.data[v], last = offsets.data[v + 1], i = first;
            while (i < last && labels.data[neighbours.data[i]] == own) i++;
            if (i == last) continue;
            for (i = first; i < last; i++) votes.data[labels.data[neighbours.data[i]]]++;
            int32_t best = better_part(offsets, neighbours, labels.data, sizes.data, votes.data, room, v);
            for (i = first; i < last; i++) votes.data[labels.data[neighbours.data[i]]] = 0;
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
