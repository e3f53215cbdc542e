/* The closed, oriented surface of any triangle list: what C 4 of the specification cuts, and closes by dummies.
 *
 * Only the twins are for a decoder, too: they tell the boundary of the faces (C 7.1).
 */
#include "bitstream/connectivity/connectivity.h"

/* Turn counts, each in the entry after its own, into the places where their items begin. */
static void sum_up(Longs starts) {
    for (int64_t v = 0; v + 1 < starts.size; v++) starts.data[v + 1] += starts.data[v];
}

/* Twin of each half-edge, -1 unless its edge has exactly one half-edge in each direction. Half-edges are sorted by both
 * ends with two counting passes, so time is linear whatever the degrees. `starts` has an entry more than there are
 * vertices; the other arrays have one for each half-edge. */
void match_halfedges(ConstInts origin, Longs starts, Ints by_high, Ints order, Ints twin) {
    int64_t size = origin.size, vertices = starts.size - 1;
    for (int64_t v = 0; v <= vertices; v++) starts.data[v] = 0;
    for (int32_t h = 0; h < size; h++) starts.data[high_end(origin.data, h) + 1]++;
    sum_up(starts);
    for (int32_t h = 0; h < size; h++) by_high.data[starts.data[high_end(origin.data, h)]++] = h;
    for (int64_t v = 0; v <= vertices; v++) starts.data[v] = 0;
    for (int32_t h = 0; h < size; h++) starts.data[low_end(origin.data, h) + 1]++;
    sum_up(starts);
    for (int64_t i = 0; i < size; i++) {
        int32_t h = by_high.data[i];
        order.data[starts.data[low_end(origin.data, h)]++] = h;
    }

    for (int64_t begin = 0, end; begin < size; begin = end) {
        int32_t first = order.data[begin], low, high;
        end = end_of_edge(origin, (ConstInts){order.data, size}, begin, &low, &high);
        for (int64_t i = begin; i < end; i++) twin.data[order.data[i]] = -1;
        if (end == begin + 2) {
            int32_t second = order.data[begin + 1];
            if (origin.data[first] != origin.data[second]) {
                twin.data[first] = second;
                twin.data[second] = first;
            }
        }
    }
}

/* Join what `match_halfedges` left at edges of two triangles that are there more than once, or on both sides: the i-th
 * half-edge of one with the i-th of the other in the opposite direction. So sheets that lie on each other stay whole,
 * the same ones in any order of faces. */
void join_sheets(ConstInts origin, ConstInts order, Ints twin) {
    for (int64_t begin = 0, end; begin < order.size; begin = end) {
        int32_t low, high;
        int32_t apex = origin.data[previous_halfedge(order.data[begin])], other = apex, apexes = 1;
        end = end_of_edge(origin, order, begin, &low, &high);
        for (int64_t i = begin; i < end; i++) {
            int32_t third = origin.data[previous_halfedge(order.data[i])];
            if (third == apex || third == other) continue;
            other = third;
            apexes++;
        }
        int64_t next[] = {begin, begin};
        for (int64_t i = begin; i < end && end - begin > 2 && apexes == 2; i++) {
            int32_t h = order.data[i], wanted = origin.data[previous_halfedge(h)] == apex ? other : apex;
            if (origin.data[h] != low) continue;
            for (int64_t *at = next + (wanted == apex); *at < end && twin.data[h] < 0; ++*at) {
                int32_t g = order.data[*at];
                if (origin.data[g] != high || origin.data[previous_halfedge(g)] != wanted) continue;
                twin.data[h] = g;
                twin.data[g] = h;
            }
        }
    }
}

/* Number the fans by first corner: the fan of each corner, and the vertex of each fan. Returns how many there are. */
int64_t find_fans(ConstInts origin, ConstInts twin, Ints corner, Ints vertex) {
    int64_t size = origin.size;
    for (int64_t h = 0; h < size; h++) corner.data[h] = -1;
    int32_t count = 0;
    for (int32_t start = 0; start < size; start++) {
        if (corner.data[start] >= 0) continue;
        for (int32_t h = start; h >= 0 && corner.data[h] < 0; h = twin.data[previous_halfedge(h)])
            corner.data[h] = count;
        for (int32_t h = start; twin.data[h] >= 0;) {
            h = next_halfedge(twin.data[h]);
            if (corner.data[h] >= 0) break;
            corner.data[h] = count;
        }
        vertex.data[count++] = origin.data[start];
    }
    return count;
}

/* Add a dummy vertex for every boundary loop, and its faces (b, a, dummy) for each boundary half-edge (a, b).
 * `leaving` has an entry for each fan; the full arrays have room for three half-edges more for each open edge. Returns
 * the number of dummies. */
int64_t fill_loops(ConstInts twin, ConstInts corner, Ints leaving, Ints full_twin, Ints full_corner) {
    int64_t size = twin.size, fans = leaving.size;
    /* The boundary half-edge that starts at each fan: at most one. */
    for (int64_t v = 0; v < fans; v++) leaving.data[v] = -1;
    for (int32_t h = 0; h < size; h++)
        if (twin.data[h] < 0) leaving.data[corner.data[h]] = h;
    for (int64_t h = 0; h < size; h++) {
        full_twin.data[h] = twin.data[h];
        full_corner.data[h] = corner.data[h];
    }
    int32_t dummies = 0, fill = (int32_t)size;
    for (int32_t start = 0; start < size; start++) {
        if (full_twin.data[start] >= 0) continue;
        int32_t first = fill;
        for (int32_t h = start; full_twin.data[h] < 0; h = leaving.data[corner.data[next_halfedge(h)]]) {
            int32_t a = corner.data[h], b = corner.data[next_halfedge(h)];
            full_corner.data[fill] = b;
            full_corner.data[fill + 1] = a;
            full_corner.data[fill + 2] = (int32_t)fans + dummies;
            full_twin.data[h] = fill;
            full_twin.data[fill] = h;
            /* Edge (dummy, b) of this face meets edge (b, dummy) of the face over the loop's next edge. */
            int32_t following = full_twin.data[leaving.data[b]] < 0 ? fill + 3 : first;
            full_twin.data[fill + 2] = following + 1;
            full_twin.data[following + 1] = fill + 2;
            fill += 3;
        }
        dummies++;
    }
    return dummies;
}

/* The distinct values in the order of their first appearance, by which a decoder numbers vertices (specification, C 7.2
 * and C 8.1), and the number of each value there, -1 if it does not occur; both arrays have an entry for each possible
 * value. Returns how many there are. */
int64_t number_by_appearance(ConstInts sequence, Ints order, Ints number) {
    for (int64_t v = 0; v < number.size; v++) number.data[v] = -1;
    int32_t count = 0;
    for (int64_t i = 0; i < sequence.size; i++) {
        int32_t value = sequence.data[i];
        if (number.data[value] < 0) {
            number.data[value] = count;
            order.data[count++] = value;
        }
    }
    return count;
}
