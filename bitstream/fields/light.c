/* Positions on a grid by a small model: many times quicker to decode than by grid.simd.c (specification, V 15; where
 * parts repeat, V 17.12).
 *
 * One guess, from the parallelograms, and one adaptive model of the difference by how large differences were around:
 * no mixer, no learner. It takes a few percent more bytes on scans and more on CAD parts, and most of a page's first
 * decode disappears. The decoder for pages that know nothing else is built from this file. */
#include "bitstream/fields/distances.h"
#include "bitstream/fields/twins.h"

enum {
    AXES = 3,
    MOST_ENDS = 16,
    NORMAL_BITS = 14,
};

typedef struct { /* what is known of a vertex before its axes */
    int32_t flaps;
    int32_t guess[AXES], size[AXES]; /* of values, and of what is expected of the error, in 1/16 */
    int32_t across[2][AXES];         /* what the first two flaps say */
    int32_t normal[AXES];
    int axis[AXES]; /* in the order in which they are coded */
} LightPlace;

/* Shorten a normal, and order the axes by it: the one nearest to it comes last (V 8.5). */
INLINE void face(LightPlace *p, const int64_t *normal) {
    uint64_t bits = 1;
    for (int j = 0; j < AXES; j++) bits |= (uint64_t)(normal[j] < 0 ? -normal[j] : normal[j]);
    int shift = (int)largest(64 - __builtin_clzll(bits) - NORMAL_BITS, 0);
    for (int j = 0; j < AXES; j++) p->normal[j] = (int32_t)(normal[j] >> shift);
    int32_t x = size_of(p->normal[0]), y = size_of(p->normal[1]), z = size_of(p->normal[2]);
    int first = (x > y) + (x > z), second = (y >= x) + (y > z);
    p->axis[first] = 0;
    p->axis[second] = 1;
    p->axis[3 - first - second] = 2;
}

/* Look around a vertex (V 15.3, V 15.4). */
OFTEN static void survey(const Corners *c, const Light *g, int32_t v, LightPlace *p) {
    const int32_t *vertex = c->faces.data, *x = g->values.data, *gap = g->gaps.data;
    int32_t flaps = 0, ends = 0;
    int32_t places[AXES] = {0, 0, 0}, lowest[AXES] = {0, 0, 0}, highest[AXES] = {0, 0, 0};
    int32_t sums[AXES] = {0, 0, 0}, gaps[AXES] = {0, 0, 0};
    int64_t normal[AXES] = {0, 0, 0};
    for (int32_t i = c->starts.data[v]; i < c->starts.data[v + 1] && flaps < MOST_FLAPS; i++) {
        int32_t k = c->corners.data[i], end[2] = {vertex[next_corner(k)], vertex[previous_corner(k)]};
        int32_t beyond = c->opposite.data[k];
        bool known[2] = {end[0] < v, end[1] < v};
        const int32_t *a = x + AXES * (int64_t)end[0], *b = x + AXES * (int64_t)end[1];
        if (flaps == 0)
            for (int side = 0; side < 2; side++) {
                if (!known[side] || ends == MOST_ENDS) continue;
                const int32_t *at = gap + AXES * (int64_t)end[side], *from = side == 0 ? a : b;
                for (int j = 0; j < AXES; j++) sums[j] += from[j], gaps[j] += at[j];
                ends++;
            }
        if (!known[0] || !known[1] || beyond < 0 || vertex[beyond] >= v) continue;
        const int32_t *o = x + AXES * (int64_t)vertex[beyond];
        int64_t p0 = b[0] - a[0], p1 = b[1] - a[1], p2 = b[2] - a[2];
        int64_t q0 = o[0] - a[0], q1 = o[1] - a[1], q2 = o[2] - a[2];
        normal[0] += p1 * q2 - p2 * q1;
        normal[1] += p2 * q0 - p0 * q2;
        normal[2] += p0 * q1 - p1 * q0;
        for (int j = 0; j < AXES; j++) {
            int32_t across = a[j] + b[j] - o[j];
            places[j] += across;
            if (flaps < 2) p->across[flaps][j] = across;
            lowest[j] = flaps == 0 ? across : (int32_t)least(lowest[j], across);
            highest[j] = flaps == 0 ? across : (int32_t)largest(highest[j], across);
        }
        flaps++;
    }
    p->flaps = flaps;
    face(p, normal);
    for (int j = 0; j < AXES; j++) {
        if (flaps > 0) p->guess[j] = divided(FINE * places[j], flaps);
        else p->guess[j] = ends > 0 ? divided(FINE * sums[j], ends) : v > 0 ? FINE * x[AXES * (int64_t)(v - 1) + j] : 0;
        if (flaps > 1) p->size[j] = 12 * (highest[j] - lowest[j]);
        else p->size[j] = ends > 0 ? gaps[j] / ends : g->largest.data[j];
    }
}

