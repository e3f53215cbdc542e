/* One integer, given predictions of it (specification, V 3 to V 5).
 *
 * In: up to seven predictions in sixteenths, and contexts. Out: the integer, by binary decisions. First it is asked
 * whether a prediction is right, for those that often were; then the side and the distance from the best guess, in
 * classes that grow. For every decision each prediction gives odds, from a heavy-tailed distribution around it whose
 * width it has learnt; a logistic mixer adds them to the odds of the contexts and learns which to believe (as in PAQ,
 * M. Mahoney 2005). So a bad prediction costs little, and no rule has to say which one holds where. Tables replace
 * logarithms, and all sums are integers of 32 bits, so that vectors of any width give the same bits. Most of a
 * decoder's time for grids is spent here: lanes are predictions, not decisions, which depend on each other. */
#include "bitstream/fields/fields.h"

#if KERNEL_ISA == 4 || (defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__))
#define BSM_WIDE
#include <immintrin.h>
#endif

enum {
    RATE = 9,        /* of the mixing weights */
    SLOT_LIMIT = 400, /* uses after which a slot learns at a constant rate */
    HIT_LIMIT = 60,
    SCALE_LIMIT = 255,
    MOST_ODDS = 2047,
    ASK_FROM = (1 << SLOT_BITS) / 6, /* hit rate from which a prediction is asked for */
    REACH = 1 << 22,                 /* where the classes of the distance end */
};

/* A number of each prediction, all in one vector where registers are long (and what the last lane holds does not
 * matter); one by one elsewhere. */
#ifdef BSM_WIDE
typedef __attribute__((vector_size(32))) int32_t Number;
typedef __attribute__((vector_size(64))) int64_t Long;
typedef __attribute__((vector_size(64))) double Inverse;
typedef __attribute__((vector_size(32), __aligned__(4), may_alias)) int32_t UnalignedNumber;
enum { PARTS = 1, INPUT_PARTS = WEIGHT_ROW / 8 };
#define LANE(x, i) (x)[0][i]
#else
typedef int32_t Number;
typedef int32_t UnalignedNumber;
typedef int64_t Inverse;
enum { PARTS = PREDICTIONS, INPUT_PARTS = WEIGHT_ROW };
#define LANE(x, i) (x)[i]
#endif

#define EACH_PART(i) for (int i = 0; i < PARTS; i++)

typedef struct { /* a value under way */
    RangeCoder *coder;
    const ValueModel *model;
    const Expectation *e;
    Number prediction[PARTS];
    Inverse inverse[PARTS]; /* of the scales: 2^38 by 1/4096 */
    Number input[INPUT_PARTS];
    uint32_t hits[MODEL_ROW]; /* of each prediction */
} Coder;

INLINE Number numbers_at(const int32_t *row, int i) { return ((const UnalignedNumber *)row)[i]; }

#ifdef BSM_WIDE
INLINE Number smaller(Number x, int32_t y) { return (Number)_mm256_min_epi32((__m256i)x, _mm256_set1_epi32(y)); }
INLINE Number larger(Number x, int32_t y) { return (Number)_mm256_max_epi32((__m256i)x, _mm256_set1_epi32(y)); }
INLINE Number sizes_of(Number x) { return (Number)_mm256_abs_epi32((__m256i)x); }
INLINE Long as_longs(Number x) { return (Long)_mm512_cvtepi32_epi64((__m256i)x); }
INLINE Number as_numbers(Long x) { return (Number)_mm512_cvtepi64_epi32((__m512i)x); }
INLINE Inverse as_doubles(Number x) { return (Inverse)_mm512_cvtepi32_pd((__m256i)x); }
INLINE Inverse whole_of(Inverse x) { return (Inverse)_mm512_cvtepi64_pd(_mm512_cvttpd_epi64((__m512d)x)); }

/* As below; a product that is not exact is beyond 2^53, and so beyond both ends of the table. */
INLINE Number survival(Number distance, Inverse inverse) {
    __m512d z = (__m512d)(as_doubles(distance) * inverse);
    z = _mm512_min_pd(_mm512_max_pd(z, _mm512_set1_pd(-0x1p34)), _mm512_set1_pd(0x1p40));
    Number place = (Number)_mm512_cvttpd_epi32((__m512d)((Inverse)z * 0x1p-20 + 0x1p14));
    Number cell = smaller(place >> 5, 2 * SURVIVAL_REACH - 1);
    Long pair = (Long)_mm512_i32gather_epi64((__m256i)cell, (const void *)SURVIVAL, 4);
    Number from = as_numbers(pair), slope = as_numbers(pair >> 32) - from;
    return from + (slope * (place - (cell << 5)) >> 5);
}

