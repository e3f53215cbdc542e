/* Permutations and corner rotations (specification, C 9.2 to C 9.4). */
#include "bitstream/connectivity/connectivity.h"


enum {
    UNARY = 6,
    SAME = SIGNED_SPAN(UNARY), /* node of the decision whether a step is the one before */
    SPAN = SAME + 1,
    INPUTS = 4,
    CLASSES = 32,
    STEP_SLOTS = (1 + CLASSES + 2 * CLASSES * CLASSES) * SPAN,
    TURN_SLOTS = 3 * (9 + 27),
};
INSIDE const BankPlan STEP_BANK = {.slots = STEP_SLOTS, .selectors = SPAN, .inputs = INPUTS};
INSIDE const BankPlan TURN_BANK = {.slots = TURN_SLOTS, .selectors = 2, .inputs = 2};

/* How many of the positions before `position` are left: `tree` is a Fenwick tree of what is left. */
static int64_t count_before(const int32_t *tree, int64_t position) {
    int64_t total = 0;
    for (; position > 0; position &= position - 1) total += tree[position];
    return total;
}

/* Find the position that has `rank` others left before it, and use it up. */
static int32_t take(Ints tree, int64_t rank) {
    int64_t size = tree.size - 1, step = 1, position = 0;
    while (2 * step <= size) step *= 2;
    for (; step > 0; step >>= 1)
        if (position + step <= size && tree.data[position + step] <= rank) {
            position += step;
            rank -= tree.data[position];
        }
    for (int64_t k = position + 1; k <= size; k += k & -k) tree.data[k]--;
    return (int32_t)position;
}

/* Sign and magnitude of a step, coarsely: 0 .. 31 (C 9.3). */
static int64_t class_of(int64_t step) {
    int64_t magnitude = step < 0 ? -step : step, size = 0;
    for (; magnitude > 0 && size < 15; magnitude >>= 1) size++;
    return step >= 0 ? size : 16 + size;
}

/* Code the permutation `values`; `tree` has an entry more. False for nonsense. */
bool code_steps(RangeCoder *coder, const Bank *bank, Ints values, Ints tree) {
    int64_t size = values.size;
    for (int64_t k = 0; k <= size; k++) tree.data[k] = (int32_t)(k & -k);
    int64_t expected = 0, repeated = 0, last = 0, older = 0, oldest = 0;
    bool legal = true;
    for (int64_t i = 0; i < size && legal; i++) {
        int64_t rank = count_before(tree.data, expected);
        int64_t step = is_reading(coder) ? 0 : count_before(tree.data, values.data[i]) - rank;
        const int64_t contexts[INPUTS] = {
            0,
            SPAN * (1 + last),
            SPAN * (1 + CLASSES + CLASSES * older + last),
            SPAN * (1 + CLASSES + CLASSES * CLASSES + CLASSES * oldest + older),
        };
        if (code_mixed_bit(coder, bank, INPUTS, contexts, SAME, 0, step == repeated)) step = repeated;
        else step = code_signed(coder, bank, INPUTS, contexts, 0, UNARY, step);
        legal = rank + step >= 0 && rank + step < size - i && !overran(coder);
        if (legal) {
            values.data[i] = take(tree, rank + step);
            expected = values.data[i] + 1;
            oldest = older;
            older = last;
            last = class_of(step);
            repeated = step;
        }
    }
    return legal;
}

/* Code rotations, 0 to 2. */
void code_turns(RangeCoder *coder, const Bank *bank, Ints values) {
    int history = 0;
    for (int64_t i = 0; i < values.size && !overran(coder); i++) {
        const int64_t contexts[2] = {3 * (history % 9), 3 * (9 + history)};
        int value = code_mixed_bit(coder, bank, 2, contexts, 0, 0, values.data[i] > 0);
        if (value) value += code_mixed_bit(coder, bank, 2, contexts, 1, 0, values.data[i] > 1);
        values.data[i] = value;
        history = (history * 3 + value) % 27;
    }
}