INLINE bool is_lean(const Light *light) { return BSMDEC_LIGHT != 1 && light->twins; }

typedef struct {
    RangeCoder *coder;
    Corners corners;
    Light light;
} LightCoder;

/* Look for images of a vertex, and code whether it is where one is (V 17.12). */
static bool code_by_images(LightCoder *w, int32_t v, const LightPlace *p, Around *around) {
    const Light *g = &w->light;
    const int32_t *x = g->values.data + AXES * (int64_t)v;
    gather_around(&w->corners, v, around);
    seek_images(g->twins, &w->corners, &g->values, around, v, p->guess);
    bool done = g->twins->asks_whole
        && code_whole(w->coder, g->twins, &w->corners, &g->values, around, v, p->guess, p->size,
            g->largest.data);
    for (int j = 0; done && j < AXES; j++) g->gaps.data[AXES * (int64_t)v + j] = size_of(FINE * x[j] - p->guess[j]);
    return done;
}

/* Guess the image of a trusted twin, if there is one, and say what decisions about axis j depend on (V 17.12). */
INLINE void expect_image(
    DistanceModel *m, const Light *g, const LightPlace *p, const Around *r, int j, int32_t *guess) {
    enum { UNSURE = CERTAINTIES, NO_NEIGHBOR = 7 };
    const Twins *t = g->twins;
    int32_t sure = UNSURE, off[2] = {0, 0};
    int chosen[2];
    choose_twins(t, chosen);
    if (chosen[0] >= 0) {
        const Candidate *c = t->candidate + chosen[0];
        sure = certainty(t, c);
        if (c->support > 1 && t->image[c->image].trust >= ONE / 5)
            *guess = within(c->place[j], 0, FINE * g->largest.data[j]), m->size = 0;
    }
    for (int i = 0; i < 2 && i < p->flaps; i++) off[i] = FINE * p->across[i][j] - *guess;
    int32_t beside = r->neighbors == 0 ? NO_NEIGHBOR
        : within(g->values.data[AXES * (int64_t)r->neighbor[0] + j] - whole(*guess), -3, 3) + 3;
    int32_t context[LEAN_INPUTS] = {size_class_of(m->size) * LIGHT_KINDS + m->kind,
        (beside * 7 + signed_class(off[0], FINE)) * 7 + signed_class(off[1], FINE), sure};
    for (int i = 0; i < LEAN_INPUTS; i++) m->context[i] = (int64_t)(i * LEAN_CONTEXTS + context[i]) * LEAN_NODES;
}

