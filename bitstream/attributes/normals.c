/* Normals on an octahedron, predicted from the surface (specification, A 6). */
#include "bitstream/attributes/attributes.h"

enum { AXES = 3, PAIR = 2, CORNERS_SEEN = 64, FARTHEST = 1 << 24 };

/* Directions of a vertex: its own, and what the surface tells, faces weighed by area or by angle; the mean of those by
 * area around. */
enum { OWN, BY_AREA, BY_ANGLE, RING, ROLES };

typedef struct { /* what is known of a vertex, as it is seen */
    Place place;
    View view;
    int32_t by_area[PAIR], by_angle[PAIR], ring[PAIR], mean[PAIR], drift[PAIR], across[PAIR], nearest[PAIR], twin[PAIR];
} Sight;

INLINE Direction *directions_of(const Values *g, int32_t v) {
    return (Direction *)(g->directions.data + ROLES * AXES * (int64_t)v);
}
INLINE bool nowhere(const int64_t *x) { return x[0] == 0 && x[1] == 0 && x[2] == 0; }

/* Add the normal of the face of corner k, seen from there, by area and by angle (A 6.3). */
static void add_face(const Corners *c, const Values *g, int32_t k, int64_t *by_area, int64_t *by_angle) {
    const int32_t *vertex = c->faces.data, *p = g->geometry.data, *o = p + AXES * (int64_t)vertex[k];
    const int32_t *a = p + AXES * (int64_t)vertex[next_corner(k)], *b = p + AXES * (int64_t)vertex[previous_corner(k)];
    int64_t x[AXES], y[AXES], normal[AXES], most = 0, dot = 0, square = 0;
    for (int j = 0; j < AXES; j++) {
        x[j] = within((int64_t)a[j] - o[j], -FARTHEST, FARTHEST);
        y[j] = within((int64_t)b[j] - o[j], -FARTHEST, FARTHEST);
        dot += x[j] * y[j];
    }
    for (int j = 0; j < AXES; j++) {
        int s = (j + 1) % 3, t = (j + 2) % 3;
        normal[j] = x[s] * y[t] - x[t] * y[s];
        by_area[j] += normal[j];
        most = largest(most, largest(normal[j], -normal[j]));
    }
    int shift = 0;
    while (most >> shift >= 1 << 28) shift++;
    for (int j = 0; j < AXES; j++) square += (normal[j] >> shift) * (normal[j] >> shift);
    int64_t length = square_root(square), angle = angle_of(dot >> shift, length);
    for (int j = 0; j < AXES && length > 0; j++) by_angle[j] += (normal[j] >> shift) * (1 << 14) / length * angle;
}

static int32_t last_corner(const Corners *c, int64_t v) {
    return (int32_t)least(c->starts.data[v + 1], c->starts.data[v] + (int64_t)CORNERS_SEEN);
}

static void expect_normal(const Corners *c, const Values *g, int32_t v) {
    int64_t by_area[AXES] = {0, 0, 0}, by_angle[AXES] = {0, 0, 0};
    int32_t size = FINE * middle(g);
    for (int32_t i = c->starts.data[v]; i < last_corner(c, v); i++)
        add_face(c, g, c->corners.data[i], by_area, by_angle);
    if (nowhere(by_area)) return;
    directions_of(g, v)[BY_AREA] = scaled_direction(by_area, size);
    directions_of(g, v)[BY_ANGLE] = scaled_direction(by_angle, size);
}

static void average_ring(const Corners *c, const Values *g, int32_t v) {
    int64_t sum[AXES] = {0, 0, 0};
    for (int32_t i = c->starts.data[v]; i < last_corner(c, v); i++) {
        int32_t k = c->corners.data[i];
        const Direction *a = directions_of(g, c->faces.data[next_corner(k)]) + BY_AREA;
        const Direction *b = directions_of(g, c->faces.data[previous_corner(k)]) + BY_AREA;
        for (int j = 0; j < AXES; j++) sum[j] += a->axis[j] + b->axis[j];
    }
    Direction *own = directions_of(g, v);
    own[RING] = nowhere(sum) ? own[BY_AREA] : scaled_direction(sum, FINE * middle(g));
}

/* Fill the directions that the surface tells; zeros where it tells none. Comes before code_normal. */
int64_t expect_normals(Corners corners, Values values) {
    if (values.geometry.rows == 0) return 0;
    for (int32_t v = 0; v < corners.rank.size; v++) expect_normal(&corners, &values, v);
    for (int32_t v = 0; v < corners.rank.size; v++) average_ring(&corners, &values, v);
    return 0;
}

/* The known direction, here or around, that is nearest to d; `otherwise` if there is none. */
static Direction nearest_known(const Values *g, const Place *p, const Direction *d, Direction otherwise) {
    int64_t least_away = INT64_MAX;
    for (int i = -1; i < p->around.neighbors; i++) {
        int32_t u = i < 0 ? p->twin : p->around.neighbor[i];
        if (u < 0) continue;
        Direction own = directions_of(g, u)[OWN];
        int64_t away = 0;
        for (int j = 0; j < AXES; j++) away += size_of(own.axis[j] - d->axis[j]);
        if (away < least_away) least_away = away, otherwise = own;
    }
    return otherwise;
}

