/* Normals on an octahedron, predicted from the surface (specification, A 6). */
#include "bitstream/attributes/places.h"

enum { AXES = 3, PAIR = 2, MOST_CORNERS_SEEN = 64 };

/* A direction is three numbers whose absolute values add up to 16 times the size of the octahedron. */
typedef struct {
    int32_t axis[AXES];
} Direction;

typedef struct { /* the axis that points outwards most comes last, and is turned upwards */
    int first, second, pole, sign;
    int32_t size; /* 16 times that of the octahedron */
} View;

INLINE int32_t half(const Values *g) { return g->largest.data[0] / 2; }

static Direction scaled(const int64_t *x, int32_t size) {
    int64_t most = 0, part[AXES], sum = 0;
    for (int j = 0; j < AXES; j++) most = largest(most, x[j] < 0 ? -x[j] : x[j]);
    int shift = 0;
    while (most >> shift >= 1 << 28) shift++;
    for (int j = 0; j < AXES; j++) part[j] = x[j] >> shift, sum += part[j] < 0 ? -part[j] : part[j];
    Direction d = {{0, 0, size}};
    if (sum == 0) return d;
    for (int j = 0; j < AXES; j++) d.axis[j] = divided(part[j] * size, (int32_t)sum);
    return d;
}

/* Levels of a vertex to a direction, and back. */
static Direction unfolded(int32_t x, int32_t y, int32_t size) {
    int32_t rest = size - size_of(x) - size_of(y);
    if (rest >= 0) return (Direction){{x, y, rest}};
    int32_t u = size - size_of(y), w = size - size_of(x);
    return (Direction){{x < 0 ? -u : u, y < 0 ? -w : w, rest}};
}

static View view_of(const Direction *d, int32_t size) {
    View view = {.size = size, .pole = 0};
    for (int j = 1; j < AXES; j++)
        if (size_of(d->axis[j]) > size_of(d->axis[view.pole])) view.pole = j;
    view.first = (view.pole + 1) % 3, view.second = (view.pole + 2) % 3;
    view.sign = d->axis[view.pole] < 0 ? -1 : 1;
    return view;
}

static void seen_in(const View *view, const Direction *d, int32_t *pair) {
    int32_t x = d->axis[view->first], y = d->axis[view->second];
    if (d->axis[view->pole] * view->sign < 0) {
        int32_t u = view->size - size_of(y), w = view->size - size_of(x);
        x = x < 0 ? -u : u, y = y < 0 ? -w : w;
    }
    pair[0] = x, pair[1] = y;
}

static Direction back_from(const View *view, const int32_t *pair) {
    Direction flat = unfolded(pair[0], pair[1], view->size), d;
    d.axis[view->first] = flat.axis[0], d.axis[view->second] = flat.axis[1], d.axis[view->pole] = flat.axis[2] * view->sign;
    return d;
}

/* Angle between two directions of given dot and cross products, in 1 / 2^12 of a right angle. */
static int64_t angle_of(int64_t dot, int64_t cross) {
    int64_t x = dot < 0 ? -dot : dot, low = least(x, cross), high = largest(x, cross);
    int64_t t = high > 0 ? (low << 12) / high : 0, angle = t * ((1 << 11) + ((4096 - t) * 711 >> 12)) >> 12;
    if (cross > x) angle = 4096 - angle;
    return dot < 0 ? 8192 - angle : angle;
}

