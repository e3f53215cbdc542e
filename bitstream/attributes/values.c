/* What all kinds of values share (specification, A 1, A 2). */
#include "bitstream/attributes/attributes.h"

static bool code_one(void *work, int64_t i) {
    Work *w = work;
    const int32_t *order = w->values.order.data;
    if (!w->code(w, order[i], i > 0 ? order[i - 1] : -1)) return false;
    pass_on(&w->corners, &w->values.values, &w->values.sums, order[i]);
    return true;
}

int64_t code_vertices(Work *w, int64_t first, int64_t count) {
    return code_rows(w->coder, w->values.order.size, first, count, MOST_COMPONENTS * VALUE_BYTES, code_one, w);
}

void keep_value(const Values *g, int32_t v, int j, int32_t value) {
    g->values.data[g->values.columns * v + j] = value;
    mark_seen(g->seen.data + j * g->seen.columns, value);
}

/* What is known around a vertex before its values (specification, A 2). */

void survey_values(const Work *w, int32_t v, Place *p) {
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
        base.error = error_at(&g->gaps, a) + error_at(&g->gaps, b) + 2 * error_at(&g->gaps, base.c >= 0 ? base.c : a);
        int at = p->bases++;
        for (; at > 0 && p->base[at - 1].error > base.error; at--) p->base[at] = p->base[at - 1];
        p->base[at] = base;
    }
    p->number = (int)least(p->bases, BASES - 1);
    p->twin = -1;
    for (int32_t t = g->twin.data[v], steps = 0; t != v && steps < MOST_TWINS; t = g->twin.data[t], steps++)
        if (rank[t] < now && (p->twin < 0 || rank[t] > rank[p->twin])) p->twin = t;
    int64_t errors = 0;
    int32_t near = p->around.neighbors;
    for (int i = 0; i < near; i++) errors += error_at(&g->gaps, p->around.neighbor[i]);
    p->error = near > 0 ? divided(errors, (int32_t)g->gaps.columns * near) : -1;
}

/* How the parallelograms over the other two edges of the triangle beyond a base fail. */
int32_t fold_at(const Work *w, int32_t v, const Base *base, int j) {
    const Corners *c = &w->corners;
    const Values *g = &w->values;
    int32_t sum = 0;
    for (int side = 0; side < 2; side++) {
        int32_t k = side == 0 ? previous_corner(base->tip) : next_corner(base->tip), beyond = c->opposite.data[k];
        if (beyond < 0 || c->rank.data[c->faces.data[beyond]] >= c->rank.data[v]) continue;
        int32_t far = c->faces.data[k], near = far == base->a ? base->b : base->a;
        sum += value_at(g, far, j) - value_at(g, near, j);
        sum += value_at(g, c->faces.data[beyond], j) - value_at(g, base->c, j);
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
