/* What all kinds of values share (specification, A 1, A 2). */
#include "bitstream/attributes/forecast.h"

enum { MOST_LARGEST = (1 << 20) - 1 };

static bool fits(const Work *w, int64_t learners) {
    const Values *g = &w->values;
    int64_t n = w->corners.rank.size, columns = g->largest.size;
    bool fit = fits_values(&w->model) && fits_corners(&w->corners) && columns >= 1 && columns <= MOST_COMPONENTS
        && g->order.size == n && g->twin.size == n && g->geometry.columns == 3
        && (g->geometry.rows == n || g->geometry.rows == 0) && g->values.rows == n && g->values.columns == columns
        && g->gaps.rows == n && g->gaps.columns == columns && g->sums.rows == n && g->sums.columns == columns + 1
        && g->seen.rows == columns && g->learners.rows == learners && g->learners.columns == LEARNER_COLUMNS
        && g->chart.size == 2;
    for (int j = 0; j < columns && fit; j++)
        fit = g->largest.data[j] >= 0 && g->largest.data[j] <= MOST_LARGEST
            && g->largest.data[j] / 64 < g->seen.columns;
    return fit;
}

/* Tell the neighbours of v, which is known now. */
static void pass_on(const Corners *corners, const Values *g, int32_t v) {
    int64_t columns = g->values.columns;
    for (int32_t i = corners->starts.data[v]; i < corners->starts.data[v + 1]; i++) {
        int64_t *sum = g->sums.data + (columns + 1) * corners->faces.data[next_corner(corners->corners.data[i])];
        for (int j = 0; j < columns; j++) sum[j] += g->values.data[columns * v + j];
        sum[columns]++;
    }
}

/* Code `count` vertices from number `first` of the order on, as far as there is room (writing) or sense (reading).
 * Returns how many. */
int64_t code_vertices(Coder given, Work *w, int64_t learners, int64_t first, int64_t count, CodeVertex *code_vertex) {
    const int32_t *order = w->values.order.data;
    if (!open_coder(&w->coder, given) || !fits(w, learners) || first < 0 || count < 0
        || first > w->values.order.size - count)
        return MISUSED;
    int64_t done = 0;
    for (; done < count && has_room(&w->coder, MOST_COMPONENTS * VALUE_BYTES) && !overran(&w->coder); done++) {
        int64_t i = first + done;
        if (!code_vertex(w, order[i], i > 0 ? order[i - 1] : -1)) break;
        pass_on(&w->corners, &w->values, order[i]);
    }
    close_coder(&w->coder, given);
    return done;
}

void keep_value(const Values *g, int32_t v, int j, int32_t value) {
    g->values.data[g->values.columns * v + j] = value;
    mark_seen(g->seen.data + j * g->seen.columns, value);
}
