/* One integer, given predictions of it (specification, V 3 to V 5). */
#include "bitstream/fields/fields.h"


enum {
    RATE = 9,        /* of the mixing weights */
    SLOT_LIMIT = 400, /* uses after which a slot learns at a constant rate */
    HIT_LIMIT = 60,
    SCALE_LIMIT = 255,
    MOST_ODDS = 2047,
    ASK_FROM = (1 << SLOT_BITS) / 6, /* hit rate from which a prediction is asked for */
    REACH = 1 << 22,                 /* where the classes of the distance end */
};

typedef struct { /* a value under way */
    RangeCoder *coder;
    const ValueModel *model;
    const Expectation *e;
    int64_t inverse[PREDICTIONS]; /* of the scales: 2^38 by 1/4096 */
    int32_t input[VALUE_INPUTS];
} Work;

bool fits_values(const ValueModel *model) {
    return model->slots.size == CONTEXTS * CONTEXT_SIZE * VALUE_NODES && model->hits.size == PREDICTIONS * HIT_CONTEXTS
        && model->weights.rows == VALUE_NODES + WEIGHT_SETS * KINDS && model->weights.columns == VALUE_INPUTS
        && model->scales.rows == PREDICTIONS * SCALE_CONTEXTS && model->scales.columns == 2;
}

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

/* Mix a decision, code it and learn from it; the inputs of the predictions are set (V 4.4). */
OFTEN static int decide(Work *w, int node, int kind, int bit) {
    uint32_t *slots[CONTEXTS];
    for (int i = 0; i < CONTEXTS; i++) {
        slots[i] = w->model->slots.data + (i * CONTEXT_SIZE + w->e->context[i]) * VALUE_NODES + node;
        w->input[PREDICTIONS + i] = slot_odds(*slots[i]);
    }
    w->input[VALUE_INPUTS - 1] = 256;
    int32_t *own = w->model->weights.data + node * VALUE_INPUTS;
    int32_t *other = w->model->weights.data + (VALUE_NODES + w->e->set * KINDS + kind) * VALUE_INPUTS;
    int64_t total = 0;
    for (int i = 0; i < VALUE_INPUTS; i++) total += w->input[i] * ((int64_t)own[i] + other[i]);
    uint32_t probability = squashed(total >> 16);
    bit = code_bit(w->coder, probability, bit);

    int64_t error = ((int64_t)bit * ONE - probability) * RATE;
    for (int i = 0; i < VALUE_INPUTS; i++) {
        own[i] = trained(own[i], w->input[i], error);
        other[i] = trained(other[i], w->input[i], error);
    }
    for (int i = 0; i < CONTEXTS; i++) learn_slot(slots[i], bit, SLOT_LIMIT);
    return bit;
}

INLINE int32_t bounded(int32_t odds) { return within(odds, -MOST_ODDS, MOST_ODDS); }
INLINE int32_t first_scale(const Expectation *e) { return e->scale < 2 ? 2 : e->scale; }

/* The learned sizes of errors, the expected one counting as if seen twice; returns that of the guess, 1/16 (V 5.3). */
INLINE int32_t find_scales(Work *w) {
    int64_t mean = 0;
    for (int j = 0; j < PREDICTIONS; j++) {
        const int32_t *scale = w->model->scales.data + 2 * (j * SCALE_CONTEXTS + w->e->scale_context);
        mean = ((int64_t)scale[0] * scale[1] + ((int64_t)first_scale(w->e) << 9)) / (scale[1] + 2);
        mean = largest(mean, 256);
        w->inverse[j] = (INT64_C(1) << 38) / mean;
    }
    return (int32_t)(mean >> 8);
}

