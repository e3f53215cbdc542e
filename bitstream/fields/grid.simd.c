/* Positions on a grid, vertex after vertex, predicted from coded neighbors (specification, V 7 to V 10).
 *
 * The order goes where most triangles are known around the next vertex (queues, corners.c), so that it has two flaps
 * or more to be predicted from. Its position is foretold from parallelograms, planes, closing rings, and values seen
 * before on the axis, which CAD parts repeat; a learner for each kind of surroundings finds how meshes deviate from a
 * parallelogram, and how large the error will be. The axis along which the plane is steepest comes last: the plane
 * then tells it. What the prediction is worth, expectation.simd.c decides for each value. Everything is an integer:
 * the surroundings steer the decoder. */
#include "bitstream/fields/twins.h"

enum {
    AXES = 3,
    STEPS = 3, /* axes of a vertex in the order in which they are coded */
    GUESSES = 4 * 2 * VALENCES,
    LEARNERS = GUESSES + 4 * STEPS,
    ECHO_CLASSES = 15,
};

/* How meshes deviate from parallelograms, as vectors in 1/16 (V 8.3). */
enum { LENGTH, SKEW, TURN, FOLD, SHAPES };

/* If a vertex lies in a plane, its coded axes tell the others (V 8.5, V 8.6). */
typedef struct {
    int32_t normal[AXES];
    int64_t square, used, dot; /* of the normal; of its coded axes; errors of these times the normal */
} Plane;

typedef struct { /* what is known of a vertex before its axes */
    Around around;
    int32_t flaps, valence; /* capped */
    int32_t across[MOST_FLAPS][AXES]; /* a + b - c of each flap, best-behaved first; all in 1/16 */
    int32_t base[AXES], mean[AXES], closing[AXES], error_near[AXES], apart[AXES], shape[SHAPES][AXES];
    Plane whole, plane[2];
    int axis[STEPS];
} GridPlace;

/* Learn from a value, all weights or, with twins, one in turn. */
INLINE int32_t take_all(Forecast *f, int32_t error, Twins *t) {
    int32_t gap = error - f->shift;
    if (!t) return take(f, error);
    learn_in_turn(f->guess, TERMS, f->term, error, f->typical, t->values % TERMS);
    learn_in_turn(f->size, HINTS, f->hint, gap_seen(f, gap), f->typical, t->values % HINTS);
    t->values++;
    return gap;
}

/* Best-behaved flaps first: where errors were small (V 8.1). */
static void sort_flaps(const Grid *g, Around *r) {
    int64_t errors[MOST_FLAPS];
    for (int i = 0; i < r->flaps; i++) {
        Flap flap = r->flap[i];
        int64_t own = 2 * (int64_t)error_at(&g->gaps, flap.c) + error_at(&g->gaps, flap.a) + error_at(&g->gaps, flap.b);
        int at = i;
        for (; at > 0 && errors[at - 1] > own; at--) {
            errors[at] = errors[at - 1];
            r->flap[at] = r->flap[at - 1];
        }
        errors[at] = own;
        r->flap[at] = flap;
    }
}

static void start_plane(Plane *p, const int64_t *normal) {
    p->square = p->used = p->dot = 0;
    int64_t most = 0;
    int shift = 0;
    for (int j = 0; j < AXES; j++) most = largest(most, normal[j] < 0 ? -normal[j] : normal[j]);
    while (most >> shift >= 1 << 14) shift++;
    for (int j = 0; j < AXES; j++) {
        p->normal[j] = (int32_t)(normal[j] >> shift);
        p->square += (int64_t)p->normal[j] * p->normal[j];
    }
}

INLINE int64_t unused(const Plane *p) { return p->square - p->used + (p->square >> 6) + 1; }

/* Where axis j is, if the vertex lies in the plane. */
INLINE int32_t tilt(const Plane *p, int j) { return limited(-p->normal[j] * p->dot / unused(p)); }

INLINE void pass_axis(Plane *p, int j, int32_t error) {
    p->dot += (int64_t)p->normal[j] * error;
    p->used += (int64_t)p->normal[j] * p->normal[j];
}

