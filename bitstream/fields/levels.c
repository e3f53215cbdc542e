/* Levels that refine a mesh, vertex after vertex, predicted from coded neighbours (specification, V 11). */
#include "bitstream/fields/levels.h"

#include "bitstream/fields/learner.h"

enum {
    MOST_AXES = 3,
    MOST_LEVEL = 1 << 20,
    LEARNERS = 4 * MOST_AXES,
    TERMS = 6,
};

typedef struct { /* what is known of a vertex before its axes */
    Around around;
    int32_t flaps, valence, busy; /* busy: mean size of the levels around, all axes added, 1/16 */
    int32_t latest, earliest;     /* neighbours coded last and first */
} Place;

static void survey(const Corners *corners, const Levels *l, int32_t v, Place *p) {
    gather_around(corners, v, &p->around);
    const Around *r = &p->around;
    p->flaps = (int32_t)least(r->flaps, 3);
    p->valence = within(faces_at(corners, v) - 3, 0, 7);
    p->latest = p->earliest = r->neighbours > 0 ? r->neighbour[0] : v;
    int64_t all = 0;
    for (int i = 0; i < r->neighbours; i++) {
        int32_t u = r->neighbour[i];
        if (u > p->latest) p->latest = u;
        if (u < p->earliest) p->earliest = u;
        for (int j = 0; j < l->levels.columns; j++) all += size_of(l->levels.data[l->levels.columns * u + j]);
    }
    p->busy = r->neighbours > 0 ? divided(all * FINE, r->neighbours) : 4 * FINE;
}

static bool code_axis(RangeCoder *coder, const ValueModel *model, Levels *l, int32_t v, int j, const Place *p, int32_t *own) {
    const Around *r = &p->around;
    int64_t axes = l->levels.columns;
    int32_t *x = l->levels.data + j, near = r->neighbours;
    int64_t sum = 0, size = 0, gaps = 0, errors = 0, means = 0, across = 0, tips = 0;
    for (int i = 0; i < near; i++) {
        int64_t at = axes * r->neighbour[i];
        int32_t gap = l->gaps.data[at + j];
        sum += x[at], size += size_of(x[at]), gaps += gap, errors += size_of(gap), means += l->means.data[at + j];
    }
    for (int i = 0; i < r->flaps; i++) {
        Flap f = r->flap[i];
        tips += x[axes * f.c];
        across += (int64_t)x[axes * f.a] + x[axes * f.b] - x[axes * f.c];
    }
    int32_t mean = 0, typical = 2 * FINE, drift = 0, error_near = 2 * FINE, ring = 0, late = 0, early = 0;
    if (near > 0) {
        mean = divided(sum * FINE, near), typical = divided(size * FINE, near);
        drift = divided(gaps, near), error_near = divided(errors, near), ring = divided(means, near);
        late = x[axes * p->latest], early = x[axes * p->earliest];
    }
    int32_t flap = r->flaps > 0 ? divided(across * FINE, r->flaps) : mean;
    int32_t tip = r->flaps > 0 ? divided(tips * FINE, r->flaps) : mean;

    Learner *learner = (Learner *)l->learners.data + 4 * j + p->flaps;
    int32_t term[TERMS] = {mean, flap - mean, tip - mean, early * FINE - mean, drift, ring - mean};
    int32_t guess = foretell(learner, TERMS, term, FINE * MOST_LEVEL);

    Expectation e;
    e.prediction[0] = 0;
    e.prediction[1] = mean >> 1;
    e.prediction[2] = mean;
    e.prediction[3] = flap;
    e.prediction[4] = (mean + flap) >> 1;
    e.prediction[5] = tip;
    e.prediction[6] = guess;
    int32_t a = (int32_t)least(size_class(typical), 23), s = (int32_t)least(size_class(error_near), 19);
    int32_t b = (int32_t)least(size_class(p->busy), 23), o = (int32_t)least(size_class(*own * 4), 11);
    e.scale = error_near + 4;
    e.asks = 0; /* most are 0, and found at once without */
    e.scale_context = a * 20 + s;
    e.hit_context = 0;
    e.context[0] = (j * 24 + a) * 4 + p->flaps;
    e.context[1] = (s * 3 + j) * 4 + p->flaps;
    e.context[2] = j > 0 ? b * 12 + o
                         : ((within(late, -3, 3) + 3) * 7 + within(early, -3, 3) + 3) * 7 + within(tip >> 4, -3, 3) + 3;
    e.context[3] = j > 0 ? ((int32_t)least(a, 11) * 12 + o) * 3 + j : (within(guess + 96, 0, 191) >> 2) * 8 + p->valence;
    e.context[4] = three_classes(flap, mean, tip, FINE, FINE);
    e.context[5] = ((int32_t)least(near, 5) * 6 + (int32_t)least(p->valence, 5)) * 3 + j + 108 * (int32_t)least(a, 3);
    e.set = j;

    int32_t value = code_value(coder, model, &e, is_reading(coder) ? 0 : x[axes * v]);
    if (value < -MOST_LEVEL || value > MOST_LEVEL) return false;
    x[axes * v] = value;
    l->gaps.data[axes * v + j] = value * FINE - guess;
    l->means.data[axes * v + j] = divided((sum + value) * FINE, near + 1);
    *own = size_of(value) + (*own >> 1);
    learn(learner, TERMS, term, value * FINE, e.scale);
    return true;
}

static bool code_vertex(RangeCoder *coder, const ValueModel *model, const Corners *corners, Levels *l, int32_t v) {
    if (corners->rank.data[v] == PASSED_OVER) return true;
    Place p;
    survey(corners, l, v, &p);
    int32_t own = 0;
    for (int j = 0; j < l->levels.columns; j++)
        if (!code_axis(coder, model, l, v, j, &p, &own)) return false;
    return true;
}

static bool alike(Ints2 a, Ints2 b) { return a.rows == b.rows && a.columns == b.columns; }

static bool fits_levels(const Corners *corners, const Levels *l) {
    return l->levels.rows == corners->rank.size && l->levels.columns >= 1 && l->levels.columns <= MOST_AXES
        && alike(l->gaps, l->levels) && alike(l->means, l->levels) && l->learners.rows == LEARNERS
        && l->learners.columns == LEARNER_COLUMNS;
}

/* Code `count` vertices from number `first` on, as far as there is room (writing) or sense (reading).
 * Returns how many. */
int64_t code_levels(Coder given, ValueModel model, Corners corners, Levels levels, int64_t first, int64_t count) {
    RangeCoder coder;
    if (!open_coder(&coder, given) || !fits_values(&model) || !fits_corners(&corners) || !fits_levels(&corners, &levels)
        || first < 0 || count < 0 || first > corners.rank.size - count)
        return MISUSED;
    int64_t done = 0;
    while (done < count && has_room(&coder, MOST_AXES * VALUE_BYTES) && !overran(&coder)
        && code_vertex(&coder, &model, &corners, &levels, (int32_t)(first + done)))
        done++;
    close_coder(&coder, given);
    return done;
}
