/* Texture coordinates, predicted from the shapes of the triangles (specification, A 5). */
#include "bitstream/attributes/attributes.h"

enum { AXES = 2, WHOLE = 1 << 16, NARROW = 1 << 14, MOST_RATIO = 8 * WHOLE };

/* What is kept: triangles that are counter-clockwise less those that are clockwise; how far neighbors are apart, in
 * 1/256. */
enum { TURN, STRIDE };

typedef struct { /* where a vertex is, seen from an edge, in 2^-16 of its length */
    int64_t along, beside, weight;
} Spot;

typedef struct {
    Place place;
    Claim claim[MOST_BASES], all;
    int32_t mean[AXES], spread[AXES], drift[AXES], rise[AXES], run[AXES];
} Chart;

INLINE const int32_t *at(const Values *g, int32_t v) { return g->values.data + AXES * (int64_t)v; }
INLINE int64_t dot(const int64_t *x, const int64_t *y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }

/* Which way round a, b, c are. */
int turn_of(const Values *g, int32_t a, int32_t b, int32_t c) {
    const int32_t *p = at(g, a), *q = at(g, b), *r = at(g, c);
    int64_t cross = (int64_t)(q[0] - p[0]) * (r[1] - p[1]) - (int64_t)(q[1] - p[1]) * (r[0] - p[0]);
    return cross > 0 ? 1 : cross < 0 ? -1 : 0;
}

/* Where x is over the edge from a to b; false if that has no length (A 5.1). */
static bool locate(const Values *g, int32_t a, int32_t b, int32_t x, Spot *spot) {
    const int32_t *p = g->geometry.data;
    int64_t edge[3], to[3], most = 0, normal[3];
    for (int j = 0; j < 3; j++) {
        edge[j] = (int64_t)p[3 * (int64_t)b + j] - p[3 * (int64_t)a + j];
        to[j] = (int64_t)p[3 * (int64_t)x + j] - p[3 * (int64_t)a + j];
        most = largest(most, largest(largest(edge[j], -edge[j]), largest(to[j], -to[j])));
    }
    int shift = 0;
    while (most >> shift >= NARROW) shift++;
    for (int j = 0; j < 3; j++) edge[j] >>= shift, to[j] >>= shift;
    int64_t square = dot(edge, edge);
    if (square == 0) return false;
    for (int j = 0; j < 3; j++) {
        int s = (j + 1) % 3, t = (j + 2) % 3;
        normal[j] = edge[s] * to[t] - edge[t] * to[s];
    }
    int64_t area = square_root(dot(normal, normal));
    spot->along = within(quotient(dot(edge, to) * WHOLE, square), -MOST_RATIO, MOST_RATIO);
    spot->beside = within(quotient(area * WHOLE, square), 0, MOST_RATIO);
    spot->weight = within(quotient(square * 256, area + 1), 1, WHOLE);
    return true;
}

/* By the shape of the vertex's triangle, by that of the triangle beyond the edge, and by its parallelogram (A 5.2). */
Claim claim_of(const Values *g, int32_t v, const Base *base) {
    const int32_t *a = at(g, base->a), *b = at(g, base->b), *c = base->c >= 0 ? at(g, base->c) : b;
    int turn = base->c >= 0 ? turn_of(g, base->b, base->a, base->c) : 0;
    if (turn == 0) turn = g->chart.data[TURN] >= 0 ? 1 : -1;
    int64_t edge[AXES] = {b[0] - a[0], b[1] - a[1]}, beyond[AXES] = {-edge[1] * turn, edge[0] * turn};
    Spot spot, far;
    Claim claim;
    claim.weight = 1;
    for (int j = 0; j < AXES; j++) {
        claim.across[j] = claim.affine[j] = FINE * (a[j] + b[j] - c[j]);
        claim.similar[j] = FINE / 2 * (a[j] + b[j]);
    }
    if (g->geometry.rows == 0 || !locate(g, base->a, base->b, v, &spot)) return claim;
    claim.weight = (int32_t)spot.weight;
    for (int j = 0; j < AXES; j++)
        claim.similar[j] = FINE * a[j] + (int32_t)((spot.along * edge[j] + spot.beside * beyond[j]) >> 12);
    if (base->c < 0) {
        for (int j = 0; j < AXES; j++) claim.affine[j] = claim.similar[j];
        return claim;
    }
    if (!locate(g, base->a, base->b, base->c, &far) || far.beside < WHOLE / 64) return claim;
    int64_t ratio = quotient(spot.beside * WHOLE, far.beside), rest = spot.along + (ratio * far.along >> 16);
    if (ratio > MOST_RATIO) return claim;
    for (int j = 0; j < AXES; j++)
        claim.affine[j] = FINE * a[j] + limited((rest * edge[j] - ratio * (c[j] - a[j])) >> 12);
    return claim;
}