/* The exponent is that of a float, which cannot be rounded up: the bit below the first is cleared. */
INLINE Number entry(Number d) {
    d = larger(d, 0);
    Number x = d | 32, bits = (Number)_mm256_cvtepi32_ps((__m256i)(x & ~(x >> 1))), exponent = (bits >> 23) - 132;
    return smaller((exponent << 5) + (d >> exponent), ODDS_SIZE - 1);
}

INLINE Number entries_of(const int16_t *table, Number at) {
    Number pair = (Number)_mm256_i32gather_epi32((const void *)table, (__m256i)(at >> 1), 4);
    return pair << (~at & 1) * 16 >> 16;
}
INLINE Number odds_of(Number d) { return entries_of(ODDS, entry(d)); }
INLINE Number less_of(Number d) { return entries_of(LESS, entry(d)); }

/* As below: quotients of whole doubles below 2^52 are as whole as those of integers. */
INLINE Inverse inverse_of(Number scale, Number count, int32_t first, int32_t *typical) {
    Inverse mean = (as_doubles(scale) * as_doubles(count) + (double)first * 512) / as_doubles(count + 2);
    mean = (Inverse)_mm512_max_pd((__m512d)whole_of(mean), _mm512_set1_pd(256));
    *typical = (int32_t)((int64_t)mean[PREDICTIONS - 1] >> 8);
    return whole_of(0x1p38 / mean);
}

INLINE void set_contexts(Coder *w, uint32_t *const *slots, int contexts) {
    bool all = contexts == CONTEXTS;
    w->input[0][CONSTANT_INPUT] = 256;
    w->input[1] = (Number){slot_odds(*slots[0]), slot_odds(*slots[1]), slot_odds(*slots[2]), slot_odds(*slots[3]),
        all ? slot_odds(*slots[4]) : 0, all ? slot_odds(*slots[5]) : 0};
}

INLINE int64_t weighed(const Number *input, const int32_t *own, const int32_t *other, int inputs) {
    (void)inputs;
    Long sum = as_longs(input[0]) * (as_longs(numbers_at(own, 0)) + as_longs(numbers_at(other, 0)))
        + as_longs(input[1]) * (as_longs(numbers_at(own, 1)) + as_longs(numbers_at(other, 1)));
    return _mm512_reduce_add_epi64((__m512i)sum);
}

/* Products are below 2^31; weights are added modulo 2^32. */
INLINE void train(int32_t *weights, const Number *input, int32_t error, int inputs) {
    (void)inputs;
    for (int i = 0; i < 2; i++) {
        __m256i change = (__m256i)((input[i] * error + (1 << 19)) >> 20);
        ((UnalignedNumber *)weights)[i] = (Number)_mm256_add_epi32((__m256i)numbers_at(weights, i), change);
    }
}
#else
INLINE Number smaller(Number x, int32_t y) { return x < y ? x : y; }
INLINE Number larger(Number x, int32_t y) { return x > y ? x : y; }
INLINE Number sizes_of(Number x) { return size_of(x); }

/* -ln of the probability that an error exceeds `distance` (1/16), in 2^-16 nat (V 4.1). */
INLINE int32_t survival(int64_t distance, int64_t inverse) {
    const int32_t *table = SURVIVAL + SURVIVAL_REACH;
    int64_t z = distance * inverse >> 20; /* 1/1024 of the scale */
    if (z >= 32 * SURVIVAL_REACH) {
        int64_t beyond = least(z, 1 << 20) - 32 * SURVIVAL_REACH;
        return table[SURVIVAL_REACH] + (int32_t)(beyond * (table[SURVIVAL_REACH] - table[SURVIVAL_REACH - 1]) >> 5);
    }
    if (z < -32 * SURVIVAL_REACH) z = -32 * SURVIVAL_REACH;
    int32_t cell = (int32_t)(z >> 5), part = (int32_t)(z & 31);
    return table[cell] + ((table[cell + 1] - table[cell]) * part >> 5);
}