/* Add what flap i says of the shape (V 8.3). */
static void add_shape(const Corners *corners, const int32_t *x, int32_t v, Flap flap, int32_t shape[SHAPES][AXES]) {
    const int32_t *a = x + AXES * (int64_t)flap.a, *b = x + AXES * (int64_t)flap.b, *c = x + AXES * (int64_t)flap.c;
    int32_t along[AXES], out[AXES];
    int64_t dot = 0, square = 0;
    for (int j = 0; j < AXES; j++) {
        along[j] = b[j] - a[j];
        out[j] = 8 * (a[j] + b[j]) - 16 * c[j];
        dot += (int64_t)out[j] * along[j];
        square += (int64_t)along[j] * along[j];
    }
    int32_t skew = square > 0 ? within(-dot * 16 / square, -384, 384) : 0; /* 1/256 */
    int32_t turn = within(faces_at(corners, flap.a) - faces_at(corners, flap.b), -8, 8);
    for (int j = 0; j < AXES; j++) {
        shape[LENGTH][j] += out[j];
        shape[SKEW][j] += skew * along[j] >> 4;
        shape[TURN][j] += turn * along[j] * 4;
    }
    for (int side = 0; side < 2; side++) { /* how the parallelograms over the other two edges of the face fail */
        int32_t k = side == 0 ? previous_corner(flap.corner) : next_corner(flap.corner);
        int32_t beyond = corners->opposite.data[k];
        if (beyond < 0 || corners->rank.data[corners->faces.data[beyond]] >= corners->rank.data[v]) continue;
        const int32_t *far = corners->faces.data[k] == flap.a ? a : b, *near = far == a ? b : a;
        const int32_t *y = x + AXES * (int64_t)corners->faces.data[beyond];
        for (int j = 0; j < AXES; j++) shape[FOLD][j] += 8 * (far[j] + y[j] - c[j] - near[j]);
    }
}

static void average(const Grid *g, int32_t last, GridPlace *p) {
    const int32_t *x = g->values.data;
    const Around *r = &p->around;
    for (int j = 0; j < AXES; j++) {
        int64_t across = 0, near = 0, error = 0;
        for (int i = 0; i < r->flaps; i++) {
            Flap f = r->flap[i];
            int64_t a = x[AXES * (int64_t)f.a + j], b = x[AXES * (int64_t)f.b + j], c = x[AXES * (int64_t)f.c + j];
            across += p->across[i][j] = (int32_t)(a + b - c) * FINE;
        }
        for (int i = 0; i < r->neighbors; i++) {
            near += x[AXES * (int64_t)r->neighbor[i] + j] * FINE;
            error += size_of(g->gaps.data[AXES * (int64_t)r->neighbor[i] + j]);
        }
        int32_t most = g->largest.data[j];
        p->mean[j] = r->neighbors > 0 ? divided(near, r->neighbors) : last < 0 ? 0
            : x[AXES * (int64_t)last + j] * FINE;
        p->error_near[j] = r->neighbors > 0 ? divided(error, r->neighbors) : last < 0 ? FINE * most : most;
        p->base[j] = r->flaps > 0 ? divided(across, r->flaps) : p->mean[j];
        p->apart[j] = r->flaps > 1 ? size_of(p->across[0][j] - p->across[1][j]) : 0;
        for (int i = 0; i < SHAPES; i++) p->shape[i][j] = 0;
    }
}

/* Planes of the two best flaps and of all; the axis nearest to the normal of all comes last. */
static void span_planes(const Grid *g, GridPlace *p) {
    int64_t normal[AXES] = {0, 0, 0};
    for (int i = 0; i < p->around.flaps; i++) {
        Flap flap = p->around.flap[i];
        const int32_t *x = g->values.data, *a = x + AXES * (int64_t)flap.a, *b = x + AXES * (int64_t)flap.b;
        const int32_t *c = x + AXES * (int64_t)flap.c;
        int64_t own[AXES];
        for (int j = 0; j < AXES; j++) {
            int s = (j + 1) % 3, t = (j + 2) % 3;
            own[j] = (int64_t)(b[s] - a[s]) * (c[t] - a[t]) - (int64_t)(b[t] - a[t]) * (c[s] - a[s]);
            normal[j] += own[j];
        }
        if (i < 2) start_plane(&p->plane[i], own);
    }
    start_plane(&p->whole, normal);
    for (int i = 0; i < STEPS; i++) {
        int k = i;
        for (; k > 0 && size_of(p->whole.normal[p->axis[k - 1]]) > size_of(p->whole.normal[i]); k--)
            p->axis[k] = p->axis[k - 1];
        p->axis[k] = i;
    }
}

OFTEN static void look_around(const Corners *corners, const Grid *g, int32_t v, int32_t last, GridPlace *p) {
    gather_around(corners, v, &p->around);
    sort_flaps(g, &p->around);
    p->flaps = (int32_t)least(p->around.flaps, 3);
    p->valence = within(faces_at(corners, v) - 3, 0, VALENCES - 1);
    average(g, last, p);
}

