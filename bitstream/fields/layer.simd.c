/* Levels that refine a mesh, vertex after vertex, predicted from coded neighbors (specification, V 11).
 *
 * In: for each vertex three small integers, how far it lies from a smooth base along the normal and two tangents.
 * These are most of the bytes of a scan. They look like noise but for a slow drift that the base leaves, so that the
 * guess is a sum, learnt as it goes, of what neighbors and flaps suggest, and usually 0. A level is then coded as
 * miss, side, class and place by mixed decisions whose contexts are mainly sizes around: how rough the surface is
 * here tells more than where the guess lies. This model is much smaller than that of grids, since there is less to
 * predict. It runs in the order of vertices, which is that of the conquest, and needs faces only. */
#include "bitstream/fields/fields.h"

enum {
    AXES = 3,
    MOST_LEVEL = 1 << 20,
    LEARNERS = 4 * AXES,
    OWN_TERMS = 6,
    INPUTS = 5,
    SPAN = 512,
    SORTS = 2, /* of axes: along the normal, and others */
    /* Nodes of the decisions: is it not the guess, on which side, how far, and where in that class. */
    MISS = 0,
    SIDE = 1,
    CLASS = 2,
    PLACE = 22,
    NODES = 32,
    REACH = 1 << 22, /* where the classes of the distance end */
    LEVEL_BYTES = 64, /* more than a level can take */
};

/* n, as what a number is multiplied with and shifted by instead of divided by n: processors divide slowly */
typedef struct {
    uint64_t factor;
    int shift;
    uint32_t half;
} Divisor;

typedef int32_t OfAxes __attribute__((vector_size(16))); /* a number of each axis, and one unused */

INLINE OfAxes row_at(const Ints2 *rows, int32_t v) {
    const int32_t *row = rows->data + (int64_t)AXES * v;
    return (OfAxes){row[0], row[1], row[2], 0};
}
INLINE OfAxes sizes_of(OfAxes x) { return (x ^ (x >> 31)) - (x >> 31); }

typedef struct { /* what is known of a vertex before its axes */
    Around around;
    OfAxes sum, size, gaps, errors, means, across, tips; /* of at most 16 neighbors and 8 flaps: below 2^30 */
    Divisor near, with_own, all_flaps; /* neighbors, these and the vertex itself, flaps */
    int32_t flaps, valence, busy; /* busy: mean size of the levels around, all axes added, 1/16 */
    int32_t latest, earliest;     /* neighbors coded last and first */
} LevelPlace;

typedef struct { /* a level under way */
    RangeCoder *coder;
    const Bank *bank;
    int64_t context[INPUTS], selector;
} Level;

/* Exact for numbers below 2^31. */
INLINE Divisor divisor_of(int n) {
    int shift = 31 + bit_length((uint32_t)n);
    return (Divisor){n > 0 ? (UINT64_C(1) << shift) / (uint32_t)n + 1 : 0, shift, (uint32_t)n / 2};
}

/* sum / n, rounded half away from zero; |sum| < 2^30. */
INLINE int32_t mean_of(int64_t sum, Divisor n) {
    int32_t size = (int32_t)((((uint64_t)(sum < 0 ? -sum : sum) + n.half) * n.factor) >> n.shift);
    return sum < 0 ? -size : size;
}

static void survey(const Corners *corners, const Levels *l, int32_t v, LevelPlace *p) {
    gather_around(corners, v, &p->around);
    const Around *r = &p->around;
    p->near = divisor_of(r->neighbors), p->with_own = divisor_of(r->neighbors + 1),
        p->all_flaps = divisor_of(r->flaps);
    p->flaps = (int32_t)least(r->flaps, 3);
    p->valence = within(faces_at(corners, v) - 3, 0, 7);
    p->latest = p->earliest = r->neighbors > 0 ? r->neighbor[0] : v;
    OfAxes sum = {0}, size = {0}, gaps = {0}, errors = {0}, means = {0}, across = {0}, tips = {0};
    for (int i = 0; i < r->neighbors; i++) {
        int32_t u = r->neighbor[i];
        if (u > p->latest) p->latest = u;
        if (u < p->earliest) p->earliest = u;
        OfAxes level = row_at(&l->levels, u), gap = row_at(&l->gaps, u);
        sum += level, size += sizes_of(level), gaps += gap, errors += sizes_of(gap), means += row_at(&l->means, u);
    }
    for (int i = 0; i < r->flaps; i++) {
        OfAxes tip = row_at(&l->levels, r->flap[i].c);
        across += row_at(&l->levels, r->flap[i].a) + row_at(&l->levels, r->flap[i].b) - tip;
        tips += tip;
    }
    p->sum = sum, p->size = size, p->gaps = gaps, p->errors = errors, p->means = means, p->across = across,
        p->tips = tips;
    p->busy = r->neighbors > 0 ? mean_of((int64_t)(size[0] + size[1] + size[2]) * FINE, p->near) : 4 * FINE;
}

SHARED int decide_level(const Level *w, int node, int bit) {
    return code_decision(w->coder, w->bank, INPUTS, w->context, node, w->selector, bit);
}

/* How far a level is from the guess, less one: its class, of at least 2^k distances, then its place in the class. */
INLINE int64_t code_distance(const Level *w, int k, bool away, int64_t distance) {
    int64_t first = 0, next;
    int class = 0, size;
    for (;; class++, first = next) {
        size = k + (class < 4 ? 0 : class / 2 - 1);
        next = first + (INT64_C(1) << size);
        if (next > REACH || !decide_level(w, CLASS + 2 * (int)least(class, 9) + away, distance >= next)) break;
    }
    if (size == 0) return first;
    size--;
    if (decide_level(w, PLACE + (int)least(class, 8), (distance - first) >> size & 1)) first += INT64_C(1) << size;
    if (size == 0) return first;
    int64_t rest = INT64_C(1) << size;
    return first + code_uniform(w->coder, (distance - first) & (rest - 1), rest);
}

