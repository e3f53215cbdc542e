/* The range coder: decisions and uniform numbers, in integers only (specification, C 1).
 *
 * One function serves both directions: a coder either writes or reads, and that is data inside it. What is coded is
 * passed in and returned; a reader ignores what is passed in. A kernel loads the coder of Python into a RangeCoder at
 * its start (open_coder) and stores it at its end (close_coder).
 */
#ifndef BSM_RANGE_CODER_H
#define BSM_RANGE_CODER_H

#include "bitstream/kernel.h"

enum { ONE_BITS = 16, ONE = 1 << ONE_BITS }; /* probabilities are 1 .. ONE - 1 */

/* As Python keeps it: low end (writing) or code minus low end (reading), range, position, direction, overflow. */
typedef struct {
    Longs state;
    Bytes data;
} Coder;

enum { CODER_LOW, CODER_RANGE, CODER_POSITION, CODER_READING, CODER_FULL, CODER_STATES };

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

/* False for a state that no coder of these functions has. */
INLINE bool open_coder(RangeCoder *coder, Coder given) {
    if (given.state.size < CODER_STATES) return false;
    const int64_t *state = given.state.data;
    *coder = (RangeCoder){given.data.data, given.data.size, state[CODER_POSITION], (uint64_t)state[CODER_LOW],
        (uint64_t)state[CODER_RANGE], state[CODER_READING] != 0, state[CODER_FULL] != 0};
    return coder->range >= CODER_TOP && (coder->range | coder->low) >> 32 == 0 && coder->position >= 0
        && (is_reading(coder) || coder->position <= coder->size);
}

INLINE void close_coder(const RangeCoder *coder, Coder given) {
    int64_t *state = given.state.data;
    state[CODER_LOW] = (int64_t)coder->low;
    state[CODER_RANGE] = (int64_t)coder->range;
    state[CODER_POSITION] = coder->position;
    state[CODER_FULL] = coder->full;
}

/* Whether the coder reads, or can write at least `capacity` bytes more. */
INLINE bool has_room(const RangeCoder *coder, int64_t capacity) {
    return is_reading(coder) || coder->position + capacity < coder->size;
}

/* Whether more was read than any complete payload of this length can hold (C 1.6). */
INLINE bool overran(const RangeCoder *coder) { return is_reading(coder) && coder->position > coder->size + 4; }

/* Shift bytes out of (or into) the range until it is large again: at most two of them after one decision (C 1.3). */
INLINE void renormalise(RangeCoder *coder) {
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
    if (coder->range < CODER_TOP) renormalise(coder);
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
    if (coder->range < CODER_TOP) renormalise(coder);
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

#endif
