/* Colors and other numbers, predicted from coded neighbors (specification, A 4). */
#include "bitstream/attributes/attributes.h"

typedef struct { /* of the components of this vertex so far */
    int32_t hits, gap[MOST_COMPONENTS], off[MOST_COMPONENTS]; /* off: value less mean of the neighbors */
} Before;

typedef struct { /* of one component around the vertex, in 1/16 */
    int32_t mean, spread, drift, error; /* of the neighbors: values, how far from the mean, gaps, their sizes */
    int32_t straight, best;             /* what continues the triangles as parallelograms, and the best one */
    int32_t beside;                     /* what lies between the ends of the edges */
    int32_t length, fold, closing;
} Trend;

static void find_trend(const Work *w, const Place *p, int32_t v, int32_t last, int j, Trend *t) {
    const Values *g = &w->values;
    const Around *r = &p->around;
    int32_t most = FINE * g->largest.data[j], near = r->neighbors;
    int64_t sum = 0, drift = 0, errors = 0, spread = 0;
    for (int i = 0; i < near; i++) {
        int32_t gap = gap_at(g, r->neighbor[i], j);
        sum += value_at(g, r->neighbor[i], j), drift += gap, errors += size_of(gap);
    }
    t->mean = near > 0 ? divided(sum * FINE, near) : last >= 0 ? value_at(g, last, j) * FINE : most / 2;
    for (int i = 0; i < near; i++) spread += size_of(value_at(g, r->neighbor[i], j) * FINE - t->mean);
    t->drift = near > 0 ? divided(drift, near) : 0;
    t->spread = near > 0 ? divided(spread, near) : 0;
    t->error = near > 0 ? divided(errors, near) : most;

    int64_t across = 0, level = 0, length = 0, fold = 0;
    int32_t flaps = 0;
    t->best = t->mean;
    for (int i = 0; i < p->bases; i++) {
        const Base *base = &p->base[i];
        int64_t a = value_at(g, base->a, j), b = value_at(g, base->b, j);
        level += FINE / 2 * (a + b);
        if (base->c < 0) continue;
        int64_t c = value_at(g, base->c, j);
        if (flaps++ == 0) t->best = FINE * (int32_t)(a + b - c);
        across += FINE * (a + b - c);
        length += FINE / 2 * (a + b - 2 * c);
        fold += fold_at(w, v, base, j);
    }
    t->beside = p->bases > 0 ? divided(level, p->bases) : t->mean;
    t->straight = flaps > 0 ? divided(across, flaps) : t->mean;
    t->length = flaps > 0 ? divided(length, flaps) : 0;
    t->fold = flaps > 0 ? divided(fold, flaps) : 0;
    t->closing = balance(&w->corners, &g->values, &g->sums, r, j, t->straight);
}

/* The neighbor, or the twin, that is most like v in the components before j; none before the first. */
static int32_t find_like(const Values *g, const Place *p, int32_t v, int j) {
    int32_t like = -1;
    int64_t least_away = INT64_MAX;
    for (int i = -1; i < p->around.neighbors && j > 0; i++) {
        int32_t u = i < 0 ? p->twin : p->around.neighbor[i];
        if (u < 0) continue;
        int64_t away = 0;
        for (int k = 0; k < j; k++) away += size_of(value_at(g, u, k) - value_at(g, v, k));
        if (away < least_away) least_away = away, like = u;
    }
    return like;
}

static bool code_component(Work *w, const Place *p, int32_t v, int32_t last, int j, Before *own) {
    const Values *g = &w->values;
    const Around *r = &p->around;
    int32_t most = g->largest.data[j], far = FINE * most, near = r->neighbors, twin = p->twin;
    int32_t one = j > 0 ? own->gap[j - 1] : 0, two = j > 1 ? own->gap[j - 2] : 0;
    Trend t;
    find_trend(w, p, v, last, j, &t);
    int32_t mean = t.mean, best = t.best - mean;
    Forecast f = {.term = {t.straight - mean, best, t.closing, t.length, t.fold, j > 0 ? own->off[j - 1] : t.drift,
                      j > 1 ? own->off[j - 2] : t.beside - mean},
        .hint = {t.error, t.spread, size_of(one), size_of(best)}};
    choose_learners(&f, g, MOST_COMPONENTS, j, p->number, p->valence);
    foresee(&f, far);
    foresee_error(&f, far, near > 0);
    int32_t guess = mean + f.shift, bucket = size_class(f.typical >> 1), unit = f.typical / 2 + 4;

    int32_t first = near > 0 ? value_at(g, r->neighbor[0], j) * FINE : mean, like = find_like(g, p, v, j);
    int32_t second = near > 1 ? value_at(g, r->neighbor[1], j) * FINE : mean;
    Expectation e = {.contexts = CONTEXTS};
    e.prediction[0] = mean;
    e.prediction[1] = t.best;
    e.prediction[2] = p->bases > 0 ? t.straight : first;
    e.prediction[3] = twin >= 0 ? value_at(g, twin, j) * FINE : second;
    e.prediction[4] = near_seen(g, j, within(whole(guess), 0, most)) * FINE;
    e.prediction[5] = first;
    if (like >= 0) e.prediction[5] = (value_at(g, like, j) + value_at(g, v, j - 1) - value_at(g, like, j - 1)) * FINE;
    e.prediction[6] = guess;
    int32_t off[PREDICTIONS];
    settle(&e, 0, far, off);

    e.scale = f.typical;
    e.scale_context = (bucket * 2 + (twin >= 0)) * MOST_COMPONENTS + j;
    e.hit_context = (j == 0 ? 0 : own->hits != 0 ? 2 : 1) * 8 + p->number * 2 + (twin >= 0);
    e.context[0] = (bucket * BASES + p->number) * MOST_COMPONENTS + j;
    e.context[1] = three_classes(off[0], off[1], off[2], FINE / 2, FINE / 2);
    e.context[2] = three_classes(off[0], off[1], t.beside - e.prediction[6], unit, unit);
    e.context[3] = j > 0 ? three_classes(one, two, off[5], unit, unit) : within(whole(guess), 0, CONTEXT_SIZE - 1);
    e.context[4] = gap_classes(w, p, j, unit);
    e.context[5] = j > 0 ? (j << PREDICTIONS) + own->hits : size_class(t.spread) * BASES + p->number;
    e.set = (int32_t)least(j, WEIGHT_SETS - 1);

    int32_t value = code_value(w->coder, &w->model, &e, w->coder->reading ? 0 : value_at(g, v, j));
    if (value < 0 || value > most) return false;
    keep_value(g, v, j, value);
    own->hits = hits_of(&e, value);
    own->off[j] = value * FINE - mean;
    own->gap[j] = g->gaps.data[g->gaps.columns * v + j] = take(&f, own->off[j]);
    return true;
}

bool code_scalar(Work *w, int32_t v, int32_t last) {
    Place place;
    Before own = {.hits = 0};
    survey_values(w, v, &place);
    for (int j = 0; j < w->values.values.columns; j++)
        if (!code_component(w, &place, v, last, j, &own)) return false;
    return true;
}