/* Normals of the surface at a vertex: faces weighed by area, by angle, and alike. */
static void expect(const Corners *corners, const Values *g, int32_t v, int64_t by_area[AXES], int64_t by_angle[AXES], int64_t alike[AXES]) {
    const int32_t *p = g->geometry.data, *o = p + AXES * (int64_t)v;
    for (int j = 0; j < AXES; j++) by_area[j] = by_angle[j] = alike[j] = 0;
    int32_t start = corners->starts.data[v], end = (int32_t)least(corners->starts.data[v + 1], start + (int64_t)MOST_CORNERS_SEEN);
    if (g->geometry.rows == 0) return;
    for (int32_t i = start; i < end; i++) {
        int32_t k = corners->corners.data[i];
        const int32_t *a = p + AXES * (int64_t)corners->faces.data[next_corner(k)];
        const int32_t *b = p + AXES * (int64_t)corners->faces.data[previous_corner(k)];
        int64_t x[AXES], y[AXES], normal[AXES], most = 0, dot = 0, square = 0;
        for (int j = 0; j < AXES; j++) x[j] = within((int64_t)a[j] - o[j], -(1 << 24), 1 << 24), y[j] = within((int64_t)b[j] - o[j], -(1 << 24), 1 << 24);
        for (int j = 0; j < AXES; j++) {
            normal[j] = x[(j + 1) % 3] * y[(j + 2) % 3] - x[(j + 2) % 3] * y[(j + 1) % 3];
            by_area[j] += normal[j];
            dot += x[j] * y[j];
            most |= normal[j] < 0 ? -normal[j] : normal[j];
        }
        int shift = 0;
        while (most >> shift >= 1 << 28) shift++;
        for (int j = 0; j < AXES; j++) square += (normal[j] >> shift) * (normal[j] >> shift);
        int64_t length = square_root((uint64_t)square);
        if (length == 0) continue;
        int64_t angle = angle_of(dot >> shift, length);
        for (int j = 0; j < AXES; j++) {
            int64_t unit = (normal[j] >> shift) * (1 << 14) / length;
            by_angle[j] += unit * angle;
            alike[j] += unit;
        }
    }
}

typedef struct {
    Place place;
    View view;
    int32_t by_area[PAIR], by_angle[PAIR], alike[PAIR], mean[PAIR], drift[PAIR], across[PAIR], nearest[PAIR], twin[PAIR];
} Sight;

INLINE Direction *direction_at(const Values *g, int32_t v) { return (Direction *)(g->directions.data + 2 * AXES * (int64_t)v); }

static void look(const Work *w, int32_t v, int32_t last, Sight *s) {
    const Values *g = &w->values;
    int32_t size = FINE * half(g);
    int64_t by_area[AXES], by_angle[AXES], alike[AXES], mean[AXES] = {0, 0, 0}, drift[AXES] = {0, 0, 0}, across[AXES] = {0, 0, 0};
    survey(w, v, &s->place);
    expect(&w->corners, g, v, by_area, by_angle, alike);
    const Around *r = &s->place.around;
    for (int i = 0; i < r->neighbours; i++) {
        const Direction *d = direction_at(g, r->neighbour[i]);
        for (int j = 0; j < AXES; j++) mean[j] += d[0].axis[j], drift[j] += d[0].axis[j] - d[1].axis[j];
    }
    for (int i = 0; i < r->flaps; i++) {
        Flap f = r->flap[i];
        for (int j = 0; j < AXES; j++)
            across[j] += (int64_t)direction_at(g, f.a)->axis[j] + direction_at(g, f.b)->axis[j] - direction_at(g, f.c)->axis[j];
    }
    Direction m = scaled(mean, size);
    if (r->neighbours == 0 && last >= 0) m = *direction_at(g, last);
    bool flat = by_area[0] == 0 && by_area[1] == 0 && by_area[2] == 0;
    Direction d = flat ? m : scaled(by_area, size);
    Direction e = flat ? m : scaled(by_angle, size), f = flat ? m : scaled(alike, size);
    direction_at(g, v)[1] = d;
    int64_t fixed[AXES];
    for (int j = 0; j < AXES; j++) fixed[j] = d.axis[j] + (r->neighbours > 0 ? divided(drift[j], r->neighbours) : 0);
    Direction c = scaled(fixed, size), a = r->flaps > 0 ? scaled(across, size) : m;
    s->view = view_of(&d, size);
    seen_in(&s->view, &d, s->by_area);
    seen_in(&s->view, &e, s->by_angle);
    seen_in(&s->view, &f, s->alike);
    seen_in(&s->view, &m, s->mean);
    seen_in(&s->view, &c, s->drift);
    seen_in(&s->view, &a, s->across);
    /* the known normal nearest to the expected one, here or around */
    int64_t best = INT64_MAX;
    Direction n = m;
    for (int i = -1; i < r->neighbours; i++) {
        int32_t u = i < 0 ? s->place.twin : r->neighbour[i];
        if (u < 0) continue;
        const Direction *o = direction_at(g, u);
        int64_t away = 0;
        for (int j = 0; j < AXES; j++) away += size_of(o->axis[j] - d.axis[j]);
        if (away < best) best = away, n = *o;
    }
    seen_in(&s->view, &n, s->nearest);
    Direction t = s->place.twin >= 0 ? *direction_at(g, s->place.twin) : r->neighbours > 0 ? *direction_at(g, r->neighbour[0]) : m;
    seen_in(&s->view, &t, s->twin);
}

