/* The part of each vertex, by those of its neighbors that are known already (specification, C 10). */
#include "bitstream/connectivity/connectivity.h"

enum {
    CANDIDATES = 4,
    INPUTS = 3,
    CONTEXTS = 16 * (CANDIDATES + 1), /* of an input, a table each */
};
INSIDE const BankPlan LABEL_BANK = {.slots = INPUTS * CONTEXTS, .selectors = CANDIDATES + 1, .inputs = INPUTS};

typedef struct {
    int32_t label[CANDIDATES], votes[CANDIDATES];
    int count;     /* of candidates */
    int64_t known; /* neighbors */
} Poll;

/* The different labels of the neighbors before v, the later neighbor first: most votes first, draws as they came. */
static void ask_neighbors(Poll *poll, ConstInts offsets, const int32_t *neighbors, const int32_t *labels, int64_t v) {
    poll->count = 0;
    poll->known = 0;
    for (int64_t i = offsets.data[v + 1]; i-- > offsets.data[v];) {
        int32_t w = neighbors[i];
        if (w >= v) continue;
        poll->known++;
        int k = 0;
        while (k < poll->count && poll->label[k] != labels[w]) k++;
        if (k < poll->count) {
            poll->votes[k]++;
        } else if (k < CANDIDATES) {
            poll->label[k] = labels[w];
            poll->votes[k] = 1;
            poll->count++;
        }
    }
    for (int a = 1; a < poll->count; a++)
        for (int b = a; b > 0 && poll->votes[b] > poll->votes[b - 1]; b--) {
            int32_t label = poll->label[b], votes = poll->votes[b];
            poll->label[b] = poll->label[b - 1];
            poll->votes[b] = poll->votes[b - 1];
            poll->label[b - 1] = label;
            poll->votes[b - 1] = votes;
        }
}

/* Code one label, which is at most `used`; a reader ignores it. */
INLINE int64_t code_label(
    RangeCoder *coder, const Bank *bank, const Poll *poll, int64_t label, int64_t used, int64_t parts) {
    for (int k = 0; k < poll->count; k++) {
        int64_t others = poll->known - poll->votes[k];
        const int64_t contexts[INPUTS] = {
            16 * k + least(poll->known, 15),
            CONTEXTS + 16 * k + least(poll->votes[k], 7) + (poll->count > k + 1 ? 8 : 0),
            2 * CONTEXTS + 16 * k + least(others, 3) + 4 * (poll->count - 1),
        };
        if (code_mixed_bit(coder, bank, INPUTS, contexts, 0, k, label == poll->label[k])) return poll->label[k];
    }
    const int64_t contexts[INPUTS] = {
        16 * CANDIDATES,
        CONTEXTS + 16 * CANDIDATES + poll->count,
        2 * CONTEXTS + 16 * CANDIDATES + (used < parts),
    };
    bool fresh = code_mixed_bit(coder, bank, INPUTS, contexts, 0, CANDIDATES, label == used);
    return fresh || used == 0 ? used : code_uniform(coder, label, used);
}

/* Code all labels in place, over a graph in compressed rows. Returns how many distinct ones there are, or -1 where the
 * data is beyond its end or has more than `parts`. */
int64_t code_labels(
    RangeCoder *coder, const Bank *bank, ConstInts offsets, ConstInts neighbors, Ints labels, int64_t parts) {
    int64_t used = 0;
    for (int64_t v = 0; v < labels.size && used >= 0; v++) {
        Poll poll;
        ask_neighbors(&poll, offsets, neighbors.data, labels.data, v);
        int64_t label = code_label(coder, bank, &poll, labels.data[v], used, parts);
        labels.data[v] = (int32_t)label;
        used += label == used;
        if (used > parts || overran(coder)) used = -1;
    }
    return used;
}