/* Entry of ODDS and LESS for d (V 4.2): d itself below 32. */
INLINE int32_t entry(int32_t d) {
    d = d < 0 ? 0 : d;
    int32_t exponent = bit_length((uint32_t)d | 32) - 6;
    return (int32_t)least((exponent << 5) + (d >> exponent), ODDS_SIZE - 1);
}

INLINE int32_t odds_of(int32_t d) { return ODDS[entry(d)]; }
INLINE int32_t less_of(int32_t d) { return LESS[entry(d)]; }

/* 2^38 by a mean size of errors, the expected one counting as if seen twice. */
INLINE Inverse inverse_of(Number scale, Number count, int32_t first, int32_t *typical) {
    int64_t mean = largest(((int64_t)scale * count + ((int64_t)first << 9)) / (count + 2), 256);
    *typical = (int32_t)(mean >> 8);
    return (INT64_C(1) << 38) / mean;
}

INLINE void set_contexts(Coder *w, uint32_t *const *slots, int contexts) {
    w->input[CONSTANT_INPUT] = 256;
    for (int i = 0; i < contexts; i++) w->input[CONSTANT_INPUT + 1 + i] = slot_odds(*slots[i]);
}

INLINE int64_t weighed(const int32_t *input, const int32_t *own, const int32_t *other, int inputs) {
    int64_t total = 0;
    for (int i = 0; i < inputs; i++) total += input[i] * ((int64_t)own[i] + other[i]);
    return total;
}

INLINE void train(int32_t *weights, const int32_t *input, int32_t error, int inputs) {
    for (int i = 0; i < inputs; i++) weights[i] = trained(weights[i], input[i], error);
}
#endif

INLINE void set_input(Coder *w, int i, Number odds) { w->input[i] = smaller(larger(odds, -MOST_ODDS), MOST_ODDS); }

/* Mix a decision, code it and learn from it; the inputs of the predictions are set (V 4.4). The number of contexts is a
 * constant wherever this is called, so that loops are unrolled. */
INLINE int decide_by(Coder *w, int node, int kind, int bit, int contexts) {
    uint32_t *slots[CONTEXTS];
    int inputs = PREDICTIONS + 1 + contexts;
    for (int i = 0; i < contexts; i++)
        slots[i] = w->model->slots.data + (i * CONTEXT_SIZE + w->e->context[i]) * VALUE_NODES + node;
    set_contexts(w, slots, contexts);
    int32_t *own = w->model->weights.data + node * WEIGHT_ROW;
    int32_t *other = w->model->weights.data + (VALUE_NODES + w->e->set * KINDS + kind) * WEIGHT_ROW;
    uint32_t probability = squashed(weighed(w->input, own, other, inputs) >> 16);
    bit = code_bit(w->coder, probability, bit);

    int32_t error = (bit * ONE - (int32_t)probability) * RATE;
    train(own, w->input, error, inputs);
    train(other, w->input, error, inputs);
    for (int i = 0; i < contexts; i++) learn_slot(slots[i], bit, SLOT_LIMIT);
    return bit;
}

OFTEN static int decide(Coder *w, int node, int kind, int bit) {
    return w->e->contexts == CONTEXTS ? decide_by(w, node, kind, bit, CONTEXTS)
        : decide_by(w, node, kind, bit, TWIN_CONTEXTS);
}

INLINE int32_t first_scale(const Expectation *e) { return e->scale < 2 ? 2 : e->scale; }

/* The learned sizes of errors, the expected one counting as if seen twice; returns that of the guess, 1/16 (V 5.3). */
INLINE int32_t find_scales(Coder *w) {
    const Expectation *e = w->e;
    const int32_t *row = w->model->scales.data + MODEL_ROW * e->scale_context;
    const uint32_t *hits = w->model->hits.data + MODEL_ROW * e->hit_context;
    int32_t typical = 0;
    Number mean[PARTS], count[PARTS];
    EACH_PART(i) {
        mean[i] = numbers_at(row, i);
        count[i] = mean[i] * 0 + row[PREDICTIONS];
    }
    for (int j = 0; j < PREDICTIONS; j++) w->hits[j] = hits[j];
    for (int i = 0; i < TWIN_PREDICTIONS && e->contexts != CONTEXTS; i++) { /* V 17.7 */
        if (e->twin[i] < 0) continue;
        const int32_t *own = w->model->twins.data + TWIN_ROW * e->twin[i];
        LANE(mean, TWIN_AT[i]) = own[0];
        LANE(count, TWIN_AT[i]) = own[1];
        w->hits[TWIN_AT[i]] = (uint32_t)own[2];
    }
    EACH_PART(i) {
        w->prediction[i] = numbers_at(e->prediction, i);
        w->inverse[i] = inverse_of(mean[i], count[i], first_scale(e), &typical);
    }
    return typical;
}

