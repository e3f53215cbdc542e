/* Faces that repeat a corner, on the edges of the others (specification, C 13). */
#include "bitstream/connectivity/connectivity.h"

enum {
    INPUTS = 3,
    CONTEXTS = 256, /* of an input */
    NODES = 8,      /* slots of a context */
    LAST_MORE = 3,  /* last node of the decision whether an edge has one more such face; the first is 0 */
    UPPER = 4,      /* node of the decision whether it repeats the higher end */
    HISTORY = 255,  /* of the last eight edges */
};
INSIDE const BankPlan REPEAT_BANK = {.slots = INPUTS * CONTEXTS * NODES, .selectors = UPPER + 1, .inputs = INPUTS};

/* The contexts of an edge between two vertices (C 13.3). */
static void look_at_edge(const Edges *edges, int32_t low, int32_t high, int history, int64_t *contexts) {
    const int32_t *met = edges->met.data, *repeated = edges->repeated.data, *valence = edges->valence.data;
    int64_t known = least(met[low], 3) << 6 | least(met[high], 3) << 4;
    known |= least(repeated[low], 3) << 2 | least(repeated[high], 3);
    contexts[0] = NODES * known;
    contexts[1] = NODES * (CONTEXTS + (int64_t)history);
    contexts[2] = NODES * (2 * CONTEXTS + (least(valence[low], 15) << 4 | least(valence[high], 15)));
}

/* Code how many faces are on each edge, and fill `corners` with them. Returns how many are missing in the end. */
int64_t code_repeats(RangeCoder *coder, const Bank *bank, const Edges *edges, Ints corners) {
    const FacesOnEdges *given = &edges->given;
    int64_t missing = corners.size / 3;
    int32_t *face = corners.data;
    int history = 0;
    for (int64_t begin = 0, end; begin < edges->order.size && missing > 0 && !overran(coder); begin = end) {
        int32_t low, high, next = is_reading(coder) ? -1 : given->first.data[begin];
        int64_t contexts[INPUTS], before = missing;
        end = end_of_edge(edges->origin, edges->order, begin, &low, &high);
        if (low == high) continue;
        look_at_edge(edges, low, high, history, contexts);
        while (missing > 0) {
            int64_t node = least(before - missing, LAST_MORE);
            if (!code_mixed_bit(coder, bank, INPUTS, contexts, node, 0, next >= 0)) break;
            bool is_upper = next >= 0 && repeats_corner(given->corners.data + 3 * (int64_t)next, high);
            is_upper = code_mixed_bit(coder, bank, INPUTS, contexts, UPPER, 0, is_upper);
            face[0] = low;
            face[1] = is_upper ? high : low;
            face[2] = high;
            edges->repeated.data[face[1]]++;
            if (next >= 0) {
                given->order.data[corners.size / 3 - missing] = next;
                next = given->next.data[next];
            }
            face += 3;
            missing--;
        }
        edges->met.data[low] += (int32_t)(before - missing);
        edges->met.data[high] += (int32_t)(before - missing);
        history = (history << 1 | (missing < before)) & HISTORY;
    }
    return missing;
}

#ifdef BSMDEC_WRITES
/* The first half-edge of an edge in their order; -1 if there is none. `ends` has where those of each lower end end. */
static int64_t find_edge(const Edges *edges, ConstLongs ends, int32_t low, int32_t high) {
    int64_t from = low > 0 ? ends.data[low - 1] : 0, to = ends.data[low], last = to;
    while (from < to) {
        int64_t middle = (from + to) / 2;
        if (high_end(edges->origin.data, edges->order.data[middle]) < high) from = middle + 1;
        else to = middle;
    }
    return from < last && high_end(edges->origin.data, edges->order.data[from]) == high ? from : -1;
}

/* List the faces of a writer that are on edges of `vertices` vertices. Returns how many there are. */
int64_t list_on_edges(const Edges *edges, ConstLongs ends, int64_t vertices) {
    const FacesOnEdges *given = &edges->given;
    int64_t found = 0;
    for (int64_t i = 0; i < given->first.size; i++) given->first.data[i] = -1;
    for (int64_t f = given->next.size; f-- > 0;) {
        const int32_t *face = given->corners.data + 3 * f;
        int32_t low = (int32_t)least(least(face[0], face[1]), face[2]);
        int32_t high = (int32_t)largest(largest(face[0], face[1]), face[2]);
        int64_t edge = low < high && high < vertices ? find_edge(edges, ends, low, high) : -1;
        given->next.data[f] = edge < 0 ? NOT_ON_EDGES : given->first.data[edge];
        if (edge < 0) continue;
        given->first.data[edge] = (int32_t)f;
        found++;
    }
    return found;
}
#endif