static void average(const Values *g, int32_t last, Chart *p) {
    const Around *r = &p->place.around;
    int bases = p->place.bases;
    for (int j = 0; j < AXES; j++) {
        int64_t near = 0, drift = 0, similar = 0, affine = 0, across = 0, spread = 0;
        int32_t weights = 0;
        for (int i = 0; i < r->neighbors; i++) {
            near += at(g, r->neighbor[i])[j] * FINE;
            drift += g->gaps.data[AXES * (int64_t)r->neighbor[i] + j];
        }
        p->mean[j] = r->neighbors > 0 ? divided(near, r->neighbors) : last < 0 ? 0 : at(g, last)[j] * FINE;
        p->drift[j] = r->neighbors > 0 ? divided(drift, r->neighbors) : 0;
        p->all.similar[j] = p->all.affine[j] = p->all.across[j] = p->mean[j];
        p->spread[j] = p->run[j] = p->rise[j] = 0;
        if (bases == 0) continue;
        for (int i = 0; i < bases; i++) {
            const Claim *c = &p->claim[i];
            int64_t weight = c->weight;
            similar += weight * c->similar[j], affine += weight * c->affine[j], across += weight * c->across[j];
            weights += (int32_t)weight;
        }
        p->all.similar[j] = divided(similar, weights);
        p->all.affine[j] = divided(affine, weights);
        p->all.across[j] = divided(across, weights);
        for (int i = 0; i < bases; i++) {
            const Claim *c = &p->claim[i];
            spread += size_of(c->affine[j] - p->all.affine[j]) + size_of(c->similar[j] - p->all.similar[j]);
        }
        p->spread[j] = divided(spread, 2 * bases);
        int32_t a = at(g, p->place.base[0].a)[j], b = at(g, p->place.base[0].b)[j];
        p->run[j] = (b - a) * FINE;
        p->rise[j] = p->all.similar[j] - (a + b) * (FINE / 2);
    }
}

/* How an error of the first component goes on in the second, if it is along (x, y). */
static int32_t followed(int64_t error, int64_t x, int64_t y) {
    while (largest(largest(x, -x), largest(y, -y)) >= 1 << 18) x >>= 1, y >>= 1;
    return limited(within(error, -(1 << 24), 1 << 24) * x * y / (x * x + (x * x + y * y) / 64 + 1));
}

static bool code_axis(Work *w, const Chart *p, int32_t v, int j, int32_t *hits, int32_t *first) {
    const Values *g = &w->values;
    const Around *r = &p->place.around;
    int32_t most = g->largest.data[j], far = FINE * most, base = p->all.affine[j], number = p->place.number;
    int32_t twin = p->place.twin, like = p->all.similar[j] - base;
    const Claim *one = p->place.bases > 0 ? &p->claim[0] : &p->all, *two = p->place.bases > 1 ? &p->claim[1] : one;
    int32_t usual = r->neighbors > 0 ? (int32_t)(g->chart.data[STRIDE] >> 4) : far;
    Forecast f = {.term = {like, p->all.across[j] - base, p->mean[j] - base, followed(*first, p->rise[0], p->rise[1]),
                      followed(*first, p->run[0], p->run[1]), p->drift[j], one->affine[j] - base},
        .hint = {number > 0 ? p->place.error : usual, p->spread[j], size_of(*first), size_of(like)}};
    choose_learners(&f, g, AXES, j, number, p->place.valence);
    foresee(&f, far);
    foresee_error(&f, far, number > 0);
    int32_t guess = base + f.shift, bucket = size_class(f.typical >> 1), unit = f.typical / 2 + 4;

    Expectation e = {.contexts = CONTEXTS};
    e.prediction[0] = base;
    e.prediction[1] = p->all.similar[j];
    e.prediction[2] = one->affine[j];
    e.prediction[3] = twin >= 0 ? at(g, twin)[j] * FINE : two->affine[j];
    e.prediction[4] = near_seen(g, j, within(whole(guess), 0, most)) * FINE;
    e.prediction[5] = r->neighbors > 0 ? at(g, r->neighbor[0])[j] * FINE : p->mean[j];
    e.prediction[6] = guess;
    int32_t off[PREDICTIONS];
    settle(&e, 0, far, off);

    e.scale = f.typical;
    e.scale_context = (bucket * BASES + number) * AXES + j;
    e.hit_context = (j == 0 ? 0 : *hits != 0 ? 2 : 1) * 8 + number * 2 + (twin >= 0);
    e.context[0] = (bucket * BASES + number) * AXES + j;
    e.context[1] = three_classes(off[0], off[1], off[2], FINE / 2, FINE / 2);
    e.context[2] = three_classes(off[1], off[2], p->mean[j] - e.prediction[6], unit, unit);
    e.context[3] = three_classes(off[4], p->all.across[j] - e.prediction[6], off[3], FINE / 2, unit);
    e.context[4] = gap_classes(w, &p->place, j, unit);
    e.context[5] = j == 0 ? 0 : *hits + (1 << PREDICTIONS);
    e.set = j;

    int32_t value = code_value(w->coder, &w->model, &e, w->coder->reading ? 0 : at(g, v)[j]);
    if (value < 0 || value > most) return false;
    keep_value(g, v, j, value);
    *hits = hits_of(&e, value);
    int32_t gap = take(&f, value * FINE - base);
    /* where nothing was known, errors tell nothing */
    g->gaps.data[AXES * (int64_t)v + j] = number > 0 ? gap : (int32_t)(g->chart.data[STRIDE] >> 7);
    if (j == 0) *first = gap;
    return true;
}

static void pass_chart(const Values *g, const Chart *p, int32_t v) {
    int64_t *kept = g->chart.data, away = 0;
    for (int j = 0; j < AXES; j++) away += size_of(at(g, v)[j] * FINE - p->mean[j]);
    if (p->place.around.neighbors > 0) kept[STRIDE] += (FINE / 2 * away - kept[STRIDE]) >> 4;
    for (int i = 0; i < p->place.bases; i++) kept[TURN] += turn_of(g, p->place.base[i].a, p->place.base[i].b, v);
}

bool code_texcoord(Work *w, int32_t v, int32_t last) {
    const Values *g = &w->values;
    Chart p;
    survey_values(w, v, &p.place);
    for (int i = 0; i < p.place.bases; i++) p.claim[i] = claim_of(g, v, &p.place.base[i]);
    average(g, last, &p);
    int32_t hits = 0, first = 0;
    for (int j = 0; j < AXES; j++)
        if (!code_axis(w, &p, v, j, &hits, &first)) return false;
    pass_chart(g, &p, v);
    return true;
}