INLINE int32_t code_level(const Level *w, int32_t center, int32_t off, int k, int32_t level) {
    if (!decide_level(w, MISS, level != center)) return center;
    int up = decide_level(w, SIDE, level > center), direction = up ? 1 : -1;
    int64_t distance = code_distance(w, k, direction * off < 0, (int64_t)direction * (level - center) - 1);
    return center + direction * (int32_t)(distance + 1);
}

INLINE int32_t near_to(int32_t x, int32_t center) { return within((int64_t)x - center, -3, 3) + 3; }

static bool code_axis(RangeCoder *coder, const Bank *bank, Levels *l, int32_t v, int j, const LevelPlace *p,
    int32_t *own) {
    const Around *r = &p->around;
    const int64_t axes = AXES;
    int32_t *x = l->levels.data + j, near = r->neighbors;
    int64_t sum = p->sum[j], size = p->size[j], gaps = p->gaps[j], errors = p->errors[j], means = p->means[j];
    int64_t across = p->across[j], tips = p->tips[j];
    int32_t mean = 0, typical = 2 * FINE, drift = 0, error_near = 2 * FINE, ring = 0, late = 0, early = 0;
    if (near > 0) {
        mean = mean_of(sum * FINE, p->near), typical = mean_of(size * FINE, p->near);
        drift = mean_of(gaps, p->near), error_near = mean_of(errors, p->near), ring = mean_of(means, p->near);
        late = x[axes * p->latest], early = x[axes * p->earliest];
    }
    int32_t flap = r->flaps > 0 ? mean_of(across * FINE, p->all_flaps) : mean;
    int32_t tip = r->flaps > 0 ? mean_of(tips * FINE, p->all_flaps) : mean;

    /* Where nothing happens, nothing is expected, and nothing learned. */
    bool quiet = near > 0 && typical == 0 && tip == 0;
    Learner *learner = (Learner *)l->learners.data + 4 * j + p->flaps;
    int32_t term[LEARNER_ROW] = {mean, flap - mean, tip - mean, early * FINE - mean, drift, ring - mean};
    int32_t guess = quiet ? 0 : foretell(learner, OWN_TERMS, term, FINE * MOST_LEVEL);

    int32_t center = whole(guess), off = guess - FINE * center;
    int32_t aside = (size_of(off) > 1) + (size_of(off) > 3) + (size_of(off) > 6);
    int32_t a = (int32_t)least(size_class(typical), 23), s = (int32_t)least(size_class(error_near), 23);
    int32_t b = (int32_t)least(size_class(p->busy), 23), o = (int32_t)least(size_class(*own * 4), 11);
    int32_t around = (int32_t)least(near, 5) * 6 + (int32_t)least(p->valence, 5), side = off < 0 ? 3 - aside
        : 3 + aside;
    int32_t context[INPUTS] = {
        (int32_t)least(a, 20) * 24 + s,
        s * 16 + p->flaps * 4 + aside,
        j > 0 ? b * 12 + o : (near_to(late, center) * 7 + near_to(early, center)) * 7 + near_to(tip >> 4, center),
        j > 0 ? ((int32_t)least(a, 11) * 12 + o) * 3 + (int32_t)least(aside, 2)
              : (within(guess + 96, 0, 191) >> 2) * 8 + p->valence,
        around * 14 + side * 2 + (s > 8),
    };
    Level w = {.coder = coder, .bank = bank, .selector = j > 0 ? NODES : 0};
    for (int i = 0; i < INPUTS; i++)
        w.context[i] = (((j > 0) * INPUTS + i) * SPAN + context[i]) * (int64_t)NODES;

    int k = (int)largest(bit_length((uint32_t)(error_near / FINE)) - 1, 0);
    int32_t level = code_level(&w, center, off, k, is_reading(coder) ? 0 : x[axes * v]);
    if (level < -MOST_LEVEL || level > MOST_LEVEL) return false;
    x[axes * v] = level;
    l->gaps.data[axes * v + j] = level * FINE - guess;
    l->means.data[axes * v + j] = mean_of((sum + level) * FINE, p->with_own);
    *own = size_of(level) + (*own >> 1);
    if (!quiet) learn_in_turn(learner, OWN_TERMS, term, level * FINE, error_near + 4, v % OWN_TERMS);
    return true;
}

typedef struct {
    RangeCoder *coder;
    const Bank *bank;
    Corners corners;
    Levels levels;
} LevelCoder;

OFTEN static bool code_vertex(void *work, int64_t v) {
    LevelCoder *w = work;
    LevelPlace p;
    survey(&w->corners, &w->levels, (int32_t)v, &p);
    int32_t own = 0;
    for (int j = 0; j < AXES; j++)
        if (!code_axis(w->coder, w->bank, &w->levels, (int32_t)v, j, &p, &own)) return false;
    return true;
}

int64_t ISA(code_levels)(
    RangeCoder *coder, const Bank *bank, Corners corners, Levels levels, int64_t first, int64_t count) {
    LevelCoder work = {.coder = coder, .bank = bank, .corners = corners, .levels = levels};
    return code_rows(coder, corners.rank.size, first, count, AXES * LEVEL_BYTES, code_vertex, &work);
}
