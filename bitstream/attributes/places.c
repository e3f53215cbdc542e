/* What is known around a vertex before its values (specification, A 3). */
#include "bitstream/attributes/places.h"

enum { NARROW = 1 << 14, MOST_RATIO = 8 * WHOLE, MOST_ERROR = 1 << 28 };

typedef struct {
    int64_t along, beside, weight;
} Spot;

int64_t square_root(uint64_t x) { /* rounded down */
    uint64_t root = 0;
    for (uint64_t bit = UINT64_C(1) << 62; bit != 0; bit >>= 2) {
        bool fits = x >= root + bit;
        if (fits) x -= root + bit;
        root = (root >> 1) + (fits ? bit : 0);
    }
    return (int64_t)root;
}

INLINE int64_t dot(const int64_t *x, const int64_t *y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }

/* Where x is over the edge from a to b; false if that has no length (A 3.3). */
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
    int64_t area = square_root((uint64_t)dot(normal, normal));
    spot->along = within(dot(edge, to) * WHOLE / square, -MOST_RATIO, MOST_RATIO);
    spot->beside = within(area * WHOLE / square, 0, MOST_RATIO);
    spot->weight = within(square * 256 / (area + 1), 1, WHOLE);
    return true;
}

/* What the geometry tells of a base (A 3.4). */
static void look_over(const Values *g, int32_t v, Base *base) {
    Spot spot, far;
    base->along = WHOLE / 2, base->beside = 0, base->weight = 1;
    base->share[0] = base->share[1] = WHOLE, base->share[2] = -WHOLE;
    if (g->geometry.rows == 0 || !locate(g, base->a, base->b, v, &spot)) return;
    base->along = (int32_t)spot.along, base->beside = (int32_t)spot.beside, base->weight = (int32_t)spot.weight;
    if (base->c < 0 || !locate(g, base->a, base->b, base->c, &far) || far.beside < WHOLE / 64) return;
    int64_t ratio = -(spot.beside * WHOLE / far.beside);
    if (ratio < -MOST_RATIO) return;
    base->share[2] = (int32_t)ratio;
    base->share[1] = (int32_t)(spot.along - (ratio * far.along >> 16));
    base->share[0] = WHOLE - base->share[1] - base->share[2];
}

/* Sizes of the gaps of a vertex, added. */
static int32_t error_at(const Values *g, int32_t v) {
    int64_t sum = 0;
    for (int j = 0; j < g->gaps.columns; j++) sum += size_of(gap_at(g, v, j));
    return (int32_t)least(sum, MOST_ERROR);
}

void survey(const Work *w, int32_t v, Place *p) {
    const Values *g = &w->values;
    const Corners *c = &w->corners;
    const int32_t *vertex = c->faces.data, *rank = c->rank.data;
    int32_t now = rank[v];
    gather_around(c, v, &p->around);
    p->valence = within(faces_at(c, v) - 3, 0, VALENCES - 1);
    p->bases = 0;
    for (int32_t i = c->starts.data[v]; i < c->starts.data[v + 1] && p->bases < MOST_BASES; i++) {
        int32_t k = c->corners.data[i], a = vertex[next_corner(k)], b = vertex[previous_corner(k)];
        if (rank[a] >= now || rank[b] >= now || a == b) continue;
        int32_t tip = c->opposite.data[k];
        Base base = {.a = a, .b = b, .c = tip >= 0 && rank[vertex[tip]] < now ? vertex[tip] : -1, .tip = tip};
        base.error = error_at(g, a) + error_at(g, b) + 2 * error_at(g, base.c >= 0 ? base.c : a);
        look_over(g, v, &base);
        int at = p->bases++;
        for (; at > 0 && p->base[at - 1].error > base.error; at--) p->base[at] = p->base[at - 1];
        p->base[at] = base;
    }
    p->number = (int)least(p->bases, BASES - 1);
    p->twin = -1;
    for (int32_t t = g->twin.data[v], steps = 0; t != v && steps < MOST_TWINS; t = g->twin.data[t], steps++)
        if (rank[t] < now && (p->twin < 0 || rank[t] > rank[p->twin])) p->twin = t;
    int64_t errors = 0;
    int32_t near = p->around.neighbours;
    for (int i = 0; i < near; i++) errors += error_at(g, p->around.neighbour[i]);
    p->error = near > 0 ? divided(errors, (int32_t)g->gaps.columns * near) : -1;
}

/* What v would be, less `otherwise`, if it balanced the others around the neighbours where it is all that is missing. */
int32_t balance(const Work *w, const Around *around, int j, int32_t otherwise) {
    const Values *g = &w->values;
    int64_t columns = g->values.columns, total = 0;
    int32_t found = 0;
    for (int i = 0; i < around->neighbours; i++) {
        int32_t u = around->neighbour[i];
        const int64_t *sum = g->sums.data + (columns + 1) * u;
        if (faces_at(&w->corners, u) - sum[columns] > 1) continue;
        total += limited(FINE * ((sum[columns] + 1) * value_at(g, u, j) - sum[j]) - otherwise);
        found++;
    }
    return found > 0 ? divided(total, found) : 0;
}

/* How the parallelograms over the other two edges of the triangle behind a base fail. */
int32_t fold_at(const Work *w, int32_t v, const Base *base, int j) {
    const Corners *c = &w->corners;
    const Values *g = &w->values;
    int32_t sum = 0;
    for (int side = 0; side < 2; side++) {
        int32_t k = side == 0 ? previous_corner(base->tip) : next_corner(base->tip), beyond = c->opposite.data[k];
        if (beyond < 0 || c->rank.data[c->faces.data[beyond]] >= c->rank.data[v]) continue;
        int32_t far = c->faces.data[k], near = far == base->a ? base->b : base->a;
        sum += value_at(g, far, j) + value_at(g, c->faces.data[beyond], j) - value_at(g, base->c, j) - value_at(g, near, j);
    }
    return FINE / 2 * sum;
}

/* The gaps around the best base, in three classes; 0 if there is none. */
int32_t gap_classes(const Work *w, const Place *p, int j, int32_t unit) {
    const Values *g = &w->values;
    const Base *best = &p->base[0];
    if (p->bases == 0) return 0;
    int32_t third = best->c >= 0 ? best->c : best->a;
    return three_classes(gap_at(g, best->a, j), gap_at(g, best->b, j), gap_at(g, third, j), unit, unit);
}