OFTEN static bool code_vertex(void *work, int64_t v) {
    LightCoder *w = work;
    RangeCoder *coder = w->coder;
    const Light *g = &w->light;
    Twins *t = g->twins;
    DistanceModel m = {.coder = coder, .slots = g->slots.data, .weights = is_lean(g) ? g->weights : NULL};
    Around around;
    LightPlace p;
    survey(&w->corners, g, (int32_t)v, &p);
    bool done = is_lean(g) && code_by_images(w, (int32_t)v, &p, &around);
    int32_t *x = g->values.data + AXES * v, *gap = g->gaps.data + AXES * v, before = 0;
    int64_t square = 0, used = 0, dot = 0;
    for (int j = 0; j < AXES; j++) square += (int64_t)p.normal[j] * p.normal[j];
    for (int step = 0; step < AXES && !done; step++) {
        int j = p.axis[step];
        int64_t normal = p.normal[j], tilt = step == 0 ? 0 : -normal * dot / (square - used + (square >> 1) + 1);
        int32_t most = g->largest.data[j], plain = within(p.guess[j] + tilt, 0, FINE * most), guess = plain;
        m.size = ((8 - step) * p.size[j] + before) >> 3;
        m.kind = (int32_t)least(p.flaps, 3) * AXES + step;
        if (is_lean(g)) expect_image(&m, g, &p, &around, j, &guess);
        int32_t level = whole(guess), distance = is_reading(coder) ? 0 : x[j] - level;
        int32_t value = level + code_distance(&m, guess - FINE * level, distance);
        if (value < 0 || value > most) return false;
        x[j] = value;
        if (is_lean(g)) t->axis[step] = j, t->value[step] = value, t->known_axes = step + 1;
        gap[j] = size_of(FINE * value - plain);
        before += gap[j];
        dot += normal * (FINE * value - p.guess[j]);
        used += normal * normal;
    }
    return !is_lean(g) || remember_twins(t, &g->values, &around, (int32_t)v);
}

int64_t code_light(RangeCoder *coder, Corners corners, Light light, int64_t first, int64_t count) {
    LightCoder work = {.coder = coder, .corners = corners, .light = light};
    return code_rows(coder, corners.rank.size, first, count, AXES * VALUE_BYTES, code_vertex, &work);
}

/* Which float of the cell of a grid each coordinate is (specification, V 16). */

enum { HISTORIES = 8, SLOTS = HISTORIES + 1 };

typedef struct {
    RangeCoder *coder;
    Floats floats;
    const int32_t *values;
    const int64_t *low, *nearest, *high;
    int64_t *chosen;
} Cells;

static bool code_cells(void *work, int64_t i) {
    Cells *w = work;
    for (int j = 0; j < AXES; j++) {
        int64_t at = AXES * i + j, count = w->high[at] - w->low[at], *number = w->chosen + at;
        if (count <= 0 || count > UINT32_MAX) return false;
        int64_t *known = w->floats.known.data + j * w->floats.known.columns + w->values[at];
        int64_t *latest = w->floats.latest.data + j;
        bool new = *known == NO_FLOAT;
        int64_t guess = new ? w->nearest[at] : *known;
        uint32_t *slot = w->floats.slots.data + SLOTS * j + (new ? HISTORIES : *latest & (HISTORIES - 1));
        int same = code_plain_bit(w->coder, slot, *number == guess);
        if (!new) *latest = (2 * *latest + same) & (HISTORIES - 1);
        *number = same ? guess : w->low[at] + code_uniform(w->coder, *number - w->low[at], count);
        *known = *number;
    }
    return true;
}

/* Code the numbers of floats, from `low` to below `high`, of values of a grid: each may be the latest of its value, or
 * else, where the value is new, the `nearest` to its place. Returns of how many vertices. */
int64_t code_floats(RangeCoder *coder, Floats f, ConstInts2 values, ConstLongs2 low, ConstLongs2 nearest,
    ConstLongs2 high, Longs2 chosen) {
    int64_t rows = values.rows;
    Cells work = {.coder = coder, .floats = f, .values = values.data, .low = low.data, .nearest = nearest.data,
        .high = high.data, .chosen = chosen.data};
    return code_rows(coder, rows, 0, rows, AXES * VALUE_BYTES, code_cells, &work);
}