static void look(const Work *w, int32_t v, int32_t last, Sight *s) {
    const Values *g = &w->values;
    int32_t size = FINE * middle(g);
    int64_t mean[AXES] = {0, 0, 0}, drift[AXES] = {0, 0, 0}, across[AXES] = {0, 0, 0};
    survey_values(w, v, &s->place);
    const Around *r = &s->place.around;
    for (int i = 0; i < r->neighbors; i++) {
        const Direction *d = directions_of(g, r->neighbor[i]);
        for (int j = 0; j < AXES; j++) mean[j] += d[OWN].axis[j], drift[j] += d[OWN].axis[j] - d[BY_AREA].axis[j];
    }
    for (int i = 0; i < r->flaps; i++) {
        Flap f = r->flap[i];
        const Direction *a = directions_of(g, f.a), *b = directions_of(g, f.b), *c = directions_of(g, f.c);
        for (int j = 0; j < AXES; j++) across[j] += (int64_t)a->axis[j] + b->axis[j] - c->axis[j];
    }
    Direction m = r->neighbors == 0 && last >= 0 ? directions_of(g, last)[OWN] : scaled_direction(mean, size);
    Direction *own = directions_of(g, v), d = own[BY_AREA];
    if (d.axis[0] == 0 && d.axis[1] == 0 && d.axis[2] == 0) own[BY_AREA] = own[BY_ANGLE] = own[RING] = d = m;
    for (int j = 0; j < AXES; j++) drift[j] = d.axis[j] + (r->neighbors > 0 ? divided(drift[j], r->neighbors) : 0);
    Direction fixed = scaled_direction(drift, size), beyond = r->flaps > 0 ? scaled_direction(across, size) : m;
    Direction nearest = nearest_known(g, &s->place, &d, m), twin = m;
    if (r->neighbors > 0) twin = directions_of(g, r->neighbor[0])[OWN];
    if (s->place.twin >= 0) twin = directions_of(g, s->place.twin)[OWN];
    s->view = view_from(&d, size);
    see(&s->view, &d, s->by_area);
    see(&s->view, &own[BY_ANGLE], s->by_angle);
    see(&s->view, &own[RING], s->ring);
    see(&s->view, &m, s->mean);
    see(&s->view, &fixed, s->drift);
    see(&s->view, &beyond, s->across);
    see(&s->view, &nearest, s->nearest);
    see(&s->view, &twin, s->twin);
}

static bool code_axis(Work *w, const Sight *s, int j, int32_t *pair, int32_t *gaps, int32_t *hits) {
    const Values *g = &w->values;
    const Place *p = &s->place;
    int32_t far = s->view.size, base = s->by_area[j], angle = s->by_angle[j] - base, ring = s->ring[j] - base;
    int32_t first = j > 0 ? gaps[0] : 0, near = s->nearest[j] - base;
    Forecast f = {.term = {angle, ring, s->drift[j] - base, s->mean[j] - base, s->across[j] - base, near, first},
        .hint = {p->error >= 0 ? p->error : FINE, size_of(angle) + size_of(ring), size_of(first), size_of(near)}};
    choose_learners(&f, g, PAIR, j, p->number, p->valence);
    foresee(&f, far);
    foresee_error(&f, far, true);
    int32_t guess = base + f.shift, bucket = size_class(f.typical), unit = f.typical / 2 + 4, twin = p->twin >= 0;

    Expectation e = {.contexts = CONTEXTS};
    e.prediction[0] = base;
    e.prediction[1] = s->by_angle[j];
    e.prediction[2] = s->drift[j];
    e.prediction[3] = s->twin[j];
    e.prediction[4] = s->nearest[j];
    e.prediction[5] = s->mean[j];
    e.prediction[6] = guess;
    int32_t off[PREDICTIONS];
    settle(&e, -far, far, off);

    e.scale = f.typical;
    e.scale_context = (bucket * 2 + twin) * PAIR + j;
    e.hit_context = (j == 0 ? 0 : *hits != 0 ? 2 : 1) * 8 + p->number * 2 + twin;
    e.context[0] = (bucket * BASES + p->number) * PAIR + j;
    e.context[1] = three_classes(off[0], off[1], off[2], FINE / 2, FINE / 2);
    e.context[2] = three_classes(off[3], off[4], off[5], FINE / 2, unit);
    e.context[3] = ((s->view.pole * 2 + (s->view.sign > 0)) * PAIR + j) * VALENCES + p->valence;
    e.context[4] = three_classes(off[0], off[4], first, FINE / 4, FINE / 4);
    e.context[5] = j == 0 ? 0 : *hits + (1 << PREDICTIONS);
    e.set = j;

    int32_t value = code_value(w->coder, &w->model, &e, w->coder->reading ? 0 : pair[j] / FINE);
    if (value < -far / FINE || value > far / FINE) return false;
    pair[j] = value * FINE;
    *hits = hits_of(&e, value);
    gaps[j] = take(&f, pair[j] - base);
    return true;
}

bool code_normal(Work *w, int32_t v, int32_t last) {
    const Values *g = &w->values;
    int32_t pair[PAIR] = {0, 0}, gaps[PAIR] = {0, 0}, hits = 0, k = middle(g);
    int32_t *own = g->values.data + PAIR * (int64_t)v;
    View front = {.first = 0, .second = 1, .pole = 2, .sign = 1, .size = FINE * k}; /* that of the levels */
    Sight s;
    look(w, v, last, &s);
    if (!w->coder->reading) {
        int32_t given[PAIR] = {(own[0] - k) * FINE, (own[1] - k) * FINE};
        Direction d = seen_as(&front, given);
        see(&s.view, &d, pair);
    }
    for (int j = 0; j < PAIR; j++)
        if (!code_axis(w, &s, j, pair, gaps, &hits)) return false;
    Direction *d = directions_of(g, v) + OWN;
    *d = seen_as(&s.view, pair);
    see(&front, d, pair);
    for (int j = 0; j < PAIR; j++) {
        own[j] = pair[j] / FINE + k;
        g->gaps.data[PAIR * (int64_t)v + j] = gaps[j];
    }
    return true;
}