/* Is the value one of the predictions that often are exact? What was asked goes to `asked` (V 5.4). */
INLINE bool ask(Coder *w, int32_t *value, int32_t *asked, int *asks) {
    const Expectation *e = w->e;
    const uint32_t *hits = w->hits;
    int open = (1 << PREDICTIONS) - 1;
    for (*asks = 0; *asks < e->refutations; *asks += 1) {
        asked[*asks] = e->refuted[*asks];
        open &= ~hits_of(e, asked[*asks]);
    }
    while (*asks < MOST_ASKS && open != 0) {
        int best = 0;
        uint32_t rate = 0;
        for (int j = 0; j < PREDICTIONS; j++) {
            uint32_t own = hits[j] >> SLOT_COUNT_BITS;
            if ((open >> j & 1) && own > rate) best = j, rate = own;
        }
        if (rate < ASK_FROM) return false;
        int32_t candidate = whole(e->prediction[best]);
        open &= ~hits_of(e, candidate);
        EACH_PART(i) {
            Number away = sizes_of(candidate * FINE - w->prediction[i]);
            Number inner = survival(away - FINE / 2, w->inverse[i]), outer = survival(away + FINE / 2, w->inverse[i]);
            set_input(w, i, -odds_of(inner - less_of(outer - inner) * 256));
        }
        asked[*asks] = candidate;
        *asks += 1;
        if (decide(w, ASK_NODE + 2 * best + (*asks > 1), 0, *value == candidate)) {
            *value = candidate;
            return true;
        }
    }
    return false;
}

/* On which side of `start` less a half? (V 5.3) */
INLINE int choose_side(Coder *w, int32_t start, int node, int up) {
    EACH_PART(i) {
        Number away = start * FINE - FINE / 2 - w->prediction[i];
        set_input(w, i, (survival(-away, w->inverse[i]) - survival(away, w->inverse[i])) >> 8);
    }
    return decide(w, node, 1, up);
}

/* Is it in the outer half of the 2^(rest + 1) distances from `inner`, whose inner end is `edge`? (V 5.5) */
INLINE int choose_half(Coder *w, int32_t edge, int direction, int32_t inner, int rest, int node, int kind, int outer) {
    int32_t half = 1 << (rest + 4);
    EACH_PART(i) {
        Number near = direction * (edge - w->prediction[i]) + inner * FINE, middle = near + half, far = middle + half;
        Number side = (middle >> 31) | 1; /* survival is symmetric: what is behind the prediction is turned round */
        Number turned = middle >> 31, a = (near & ~turned) | (-far & turned), c = (far & ~turned) | (-near & turned);
        Number b = survival(sizes_of(middle), w->inverse[i]);
        Number odds = less_of(survival(c, w->inverse[i]) - b) - odds_of(b - survival(a, w->inverse[i]));
        set_input(w, i, odds * side);
    }
    return decide(w, node, kind, outer);
}

/* The distance from `from` outwards: its class, then its place in the class (V 5.4, V 5.5). */
INLINE int64_t code_distance(
    Coder *w, int32_t from, int direction, int k, const int32_t *asked, int asks, int64_t distance) {
    int32_t edge = from * FINE - direction * (FINE / 2), first = 0, next;
    Number inner[PARTS];
    EACH_PART(i) inner[i] = survival(direction * (edge - w->prediction[i]), w->inverse[i]);
    int class = 0, size;
    for (;; class++, first = next) {
        size = k + (class < 4 ? 0 : class / 2 - 1);
        next = first + (1 << size);
        if (next > REACH) break;
        bool known = false; /* a class of one value that was asked for already */
        for (int i = 0; i < asks; i++) known |= size == 0 && asked[i] == from + direction * first;
        int32_t far = edge + direction * next * FINE;
        EACH_PART(i) {
            Number outer = survival(direction * (far - w->prediction[i]), w->inverse[i]);
            set_input(w, i, -odds_of(outer - inner[i]));
            inner[i] = outer;
        }
        int node = CLASS_NODE + 2 * (int)least(class, 14) + (direction > 0);
        if (!known && !decide(w, node, 2 + (class > 2), distance >= next)) break;
    }
    int32_t place = 0;
    for (int mixed = 0; size > 0 && mixed < 2; mixed++) {
        size--;
        int node = PLACE_NODE + 2 * (int)least(class, 8) + mixed, bit = (distance - first) >> size & 1;
        if (choose_half(w, edge, direction, first + place, size, node, 4 + mixed, bit)) place += 1 << size;
    }
    int64_t rest = INT64_C(1) << size;
    return first + place + (size > 0 ? code_uniform(w->coder, (distance - first) & (rest - 1), rest) : 0);
}

