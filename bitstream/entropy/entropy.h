/* What a range coder and its models are, and what they are coded with; most of it is inlined. */
#pragma once

#include <stdint.h>
#include "bitstream/kernel.h"

/* Tables of the mixer (specification, C 2.1, C 2.2, C 2.6), see tables.c. */
enum { SQUASH_REACH = 2880, STRETCH_BITS = 12, SLOT_COUNT_BITS = 10 };

/* Probability of log-odds, in units of 1 / 256 nat, from -SQUASH_REACH on. */
extern INSIDE uint16_t SQUASH[2 * SQUASH_REACH];
/* Log-odds of a probability, by its upper bits. */
extern INSIDE int16_t STRETCH[1 << STRETCH_BITS];
/* How much a slot learns, by how often it was used, in 1 / 65536. */
extern INSIDE uint16_t RECIPROCAL[1 << SLOT_COUNT_BITS];
void make_mixer_tables(void);
/* e^x - 1, also where that is small. */
double growth(double x);

/* The range coder: decisions and uniform numbers, in integers only (specification, C 1).
 *
 * One function serves both directions: a coder either writes or reads, and that is data inside it. What is coded is
 * passed in and returned; a reader ignores what is passed in.
 */
enum { ONE_BITS = 16, ONE = 1 << ONE_BITS }; /* probabilities are 1 .. ONE - 1 */

/* `low` is the low end (writing), or the code less the low end (reading). */
typedef struct {
    uint8_t *data;
    int64_t size, position;
    uint64_t low, range;
    bool reading, full;
} RangeCoder;

#define CODER_TOP (UINT64_C(1) << 24)

/* Whether symbols are read; known beforehand where a decoder is built alone, so that what writes can be left out. */
INLINE bool is_reading(const RangeCoder *coder) {
#ifdef BSM_DECODER
    return true;
#else
    return coder->reading;
#endif
}

/* Whether the coder reads, or can write at least `capacity` bytes more. */
INLINE bool has_room(const RangeCoder *coder, int64_t capacity) {
    return is_reading(coder) || coder->position + capacity < coder->size;
}

/* Whether more was read than any complete payload of this length can hold (C 1.6): bytes are read that much ahead. */
enum { AHEAD = 4 };
INLINE bool overran(const RangeCoder *coder) { return is_reading(coder) && coder->position > coder->size + AHEAD; }

/* Shift bytes out of (or into) the range until it is large again: at most two of them after one decision (C 1.3). */
INLINE void renormalize(RangeCoder *coder) {
    while (coder->range < CODER_TOP) {
        coder->range <<= 8;
        if (is_reading(coder)) {
            coder->low <<= 8;
            if (coder->position < coder->size) coder->low |= coder->data[coder->position];
            coder->position++;
        } else {
            if (coder->position + 1 < coder->size) coder->data[coder->position++] = (uint8_t)(coder->low >> 24);
            else coder->full = true;
            coder->low = (coder->low & (CODER_TOP - 1)) << 8;
        }
    }
}

/* Raise the low end (writing), with a carry into the bytes already written. */
INLINE void raise_low(RangeCoder *coder, uint64_t amount) {
    coder->low += amount;
    if (coder->low >> 32 != 0) {
        coder->low &= UINT32_MAX;
        int64_t k = coder->position - 1;
        while (k > 0 && coder->data[k] == 255) coder->data[k--] = 0;
        if (k >= 0) coder->data[k]++;
    }
}

/* Code a decision whose probability of a one is `probability` (C 1.2). */
INLINE int code_bit(RangeCoder *coder, uint32_t probability, int bit) {
    uint64_t bound = (coder->range * probability) >> ONE_BITS;
    if (is_reading(coder)) {
        bit = coder->low < bound;
        coder->low -= bit ? 0 : bound;
    } else if (!bit) {
        raise_low(coder, bound);
    }
    coder->range = bit ? bound : coder->range - bound;
    if (coder->range < CODER_TOP) renormalize(coder);
    return bit;
}

/* Code an integer in 0 .. count - 1; `count` at most ONE. */
INLINE uint32_t code_small_uniform(RangeCoder *coder, uint32_t value, uint32_t count) {
    uint32_t unit = (uint32_t)coder->range / count;
    if (is_reading(coder)) value = (uint32_t)coder->low / unit;
    if (value >= count) value = count - 1;
    uint64_t below = (uint64_t)value * unit;
    if (is_reading(coder)) coder->low -= below;
    else raise_low(coder, below);
    /* The last value takes what the division leaves over. */
    coder->range = value < count - 1 ? unit : coder->range - below;
    if (coder->range < CODER_TOP) renormalize(coder);
    return value;
}

/* Code an integer in 0 .. count - 1, all equally likely; `count` in 1 .. 2^32 (C 1.4). What is beyond is taken as
 * count - 1, when written too, so that what is returned is always in range. */
