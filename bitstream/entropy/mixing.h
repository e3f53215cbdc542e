/* Decisions predicted by several contexts at once, which learn from what is coded (specification, C 2).
 *
 * A slot is an adaptive probability. A context is the index of the first slot of a span; decision number `node` of a
 * symbol uses slot `context + node` of each context, and row `selector + node` of the mixing weights. The number of
 * inputs is a constant wherever speed matters, so that the loops over them are unrolled.
 */
#ifndef BSM_MIXING_H
#define BSM_MIXING_H

#include "bitstream/entropy/range_coder.h"
#include "bitstream/entropy/tables.h"

enum { SLOT_BITS = 22, MOST_INPUTS = 16, MOST_RATE = 1024 };

/* As Python keeps it; settings: largest count, learning rate of the mixer, initial weight, initial slot. */
typedef struct {
    Words slots;
    Ints2 weights;
    Longs settings;
} Bank;

typedef struct {
    uint32_t *slots;
    int32_t *weights;
    int32_t limit, rate;
} Mixer;

/* False for a bank without all the slots, weights and settings that a kernel uses. */
INLINE bool open_bank(Mixer *mixer, Bank bank, int64_t slots, int64_t selectors, int inputs) {
    if (bank.slots.size < slots || bank.weights.rows < selectors || bank.weights.columns != inputs
        || bank.settings.size < 2)
        return false;
    int64_t limit = bank.settings.data[0], rate = bank.settings.data[1];
    *mixer = (Mixer){bank.slots.data, bank.weights.data, (int32_t)limit, (int32_t)rate};
    return limit > 0 && limit < 1 << SLOT_COUNT_BITS && rate > 0 && rate <= MOST_RATE;
}

/* Log-odds of what a slot predicts, in 1 / 256 nat (C 2.2). */
INLINE int32_t slot_odds(uint32_t slot) { return STRETCH[slot >> (32 - STRETCH_BITS)]; }

/* Probability of log-odds, beyond the table that of its ends (C 2.1). */
INLINE uint32_t squashed(int64_t odds) {
    return SQUASH[(odds < -SQUASH_REACH ? -SQUASH_REACH : least(odds, SQUASH_REACH - 1)) + SQUASH_REACH];
}

/* A weight after an outcome that was `error` (times the rate) off (C 2.5). */
INLINE int32_t trained(int32_t weight, int64_t input, int64_t error) {
    return (int32_t)((uint32_t)weight + (uint32_t)((input * error + (1 << 19)) >> 20));
}

/* Move a slot towards an outcome (C 2.6). */
INLINE void learn_slot(uint32_t *slot, int bit, int32_t limit) {
    int64_t value = *slot >> SLOT_COUNT_BITS, target = bit ? (1 << SLOT_BITS) - 1 : 0;
    int32_t count = *slot & ((1 << SLOT_COUNT_BITS) - 1);
    value += ((target - value) * RECIPROCAL[count]) >> 16;
    *slot = (uint32_t)value << SLOT_COUNT_BITS | (uint32_t)(count + (count < limit));
}

/* Probability of a one, in 1 .. ONE - 1, and the log-odds of each input (C 2.4). */
INLINE uint32_t mixed_probability(
    const Mixer *mixer, int inputs, const int64_t *contexts, int64_t node, int64_t selector, int32_t *stretched) {
    const int32_t *weights = mixer->weights + (selector + node) * inputs;
    int64_t total = 0;
    for (int i = 0; i < inputs; i++) {
        stretched[i] = slot_odds(mixer->slots[contexts[i] + node]);
        total += (int64_t)stretched[i] * weights[i];
    }
    return squashed(total >> 16);
}

/* Predict a decision from all contexts, code it, and learn from it (C 2.5, C 2.6). */
SHARED int code_mixed_bit(RangeCoder *coder, const Mixer *mixer, int inputs, const int64_t *contexts, int64_t node,
    int64_t selector, int bit) {
    int32_t stretched[MOST_INPUTS];
    uint32_t probability = mixed_probability(mixer, inputs, contexts, node, selector, stretched);
    bit = code_bit(coder, probability, bit);

    int64_t error = ((int64_t)bit * ONE - probability) * mixer->rate;
    int32_t *weights = mixer->weights + (selector + node) * inputs;
    for (int i = 0; i < inputs; i++) {
        weights[i] = trained(weights[i], stretched[i], error);
        learn_slot(mixer->slots + contexts[i] + node, bit, mixer->limit);
    }
    return bit;
}

#endif
