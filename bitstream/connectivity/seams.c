/* Which fans are the same vertex (specification, C 7.2 to C 7.5), and faces that repeat a corner (C 8). */
#include "bitstream/connectivity/connectivity.h"

enum {
    CANDIDATES = 8,
    CANDIDATE = 16, /* first context of the candidates; those before tell whether a vertex was met before */
    FAN_SLOTS = CANDIDATE + 2 * CANDIDATES,
};
INSIDE const BankPlan FAN_BANK = {.slots = FAN_SLOTS, .selectors = 1, .inputs = 1};

/* What is known of a neighbor along the boundary: nothing, a vertex that was new, or one that was not. */
INLINE int state_of(const Seams *seams, int32_t fan) {
    if (fan < 0 || seams->vertex.data[fan] < 0) return 0;
    return seams->sibling.data[fan] < 0 ? 1 : 2;
}

/* List the vertices along the boundary next to all fans of the vertices next to `fan`, opposite direction first. */
static int find_candidates(const Seams *seams, int32_t fan, int32_t *candidates) {
    const int32_t *vertex = seams->vertex.data, *after = seams->after.data, *before = seams->before.data;
    int number = 0;
    for (int side = 0; side < 2; side++) {
        int32_t neighbor = side == 0 ? after[fan] : before[fan];
        if (neighbor < 0 || vertex[neighbor] < 0) continue;
        int32_t other = seams->latest.data[vertex[neighbor]];
        for (int visit = 0; visit < CANDIDATES && other >= 0; visit++) {
            for (int turn = 0; turn < 2; turn++) {
                int32_t beyond = turn == side ? before[other] : after[other];
                if (number == CANDIDATES || beyond < 0 || vertex[beyond] < 0) continue;
                bool fresh = vertex[beyond] != vertex[neighbor];
                for (int k = 0; k < number; k++) fresh = fresh && candidates[k] != vertex[beyond];
                if (fresh) candidates[number++] = vertex[beyond];
            }
            other = seams->sibling.data[other];
        }
    }
    return number;
}

/* Code a vertex below `count`: one of the candidates, or by number. */
static int32_t code_vertex(
    RangeCoder *coder, const Bank *bank, const Seams *seams, int32_t fan, int32_t given, int32_t count) {
    int32_t candidates[CANDIDATES];
    int number = find_candidates(seams, fan, candidates);
    for (int k = 0; k < number; k++) {
        int64_t context = CANDIDATE + 2 * k + (number > 1);
        if (code_mixed_bit(coder, bank, 1, &context, 0, 0, given == candidates[k])) return candidates[k];
    }
    return (int32_t)code_uniform(coder, given, count);
}

/* Code the vertex of every fan; `known` tells a writer. Returns the number of vertices, or -1 for nonsense. */
int64_t code_fans(RangeCoder *coder, const Bank *bank, ConstInts known, Seams seams) {
    int64_t size = known.size;
    for (int64_t fan = 0; fan < size; fan++) seams.vertex.data[fan] = seams.sibling.data[fan] = -1;
    int32_t count = 0;
    for (int32_t fan = 0; fan < size && !overran(coder); fan++) {
        int32_t after = seams.after.data[fan], before = seams.before.data[fan], u = known.data[fan];
        /* 0 inside, else 1 to 9: each neighbor along the boundary is not known yet, or new, or a repetition. */
        int64_t context = after < 0 ? 0 : 1 + 3 * state_of(&seams, after) + state_of(&seams, before);
        if (code_mixed_bit(coder, bank, 1, &context, 0, 0, u < count) && count > 0) {
            u = code_vertex(coder, bank, &seams, fan, u, count);
            seams.sibling.data[fan] = seams.latest.data[u];
        } else {
            u = count++;
        }
        seams.vertex.data[fan] = u;
        seams.latest.data[u] = fan;
    }
    return overran(coder) ? -1 : count;
}

/* Code the corners of degenerate faces, each a vertex below `count` or the next new one. Fills `corners` when reading.
 * Returns the number of vertices afterwards, or -1 for nonsense. */
int64_t code_degenerate(RangeCoder *coder, Ints corners, int64_t count) {
    bool legal = true;
    for (int64_t i = 0; i < corners.size && legal; i += 3) {
        int32_t *face = corners.data + i;
        for (int k = 0; k < 3; k++) {
            face[k] = (int32_t)code_uniform(coder, face[k], count + 1);
            count += face[k] == count;
        }
        legal = !overran(coder) && (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]);
    }
    return legal ? count : -1;
}