OFTEN static void survey(const Corners *corners, const Grid *g, int32_t v, GridPlace *p) {
    for (int i = 0; i < p->around.flaps; i++) add_shape(corners, g->values.data, v, p->around.flap[i], p->shape);
    if (p->around.flaps > 1)
        for (int i = 0; i < SHAPES; i++)
            for (int j = 0; j < AXES; j++) p->shape[i][j] = divided(p->shape[i][j], p->around.flaps);
    for (int j = 0; j < AXES; j++) /* V 8.4 */
        p->closing[j] = balance(corners, &g->values, &g->sums, &p->around, j, p->base[j]);
    span_planes(g, p);
}

/* Predictions by twins in the place of others, and their contexts (V 17.6). */
INLINE void expect_twins(const Twins *t, int j, int step, int kind, int32_t far, int32_t unit, Expectation *e) {
    int32_t guess = e->prediction[PREDICTIONS - 1], image_off = 0, off[2] = {0, 0};
    int chosen[2];
    choose_twins(t, chosen);
    for (int i = 0; i < TWIN_PREDICTIONS; i++) e->twin[i] = -1;
    e->contexts = TWIN_CONTEXTS;
    e->context[0] = e->context[3];
    e->context[1] = e->context[5];
    e->context[2] = 1008 + kind;
    for (int i = 0; i < 2 && chosen[i] >= 0; i++) {
        const Candidate *c = t->candidate + chosen[i];
        int32_t place = within(c->place[j], 0, far), sure = certainty(t, c);
        e->prediction[TWIN_AT[i]] = place;
        e->twin[i] = i * CERTAINTIES + sure;
        if (i == 0) {
            image_off = place - guess;
            int32_t trusted = t->image[c->image].trust >= ONE / 2;
            e->context[2] = (((sure / 12 * STEPS + sure % STEPS) * 2 + trusted) * 7
                + signed_class(image_off, (int32_t)largest(unit, FINE / 2))) * 3;
        } else {
            e->context[2] += 1 + (size_of(place - guess - image_off) < 24);
        }
    }
    bool echoed = t->echo_class > 0;
    for (int i = 0; i < 2 && echoed; i++) {
        int32_t place = within(t->echoed[i][j], 0, far);
        off[i] = place - guess;
        e->prediction[TWIN_AT[2 + i]] = place;
        e->twin[2 + i] = 2 * CERTAINTIES + (i * ECHO_CLASSES + t->echo_class - 1) * STEPS + step;
    }
    e->context[3] = CONTEXT_SIZE + (echoed ? three_classes(off[0], off[1], image_off, FINE / 2, unit)
        + 343 * (t->echo_class > 6) : 686 + signed_class(image_off, FINE / 2));
}