INLINE int64_t code_uniform(RangeCoder *coder, int64_t value, int64_t count) {
    value = value < 0 ? 0 : least(value, count - 1);
    if (count <= ONE) return code_small_uniform(coder, (uint32_t)value, (uint32_t)count);
    uint32_t high = code_small_uniform(coder, (uint32_t)(value >> 16), (uint32_t)((count - 1) >> 16) + 1);
    uint32_t low = code_small_uniform(coder, (uint32_t)value & (ONE - 1), ONE);
    return least((int64_t)high << 16 | low, count - 1);
}

/* Decisions predicted by several contexts at once, which learn from what is coded (specification, C 2).
 *
 * A slot is an adaptive probability. A context is the index of the first slot of a span; decision number `node` of a
 * symbol uses slot `context + node` of each context, and row `selector + node` of the mixing weights. The number of
 * inputs is a constant wherever speed matters, so that the loops over them are unrolled.
 */
enum { SLOT_BITS = 22, MOST_INPUTS = 16 };

/* What a bank starts from; 0 is what most have: limit 255, rate 14, probability 1 / 2. */
typedef struct {
    int64_t slots, selectors;
    int inputs, limit, rate, probability, trust;
} BankPlan;

/* `limit` is the largest count of a slot, `rate` that of learning weights. */
typedef struct {
    uint32_t *slots;
    int32_t *weights;
    int32_t limit, rate;
} Bank;

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
    const Bank *bank, int inputs, const int64_t *contexts, int64_t node, int64_t selector, int32_t *stretched) {
    const int32_t *weights = bank->weights + (selector + node) * inputs;
    int64_t total = 0;
    for (int i = 0; i < inputs; i++) {
        stretched[i] = slot_odds(bank->slots[contexts[i] + node]);
        total += (int64_t)stretched[i] * weights[i];
    }
    return squashed(total >> 16);
}

/* Predict a decision from all contexts, code it, and learn from it (C 2.5, C 2.6). */
INLINE int code_decision(RangeCoder *coder, const Bank *bank, int inputs, const int64_t *contexts, int64_t node,
    int64_t selector, int bit) {
    int32_t stretched[MOST_INPUTS];
    uint32_t probability = mixed_probability(bank, inputs, contexts, node, selector, stretched);
    bit = code_bit(coder, probability, bit);

    int64_t error = ((int64_t)bit * ONE - probability) * bank->rate;
    int32_t *weights = bank->weights + (selector + node) * inputs;
    for (int i = 0; i < inputs; i++) {
        weights[i] = trained(weights[i], stretched[i], error);
        learn_slot(bank->slots + contexts[i] + node, bit, bank->limit);
    }
    return bit;
}

/* The same, copied to its calls unless a decoder is built alone. */
SHARED int code_mixed_bit(RangeCoder *coder, const Bank *bank, int inputs, const int64_t *contexts, int64_t node,
    int64_t selector, int bit) {
    return code_decision(coder, bank, inputs, contexts, node, selector, bit);
}

/* Integers as mixed decisions (specification, C 3). */
enum { SUFFIX_NODES = 24 };

/* Nodes that an integer takes. */
#define UNSIGNED_SPAN(unary) ((unary) + SUFFIX_NODES + 2)
#define SIGNED_SPAN(unary) (UNSIGNED_SPAN(unary) + 2)

/* Code an integer in 0 .. 2^24 - 2 + unary, from `node` on: a unary prefix, then an Exp-Golomb escape (C 3.1). */
SHARED int64_t code_unsigned(RangeCoder *coder, const Bank *bank, int inputs, const int64_t *contexts,
    int64_t selector, int unary, int64_t value, int64_t node) {
    for (int k = 0; k < unary; k++)
        if (!code_mixed_bit(coder, bank, inputs, contexts, node + k, selector, value > k)) return k;
    int64_t rest = value - unary + 1;
    int size = 0;
    while (size < SUFFIX_NODES - 1
        && code_mixed_bit(coder, bank, inputs, contexts, node + unary + size, selector, rest >> (size + 1) > 0))
        size++;
    int64_t result = 1;
    if (size > 0) { /* the leading bit below the first is worth modeling, the others are noise */
        int leading = (int)(rest >> (size - 1)) & 1;
        result = 2 + code_mixed_bit(coder, bank, inputs, contexts, node + unary + SUFFIX_NODES, selector, leading);
        if (size > 1) {
            int64_t count = INT64_C(1) << (size - 1);
            result = result * count + code_uniform(coder, rest & (count - 1), count);
        }
    }
    return unary + result - 1;
}

/* Code an integer of magnitude below 2^24: zero, sign, then the rest (C 3.2). */
SHARED int64_t code_signed(RangeCoder *coder, const Bank *bank, int inputs, const int64_t *contexts,
    int64_t selector, int unary, int64_t value) {
    if (!code_mixed_bit(coder, bank, inputs, contexts, 0, selector, value != 0)) return 0;
    int negative = code_mixed_bit(coder, bank, inputs, contexts, 1, selector, value < 0);
    int64_t rest = (value < 0 ? -value : value) - 1;
    int64_t magnitude = 1 + code_unsigned(coder, bank, inputs, contexts, selector, unary, rest, 2);
    return negative ? -magnitude : magnitude;
}
