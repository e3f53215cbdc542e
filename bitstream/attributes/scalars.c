/* Colours and other numbers, predicted from coded neighbours (specification, A 4). */
#include "bitstream/attributes/places.h"

enum { TERMS = 7, GUESSES = MOST_COMPONENTS * BASES * VALENCES, LEARNERS = GUESSES + MOST_COMPONENTS * BASES };

typedef struct { /* of the components of this vertex so far */
    int32_t hits, gap[MOST_COMPONENTS];
} Before;

typedef struct { /* of one component around the vertex, in 1/16 */
    int32_t mean, spread, drift, error; /* of the neighbours: values, their distances from the mean, gaps, their sizes */
    int32_t straight, bent, best;       /* what continues the triangles: as parallelograms, by shape; by the best one */
    int32_t beside;                     /* what lies between the ends of the edges */
    int32_t length, fold, closing;
} Trend;

static void find_trend(const Work *w, const Place *p, int32_t v, int32_t last, int j, Trend *t) {
    const Values *g = &w->values;
    const Around *r = &p->around;
    int32_t most = FINE * g->largest.data[j], near = r->neighbours;
    int64_t sum = 0, drift = 0, errors = 0, spread = 0;
    for (int i = 0; i < near; i++) {
        int32_t gap = gap_at(g, r->neighbour[i], j);
        sum += value_at(g, r->neighbour[i], j), drift += gap, errors += size_of(gap);
    }
    t->mean = near > 0 ? divided(sum * FINE, near) : last >= 0 ? value_at(g, last, j) * FINE : most / 2;
    for (int i = 0; i < near; i++) spread += size_of(value_at(g, r->neighbour[i], j) * FINE - t->mean);
    t->drift = near > 0 ? divided(drift, near) : 0;
    t->spread = near > 0 ? divided(spread, near) : 0;
    t->error = near > 0 ? divided(errors, near) : most;

    int64_t across = 0, affine = 0, level = 0, length = 0, fold = 0;
    int32_t flaps = 0, weights = 0;
    t->best = t->mean;
    for (int i = 0; i < p->bases; i++) {
        const Base *base = &p->base[i];
        int64_t a = value_at(g, base->a, j), b = value_at(g, base->b, j);
        level += ((WHOLE - base->along) * a + base->along * b) >> 12;
        if (base->c < 0) continue;
        int64_t c = value_at(g, base->c, j);
        int32_t bent = limited((base->share[0] * a + base->share[1] * b + base->share[2] * c) >> 12);
        if (flaps++ == 0) t->best = bent;
        across += FINE * (a + b - c);
        affine += (int64_t)bent * base->weight, weights += base->weight;
        length += FINE / 2 * (a + b - 2 * c);
        fold += fold_at(w, v, base, j);
    }
    t->beside = p->bases > 0 ? divided(level, p->bases) : t->mean;
    t->straight = flaps > 0 ? divided(across, flaps) : t->mean;
    t->bent = flaps > 0 ? divided(affine, weights) : t->mean;
    t->length = flaps > 0 ? divided(length, flaps) : 0;
    t->fold = flaps > 0 ? divided(fold, flaps) : 0;
    t->closing = balance(w, r, j, t->straight);
}