/* Code a value; false if it is invalid (V 9, V 10). */
OFTEN static bool code_axis(RangeCoder *coder, const ValueModel *model, Grid *g, int32_t v, int step, GridPlace *p,
    int32_t *hits, int32_t *first_gap) {
    const Around *r = &p->around;
    int j = p->axis[step], flaps = p->flaps;
    int32_t most = g->largest.data[j], far = FINE * most, base = p->base[j], mean = p->mean[j];
    int32_t *x = g->values.data, tilted = tilt(&p->whole, j);
    const Flap *best = r->flap;

    Learner *learners = (Learner *)g->learners.data;
    Forecast f = {.guess = learners + (flaps * 2 + (step == 2)) * VALENCES + p->valence,
        .size = learners + GUESSES + flaps * STEPS + step,
        .term = {tilted, mean - base, p->closing[j], p->shape[LENGTH][j], p->shape[SKEW][j], p->shape[TURN][j],
            p->shape[FOLD][j]}};
    foresee(&f, far);
    int32_t hint[HINTS] = {p->error_near[j], p->apart[j], *first_gap, size_of(f.shift - tilted)};
    for (int i = 0; i < HINTS; i++) f.hint[i] = hint[i];
    foresee_error(&f, far, flaps > 0);
    int32_t shift = f.shift, typical = f.typical;
    int32_t bucket = size_class(typical >> 1), unit = typical / 2 + 4;

    int32_t in_first = flaps > 0 ? p->across[0][j] + tilt(&p->plane[0], j) : mean;
    int32_t second = r->flaps > 1 ? p->across[1][j] : base;
    int64_t words = g->seen.columns;
    Expectation e;
    e.contexts = CONTEXTS;
    e.refutations = 0;
    e.prediction[0] = base + tilted;
    e.prediction[1] = flaps > 0 ? p->across[0][j] : mean;
    e.prediction[2] = second;
    e.prediction[3] = r->flaps > 1 ? second + tilt(&p->plane[1], j) : mean;
    e.prediction[4] = nearest_seen(g->seen.data + j * words, words, within(whole(in_first), 0, most)) * FINE;
    e.prediction[5] = r->neighbors > 0 ? x[AXES * (int64_t)r->neighbor[0] + j] * FINE : mean;
    e.prediction[6] = base + shift;
    int32_t off[PREDICTIONS];
    settle(&e, 0, far, off);

    int kind = flaps * STEPS + step;
    e.scale = typical;
    e.scale_context = bucket;
    e.hit_context = (step == 0 ? 0 : *hits != 0 ? 2 : 1) * 8 + flaps * 2 + (p->error_near[j] < FINE);
    e.context[0] = bucket * 12 + kind;
    e.context[1] = three_classes(off[0], off[1], off[2], FINE / 2, FINE / 2);
    e.context[2] = three_classes(off[1], off[2], mean - e.prediction[6], unit, unit);
    e.context[3] = three_classes(off[4], p->closing[j] - shift, off[3], FINE / 2, unit);
    e.context[4] = 0;
    if (flaps > 0) {
        const int32_t *gaps = g->gaps.data + j;
        int64_t a = AXES * (int64_t)best->a, b = AXES * (int64_t)best->b, c = AXES * (int64_t)best->c;
        e.context[4] = three_classes(gaps[a], gaps[b], gaps[c], unit, unit);
    }
    e.context[5] = step == 0 ? 0 : *hits + (step << PREDICTIONS);
    e.set = step;
    if (g->twins) {
        expect_twins(g->twins, j, step, kind, far, unit, &e);
        for (int i = 0; step == STEPS - 1 && i < g->twins->misses; i++) {
            const int32_t *cell = g->twins->missed[i], *own = x + AXES * (int64_t)v;
            if (cell[p->axis[0]] == own[p->axis[0]] && cell[p->axis[1]] == own[p->axis[1]])
                e.refuted[e.refutations++] = cell[j];
        }
    }

    int32_t value = ISA(code_value)(coder, model, &e, is_reading(coder) ? 0 : x[AXES * (int64_t)v + j]);
    if (value < 0 || value > most) return false;
    x[AXES * (int64_t)v + j] = value;
    mark_seen(g->seen.data + j * words, value);
    int32_t error = value * FINE - base, gap = take_all(&f, error, g->twins);
    g->gaps.data[AXES * (int64_t)v + j] = gap;
    *hits = hits_of(&e, value);
    if (step == 0) *first_gap = size_of(gap);
    if (g->twins) g->twins->axis[step] = j, g->twins->value[step] = value, g->twins->known_axes = step + 1;
    pass_axis(&p->whole, j, error);
    for (int i = 0; i < 2 && i < r->flaps; i++) pass_axis(&p->plane[i], j, value * FINE - p->across[i][j]);
    return true;
}

typedef struct {
    RangeCoder *coder;
    ValueModel model;
    Corners corners;
    Grid grid;
} GridCoder;

OFTEN static bool code_vertex(void *work, int64_t i) {
    GridCoder *w = work;
    Grid *g = &w->grid;
    int32_t v = g->order.data[i], last = i > 0 ? g->order.data[i - 1] : -1, hits = 0, first_gap = 0;
    GridPlace p;
    const int32_t *x = g->values.data + AXES * (int64_t)v;
    look_around(&w->corners, g, v, last, &p);
    if (g->twins) seek_images(g->twins, &w->corners, &g->values, &p.around, v, p.base);
    if (g->twins && g->twins->asks_whole
        && code_whole(w->coder, g->twins, &w->corners, &g->values, &p.around, v, p.base, p.error_near,
            g->largest.data)) {
        for (int j = 0; j < AXES; j++) {
            g->gaps.data[AXES * (int64_t)v + j] = FINE * x[j] - p.base[j];
            mark_seen(g->seen.data + j * g->seen.columns, x[j]);
        }
    } else {
        survey(&w->corners, g, v, &p);
        if (g->twins) seek_echoes(g->twins, &w->corners, &g->values, &p.around, v);
        for (int step = 0; step < STEPS; step++)
            if (!code_axis(w->coder, &w->model, g, v, step, &p, &hits, &first_gap)) return false;
    }
    pass_on(&w->corners, &g->values, &g->sums, v);
    return !g->twins || remember_twins(g->twins, &g->values, &p.around, v);
}

int64_t ISA(code_grid)(
    RangeCoder *coder, ValueModel model, Corners corners, Grid g, int64_t first, int64_t count) {
    GridCoder work = {.coder = coder, .model = model, .corners = corners, .grid = g};
    return code_rows(coder, corners.rank.size, first, count, AXES * VALUE_BYTES, code_vertex, &work);
}