/* Learn the size of an error and whether it is none, of which `count` were seen. */
INLINE void learn_error(const Expectation *e, int j, int32_t value, uint32_t *hits, int32_t *mean, int32_t count) {
    int64_t error = (int64_t)value * FINE - e->prediction[j];
    int64_t usual = count > 0 ? *mean : (int64_t)first_scale(e) << 8;
    int64_t seen = least((error < 0 ? -error : error) << 8, 8 * usual + 4096); /* an outlier counts as eight */
    *mean += (int32_t)((least(seen, 1 << 30) - *mean) * RECIPROCAL[count] >> 16);
    learn_slot(hits, whole(e->prediction[j]) == value, HIT_LIMIT);
}

/* Hit rates and scales, after a value (V 5.9). */
INLINE void learn_errors(const Coder *w, int32_t value) {
    const Expectation *e = w->e;
    uint32_t *hits = w->model->hits.data + MODEL_ROW * e->hit_context;
    int32_t *row = w->model->scales.data + MODEL_ROW * e->scale_context, *count = row + PREDICTIONS, of_twins = 0;
    for (int i = 0; i < TWIN_PREDICTIONS && e->contexts != CONTEXTS; i++) {
        if (e->twin[i] < 0) continue;
        int32_t *own = w->model->twins.data + TWIN_ROW * e->twin[i];
        of_twins |= 1 << TWIN_AT[i];
        learn_error(e, TWIN_AT[i], value, (uint32_t *)own + 2, own, own[1]);
        if (own[1] < SCALE_LIMIT) own[1] += 1;
    }
    for (int j = 0; j < PREDICTIONS; j++)
        if (!(of_twins >> j & 1)) learn_error(e, j, value, hits + j, row + j, *count);
    if (*count < SCALE_LIMIT) *count += 1;
}

/* The slots of the contexts of a value, which are filled when they are first used. */
INLINE void begin_contexts(const ValueModel *model, const Expectation *e) {
    for (int i = 0; i < e->contexts; i++) {
        int32_t row = i * CONTEXT_SIZE + e->context[i];
        for (int node = 0; !model->begun[row] && node < VALUE_NODES; node++)
            model->slots.data[row * VALUE_NODES + node] = 1u << 31;
        model->begun[row] = 1;
    }
}

OFTEN int32_t ISA(code_value)(RangeCoder *coder, const ValueModel *model, const Expectation *e, int32_t value) {
    Coder w;
    w.coder = coder, w.model = model, w.e = e;
    begin_contexts(model, e);
    int32_t typical = find_scales(&w), asked[MOST_ASKS];
    int asks;
    if (!ask(&w, &value, asked, &asks)) {
        int32_t center = whole(e->prediction[PREDICTIONS - 1]), start = center, lean = 0;
        for (int i = 0; i < asks; i++) {
            lean += (asked[i] > center) - (asked[i] < center);
            if (asked[i] == center) start = center + 1;
        }
        int node = SIDE_NODE + (asks == 0 ? 0 : lean < 0 ? 1 : lean == 0 ? 2 : 3);
        int up = choose_side(&w, start, node, value >= start), direction = up ? 1 : -1;
        int32_t from = up ? start : center - 1;
        int k = (int)largest(bit_length((uint32_t)(typical / FINE)) - 1, 0);
        int64_t distance = code_distance(&w, from, direction, k, asked, asks, (int64_t)direction * (value - from));
        value = from + direction * (int32_t)distance;
    }
    learn_errors(&w, value);
    return value;
}