static bool code_component(Work *w, const Place *p, int32_t v, int32_t last, int j, Before *own) {
    const Values *g = &w->values;
    const Around *r = &p->around;
    int32_t most = g->largest.data[j], far = FINE * most, near = r->neighbours, number = p->number, twin = p->twin;
    int32_t one = j > 0 ? own->gap[j - 1] : 0, two = j > 1 ? own->gap[j - 2] : 0;
    Trend t;
    find_trend(w, p, v, last, j, &t);
    int32_t mean = t.mean;
    int32_t term[TERMS] = {t.straight - mean, t.bent - mean, t.closing, t.length, t.fold, j > 0 ? one : t.drift,
        j > 1 ? two : t.beside - mean};
    for (int i = 0; i < TERMS; i++) term[i] = limited(term[i]);
    Learner *learners = (Learner *)g->learners.data;
    Learner *guess = learners + (j * BASES + number) * VALENCES + p->valence;
    Learner *size = learners + GUESSES + j * BASES + number;
    int32_t shift = foretell(guess, TERMS, term, far);

    int32_t hint[HINTS] = {t.error, t.spread, size_of(one), size_of(t.bent - mean)};
    for (int i = 0; i < HINTS; i++) hint[i] = limited(hint[i]);
    int32_t typical = near > 0 ? within(foretell(size, HINTS, hint, far), hint[0] / 8 + 1, far) : hint[0];
    int32_t bucket = size_class(typical >> 1), unit = typical / 2 + 4;

    int32_t first = near > 0 ? value_at(g, r->neighbour[0], j) * FINE : mean;
    Expectation e;
    e.prediction[0] = mean;
    e.prediction[1] = t.bent;
    e.prediction[2] = p->bases > 0 ? t.straight : first;
    e.prediction[3] = twin >= 0 ? value_at(g, twin, j) * FINE : near > 1 ? value_at(g, r->neighbour[1], j) * FINE : mean;
    e.prediction[4] = nearest_seen(g, j, within(whole(mean + shift), 0, most)) * FINE;
    e.prediction[5] = first;
    e.prediction[6] = mean + shift;
    int32_t off[PREDICTIONS];
    for (int i = 0; i < PREDICTIONS; i++) e.prediction[i] = within(e.prediction[i], 0, far);
    for (int i = 0; i < PREDICTIONS; i++) off[i] = e.prediction[i] - e.prediction[6];

    e.scale = typical;
    e.asks = MOST_ASKS;
    e.scale_context = (bucket * 2 + (twin >= 0)) * MOST_COMPONENTS + j;
    e.hit_context = (j == 0 ? 0 : own->hits != 0 ? 2 : 1) * 8 + number * 2 + (twin >= 0);
    e.context[0] = (bucket * BASES + number) * MOST_COMPONENTS + j;
    e.context[1] = three_classes(off[0], off[1], off[2], FINE / 2, FINE / 2);
    e.context[2] = three_classes(off[0], off[1], t.beside - e.prediction[6], unit, unit);
    e.context[3] = j > 0 ? three_classes(one, two, off[3], unit, unit) : within(whole(mean + shift), 0, 511);
    e.context[4] = 0;
    if (number > 0) {
        const Base *b = &p->base[0];
        e.context[4] = three_classes(gap_at(g, b->a, j), gap_at(g, b->b, j), gap_at(g, b->c >= 0 ? b->c : b->a, j), unit, unit);
    }
    e.context[5] = j > 0 ? (j << PREDICTIONS) + own->hits : size_class(t.spread) * BASES + number;
    e.set = (int32_t)least(j, WEIGHT_SETS - 1);

    int32_t value = code_value(&w->coder, &w->model, &e, w->coder.reading ? 0 : value_at(g, v, j));
    if (value < 0 || value > most) return false;
    keep_value(g, v, j, value);
    int32_t error = value * FINE - mean, gap = error - shift;
    g->gaps.data[g->gaps.columns * v + j] = own->gap[j] = gap;
    own->hits = hits_of(&e, value);
    learn(guess, TERMS, term, error, typical);
    learn(size, HINTS, hint, (int32_t)least(size_of(gap), 8 * (int64_t)typical + 64), typical);
    return true;
}

static bool code_vertex(Work *w, int32_t v, int32_t last) {
    Place place;
    Before own = {.hits = 0};
    survey(w, v, &place);
    for (int j = 0; j < w->values.values.columns; j++)
        if (!code_component(w, &place, v, last, j, &own)) return false;
    return true;
}

int64_t code_scalars(Coder coder, ValueModel model, Corners corners, Values values, int64_t first, int64_t count) {
    Work work = {.model = model, .corners = corners, .values = values};
    return code_vertices(coder, &work, LEARNERS, first, count, code_vertex);
}