/* Is the value one of the predictions that often are exact? What was asked goes to `asked` (V 5.4). */
INLINE bool ask(Work *w, int32_t *value, int32_t *asked, int *asks) {
    const Expectation *e = w->e;
    int open = (1 << PREDICTIONS) - 1;
    for (*asks = 0; *asks < e->asks && open != 0;) {
        int best = 0;
        uint32_t rate = 0;
        for (int j = 0; j < PREDICTIONS; j++) {
            uint32_t own = w->model->hits.data[j * HIT_CONTEXTS + e->hit_context] >> SLOT_COUNT_BITS;
            if ((open >> j & 1) && own > rate) best = j, rate = own;
        }
        if (rate < ASK_FROM) return false;
        int32_t candidate = whole(e->prediction[best]);
        for (int j = 0; j < PREDICTIONS; j++) {
            if (whole(e->prediction[j]) == candidate) open &= ~(1 << j);
            int64_t away = (int64_t)candidate * FINE - e->prediction[j];
            if (away < 0) away = -away;
            int32_t inner = survival(away - FINE / 2, w->inverse[j]), outer = survival(away + FINE / 2, w->inverse[j]);
            w->input[j] = bounded(-odds_of(inner - less_of(outer - inner) * 256));
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
INLINE int choose_side(Work *w, int32_t start, int node, int up) {
    for (int j = 0; j < PREDICTIONS; j++) {
        int64_t away = (int64_t)start * FINE - FINE / 2 - w->e->prediction[j];
        w->input[j] = bounded((survival(-away, w->inverse[j]) - survival(away, w->inverse[j])) >> 8);
    }
    return decide(w, node, 1, up);
}

/* Is it in the outer half of the 2^(rest + 1) distances from `inner`, whose inner end is `edge`? (V 5.5) */
INLINE int choose_half(Work *w, int64_t edge, int direction, int64_t inner, int rest, int node, int kind, int outer) {
    for (int j = 0; j < PREDICTIONS; j++) {
        int64_t inverse = w->inverse[j], a = direction * (edge - w->e->prediction[j]) + inner * FINE;
        int64_t half = INT64_C(1) << (rest + 4), t = a + half, b = t + half;
        int32_t odds;
        if (t >= 0) {
            int32_t middle = survival(t, inverse);
            odds = less_of(survival(b, inverse) - middle) - odds_of(middle - survival(a, inverse));
        } else {
            int32_t middle = survival(-t, inverse);
            odds = odds_of(middle - survival(-b, inverse)) - less_of(survival(-a, inverse) - middle);
        }
        w->input[j] = bounded(odds);
    }
    return decide(w, node, kind, outer);
}

/* The distance from `from` outwards: its class, then its place in the class (V 5.4, V 5.5). */
INLINE int64_t code_distance(
    Work *w, int32_t from, int direction, int k, const int32_t *asked, int asks, int64_t distance) {
    int64_t edge = (int64_t)from * FINE - direction * (FINE / 2), first = 0, next;
    int32_t inner[PREDICTIONS];
    for (int j = 0; j < PREDICTIONS; j++)
        inner[j] = survival(direction * (edge - w->e->prediction[j]), w->inverse[j]);
    int class = 0, size;
    for (;; class++, first = next) {
        size = k + (class < 4 ? 0 : class / 2 - 1);
        next = first + (INT64_C(1) << size);
        if (next > REACH) break;
        bool known = false; /* a class of one value that was asked for already */
        for (int i = 0; i < asks; i++) known |= size == 0 && asked[i] == from + direction * first;
        int32_t outer[PREDICTIONS];
        int64_t far = edge + direction * next * FINE;
        for (int j = 0; j < PREDICTIONS; j++) {
            outer[j] = survival(direction * (far - w->e->prediction[j]), w->inverse[j]);
            w->input[j] = bounded(-odds_of(outer[j] - inner[j]));
            inner[j] = outer[j];
        }
        int node = CLASS_NODE + 2 * (int)least(class, 14) + (direction > 0);
        if (!known && !decide(w, node, 2 + (class > 2), distance >= next)) break;
    }
    int64_t place = 0;
    for (int mixed = 0; size > 0 && mixed < 2; mixed++) {
        size--;
        int node = PLACE_NODE + 2 * (int)least(class, 8) + mixed, bit = (distance - first) >> size & 1;
        if (choose_half(w, edge, direction, first + place, size, node, 4 + mixed, bit)) place += INT64_C(1) << size;
    }
    int64_t rest = INT64_C(1) << size;
    return first + place + (size > 0 ? code_uniform(w->coder, (distance - first) & (rest - 1), rest) : 0);
}

/* Hit rates and scales, after a value (V 5.9). */
INLINE void learn_errors(const Work *w, int32_t value) {
    const Expectation *e = w->e;
    for (int j = 0; j < PREDICTIONS; j++) {
        learn_slot(w->model->hits.data + j * HIT_CONTEXTS + e->hit_context, whole(e->prediction[j]) == value,
            HIT_LIMIT);
        int32_t *scale = w->model->scales.data + 2 * (j * SCALE_CONTEXTS + e->scale_context);
        int64_t error = (int64_t)value * FINE - e->prediction[j];
        int64_t usual = scale[1] > 0 ? scale[0] : (int64_t)first_scale(e) << 8;
        int64_t seen = least((error < 0 ? -error : error) << 8, 8 * usual + 4096); /* an outlier counts as eight */
        scale[0] += (int32_t)((least(seen, 1 << 30) - scale[0]) * RECIPROCAL[scale[1]] >> 16);
        if (scale[1] < SCALE_LIMIT) scale[1]++;
    }
}

OFTEN int32_t code_value(RangeCoder *coder, const ValueModel *model, const Expectation *e, int32_t value) {
    Work w;
    w.coder = coder, w.model = model, w.e = e;
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

enum { WORDS_SEARCHED = 4 };

int32_t nearest_seen(const int64_t *row, int64_t words, int32_t v) {
    const uint64_t *seen = (const uint64_t *)row;
    int32_t word = v >> 6, bit = v & 63, below = -1;
    uint64_t low = seen[word] & ((UINT64_C(2) << bit) - 1), high = seen[word] & ~((UINT64_C(1) << bit) - 1);
    for (int i = 0; i < WORDS_SEARCHED && below < 0; i++) {
        if (low != 0) below = ((word - i) << 6) + 63 - __builtin_clzll(low);
        if (word - i == 0) break;
        low = seen[word - i - 1];
    }
    for (int i = 0; i < WORDS_SEARCHED; i++) {
        if (high != 0) {
            int32_t above = ((word + i) << 6) + __builtin_ctzll(high);
            return below < 0 || above - v < v - below ? above : below;
        }
        if (word + i + 1 == words) break;
        high = seen[word + i + 1];
    }
    return below < 0 ? v : below;
}

enum { MOST_ERROR = 1 << 28 };

bool fits_range(ConstInts largest, int64_t columns) {
    bool fits = largest.size == columns;
    for (int j = 0; j < columns && fits; j++) fits = largest.data[j] >= 0 && largest.data[j] < MOST_SPAN;
    return fits;
}

bool fits_seen(ConstInts largest, Longs2 seen) {
    bool fits = seen.rows == largest.size;
    for (int j = 0; j < largest.size && fits; j++) fits = largest.data[j] / 64 < seen.columns;
    return fits;
}

int32_t error_at(const Ints2 *gaps, int32_t v) {
    int64_t sum = 0;
    for (int j = 0; j < gaps->columns; j++) sum += size_of(gaps->data[gaps->columns * v + j]);
    return (int32_t)least(sum, MOST_ERROR);
}

void pass_on(const Corners *corners, const Ints2 *values, const Longs2 *sums, int32_t v) {
    int64_t columns = values->columns;
    for (int32_t i = corners->starts.data[v]; i < corners->starts.data[v + 1]; i++) {
        int64_t *sum = sums->data + (columns + 1) * corners->faces.data[next_corner(corners->corners.data[i])];
        for (int j = 0; j < columns; j++) sum[j] += values->data[columns * v + j];
        sum[columns]++;
    }
}

int32_t balance(const Corners *corners, const Ints2 *values, const Longs2 *sums, const Around *around, int j,
    int32_t otherwise) {
    int64_t columns = values->columns, total = 0;
    int32_t found = 0;
    for (int i = 0; i < around->neighbors; i++) {
        int32_t u = around->neighbor[i];
        const int64_t *sum = sums->data + (columns + 1) * u;
        if (faces_at(corners, u) - sum[columns] > 1) continue;
        total += limited(FINE * ((sum[columns] + 1) * values->data[columns * u + j] - sum[j]) - otherwise);
        found++;
    }
    return found > 0 ? divided(total, found) : 0;
}