static bool code_axis(Work *w, const Sight *s, int j, int32_t *pair, int32_t *gaps, int32_t *hits) {
    const Values *g = &w->values;
    const Place *p = &s->place;
    int32_t far = s->view.size, base = s->by_area[j], angle = s->by_angle[j] - base, alike = s->alike[j] - base;
    int32_t first = j > 0 ? gaps[0] : 0, near = s->nearest[j] - base;
    Forecast f = {.term = {angle, alike, s->drift[j] - base, s->mean[j] - base, s->across[j] - base, near, first},
        .hint = {p->error >= 0 ? p->error : FINE, size_of(angle) + size_of(alike), size_of(first), size_of(near)}};
    choose_learners(&f, g, PAIR, j, p->number, p->valence);
    foresee(&f, far, true);
    int32_t guess = base + f.shift, bucket = size_class(f.typical), unit = f.typical / 2 + 4, twin = p->twin >= 0;

    Expectation e;
    e.prediction[0] = base;
    e.prediction[1] = s->by_angle[j];
    e.prediction[2] = s->drift[j];
    e.prediction[3] = s->twin[j];
    e.prediction[4] = s->nearest[j];
    e.prediction[5] = s->mean[j];
    e.prediction[6] = guess;
    int32_t off[PREDICTIONS];
    for (int i = 0; i < PREDICTIONS; i++) e.prediction[i] = within(e.prediction[i], -far, far);
    for (int i = 0; i < PREDICTIONS; i++) off[i] = e.prediction[i] - e.prediction[6];

    e.scale = f.typical;
    e.asks = MOST_ASKS;
    e.scale_context = (bucket * 2 + twin) * PAIR + j;
    e.hit_context = (j == 0 ? 0 : *hits != 0 ? 2 : 1) * 8 + p->number * 2 + twin;
    e.context[0] = (bucket * BASES + p->number) * PAIR + j;
    e.context[1] = three_classes(off[0], off[1], off[2], FINE / 2, FINE / 2);
    e.context[2] = three_classes(off[3], off[4], off[5], FINE / 2, unit);
    e.context[3] = ((s->view.pole * 2 + (s->view.sign > 0)) * PAIR + j) * VALENCES + p->valence;
    e.context[4] = three_classes(off[0], off[4], first, FINE / 4, FINE / 4);
    e.context[5] = j == 0 ? 0 : *hits + (1 << PREDICTIONS);
    e.set = j;

    int32_t value = code_value(&w->coder, &w->model, &e, w->coder.reading ? 0 : pair[j] / FINE);
    if (value < -far / FINE || value > far / FINE) return false;
    pair[j] = value * FINE;
    *hits = hits_of(&e, value);
    gaps[j] = take(&f, pair[j] - base);
    return true;
}

static bool code_vertex(Work *w, int32_t v, int32_t last) {
    const Values *g = &w->values;
    Sight s;
    int32_t pair[PAIR] = {0, 0}, gaps[PAIR] = {0, 0}, hits = 0, k = half(g), *own = g->values.data + PAIR * (int64_t)v;
    look(w, v, last, &s);
    if (!w->coder.reading) {
        Direction d = unfolded((own[0] - k) * FINE, (own[1] - k) * FINE, s.view.size);
        seen_in(&s.view, &d, pair);
    }
    for (int j = 0; j < PAIR; j++)
        if (!code_axis(w, &s, j, pair, gaps, &hits)) return false;
    View plain = {.first = 0, .second = 1, .pole = 2, .sign = 1, .size = s.view.size};
    Direction d = direction_at(g, v)[0] = back_from(&s.view, pair);
    seen_in(&plain, &d, pair);
    for (int j = 0; j < PAIR; j++) {
        own[j] = pair[j] / FINE + k;
        g->gaps.data[PAIR * (int64_t)v + j] = gaps[j];
    }
    return true;
}

int64_t code_normals(Coder coder, ValueModel model, Corners corners, Values values, int64_t first, int64_t count) {
    const int32_t *largest = values.largest.data;
    if (values.values.columns != PAIR || values.directions.rows != values.values.rows || values.largest.size != PAIR
        || largest[0] != largest[1] || largest[0] < 2 || largest[0] % 2 != 0)
        return MISUSED;
    Work work = {.model = model, .corners = corners, .values = values};
    return code_vertices(coder, &work, learners_of(PAIR), first, count, code_vertex);
}
