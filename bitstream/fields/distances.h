/* How far a value is from its guess: what light grids and swift attributes share (specification, V 15.2, V 15.6). */
#pragma once

#include <stddef.h>

#include "bitstream/fields/fields.h"

enum {
    LATEST = 43, /* uses after which a slot learns no slower */
    /* Nodes of decisions: slots of a row, and behind the rows of a size. */
    ZERO = 0,
    UNARY = 3,
    UNARY_SLOTS = LIGHT_ROW - UNARY,
    SIGN = LIGHT_ROW,
    LOW = SIGN + 3,
    LOW_SLOTS = LEAN_NODES - LOW,
    EVEN_CLASSES = 4, /* of one width; each that follows is twice as wide */
    MOST_REST = 1 << 21,
    LATEST_MIXED = 255,
    MIXING_RATE = 14,
};

typedef struct { /* what the decisions of a value depend on: slots of a size and a kind, or contexts that are mixed */
    RangeCoder *coder;
    uint32_t *slots;
    int32_t *weights; /* of contexts that are mixed; NULL: plain decisions */
    int32_t kind, size;
    int64_t context[LEAN_INPUTS];
} DistanceModel;

/* Code a decision by one slot (V 15.2). */
INLINE int code_plain_bit(RangeCoder *coder, uint32_t *slot, int bit) {
    bit = code_bit(coder, (uint32_t)largest(*slot >> (32 - ONE_BITS), 1), bit);
    learn_slot(slot, bit, LATEST);
    return bit;
}

INLINE int32_t size_class_of(int32_t size) { return (int32_t)least(size_class(size >> 3), LIGHT_SIZES - 1); }

/* Code a decision by one slot of a row of these, or by the contexts. */
INLINE int decide(RangeCoder *coder, const DistanceModel *m, uint32_t *row, uint32_t *slots, int node, int bit) {
    if (BSMDEC_LIGHT != 1 && m->weights != NULL) {
        Bank bank = {m->slots, m->weights, LATEST_MIXED, MIXING_RATE};
        return code_decision(coder, &bank, LEAN_INPUTS, m->context, node, 0, bit);
    }
    return code_plain_bit(coder, (node < LIGHT_ROW ? row : slots) + node, bit);
}

INLINE int32_t code_distance_by(RangeCoder *coder, const DistanceModel *m, int32_t off, int32_t distance) {
    uint32_t *span = m->slots + size_class_of(m->size) * LIGHT_SPAN;
    uint32_t *row = span + m->kind * LIGHT_ROW, *slots = span + (LIGHT_KINDS - 1) * LIGHT_ROW;
    int part = (size_of(off) > 1) + (size_of(off) > 4), width = (int)largest(bit_length((uint32_t)m->size) - 6, 0);
    if (decide(coder, m, row, slots, ZERO + part, distance == 0)) return 0;
    bool below = off < 0, negative = decide(coder, m, row, slots, SIGN + part, (distance < 0) != below) != below;
    int32_t rest = size_of(distance) - 1, start = 0, i = 0;
    while (start + (1 << width) < MOST_REST
        && decide(coder, m, row, slots, UNARY + (int)least(i, UNARY_SLOTS - 1), rest - start >= 1 << width)) {
        start += 1 << width;
        width += ++i >= EVEN_CLASSES;
    }
    if (width > 0) {
        int32_t half = 1 << (width - 1);
        if (decide(coder, m, row, slots, LOW + (int)least(i, LOW_SLOTS - 1), rest - start >= half)) start += half;
        if (half > 1) start += (int32_t)code_uniform(coder, rest - start, half);
    }
    return negative ? -1 - start : 1 + start;
}

/* Code how far a value is from its guess, `off` being the guess less that level in 1/16 (V 15.6). */
OFTEN static int32_t code_distance(const DistanceModel *m, int32_t off, int32_t distance) {
    RangeCoder coder = *m->coder; /* in registers */
    if (!is_reading(&coder)) return code_distance_by(m->coder, m, off, distance);
    coder.reading = true;
    distance = code_distance_by(&coder, m, off, distance);
    *m->coder = coder;
    return distance;
}
