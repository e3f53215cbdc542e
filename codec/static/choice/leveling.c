/* Levels of cells, chosen together. Encoder only: decoders see levels.
 *
 * Vertices see cells only smoothed (M 18.7): the errors of neighboring cells cancel where their signs differ, and add
 * up where they agree, so that rounding is not best. Let H = F^T F + BENT K^T K, as fitting.c has it: an error e of the
 * cells costs e^T H e. Coordinate descent, cell after cell and axis after axis, takes the level that costs least beside
 * the errors of the others, and its bits. With steps twice as wide as if levels were rounded, vertices come as near.
 *
 * H has a row for each cell, of those within about four cells. A column of F is found by smoothing a cell alone. Small
 * entries are dropped from it in every round; since the rows of F add up to 1, few columns reach any vertex, and the
 * work is linear. */
#include "codec/geometry/geometry.h"
#include "codec/static/choice/choice.h"

enum { REACHED = 16, HUB = 64, SWEEPS = 4, FARTHEST = 1 << 19 };
static const float SMALLEST = 1.0f / 256.0f, LOOSE = 0.01f;
static const double CODED = 0.2; /* half a bit and more, over the cost of an error of a step of one cell alone */

/* Row v of F: the cells that reach a vertex most, and by how much. */
static void remember(int32_t *cells, float *shares, int32_t cell, float share) {
    int lowest = 0;
    for (int k = 1; k < REACHED; k++)
        if (shares[k] < shares[lowest]) lowest = k;
    if (shares[lowest] < share) shares[lowest] = share, cells[lowest] = cell;
}

/* One round: `from`, at the `count` vertices of `list`, spreads to `to`, which is 0 before. Returns how many of `next`
 * it reaches. */
static int64_t spread(ConstInts offsets, ConstInts neighbors, const float *from, float *to, const int32_t *list,
    int64_t count, int32_t *next) {
    int64_t found = 0, kept = 0;
    for (int64_t i = 0; i < count; i++) {
        int32_t v = list[i];
        float half = 0.5f * from[v];
        if (to[v] == 0.0f) next[found++] = v;
        to[v] += half;
        for (int32_t k = offsets.data[v]; k < offsets.data[v + 1]; k++) {
            int32_t u = neighbors.data[k];
            if (to[u] == 0.0f) next[found++] = u;
            to[u] += half / (float)(offsets.data[u + 1] - offsets.data[u]);
        }
    }
    for (int64_t i = 0; i < found; i++) {
        int32_t v = next[i];
        if (to[v] >= SMALLEST)
            next[kept++] = v;
        else
            to[v] = 0.0f;
    }
    return kept;
}

/* A row of H under way: its entries, and which these are. */
typedef struct {
    float *values;
    int32_t *seen, *touched, cell;
    int64_t count;
} Row;

INLINE void add(Row *row, int32_t other, float value) {
    if (other > row->cell) return; /* H is symmetric: the other half follows */
    if (row->seen[other] != row->cell) {
        row->seen[other] = row->cell;
        row->touched[row->count++] = other;
        row->values[other] = 0.0f;
    }
    row->values[other] += value;
}

/* Add a row of K, times `weight`. */
static void add_bend(ConstInts links, ConstInts linked, int32_t cell, float weight, Row *row) {
    int32_t first = links.data[cell], end = links.data[cell + 1];
    add(row, cell, -weight);
    for (int32_t i = first; i < end; i++) add(row, linked.data[i], weight / (float)(end - first));
}

/* H: `weights` of cells, its diagonal, and the rest by `starts`, `ends` and `values`, which have room for twice as many
 * as `half`; where that is full, entries are left out. `bounds` and `order` list the vertices of cells; `scratch` has
 * 18 n + m numbers, `listed` 18 n + 3 m + 1. Returns how many entries there are. */
int64_t couple_cells(ConstInts offsets, ConstInts neighbors, ConstInts bounds, ConstInts order, ConstInts links,
    ConstInts linked, int64_t rounds, double bent, Singles scratch, Ints listed, Ints below, Singles half,
    Doubles weights, Longs starts, Ints ends, Singles values) {
    int64_t n = offsets.size - 1, m = links.size - 1, kept = 0;
    if (bounds.size != m + 1 || order.size != n || scratch.size < 18 * n + m || listed.size < 18 * n + 3 * m + 1
        || below.size != half.size || weights.size != m || starts.size != m + 1 || ends.size < 2 * half.size
        || values.size < 2 * half.size)
        return MISUSED;
    float *shares = scratch.data, *from = shares + REACHED * n, *to = from + n;
    int32_t *reaching = listed.data, *list = reaching + REACHED * n, *next = list + n, *firsts = next + n;
    Row row = {to + n, firsts + m + 1, firsts + 2 * m + 1, 0, 0};
    for (int64_t i = 0; i < 18 * n; i++) scratch.data[i] = 0.0f;
    for (int64_t i = 0; i < REACHED * n; i++) reaching[i] = 0;
    for (int64_t c = 0; c < m; c++) starts.data[c] = 0, row.seen[c] = -1;
    for (int32_t c = 0; c < m; c++) {
        int64_t count = 0;
        row.cell = c, row.count = 0;
        firsts[c] = (int32_t)kept;
        add_bend(links, linked, c, (float)-bent, &row);
        for (int32_t i = links.data[c]; i < links.data[c + 1]; i++) {
            int32_t other = linked.data[i], around = links.data[other + 1] - links.data[other];
            if (around <= HUB) add_bend(links, linked, other, (float)bent / (float)around, &row);
        }
        for (int32_t k = bounds.data[c]; k < bounds.data[c + 1]; k++) from[list[count++] = order.data[k]] = 1.0f;
        for (int64_t round = 0; round < rounds; round++) {
            int64_t more = spread(offsets, neighbors, from, to, list, count, next);
            for (int64_t i = 0; i < count; i++) from[list[i]] = 0.0f;
            float *before = from;
            from = to, to = before;
            int32_t *others = list;
            list = next, next = others;
            count = more;
        }
        for (int64_t i = 0; i < count; i++) {
            int32_t *cells = reaching + REACHED * (int64_t)list[i];
            float *share = shares + REACHED * (int64_t)list[i], own = from[list[i]];
            for (int k = 0; k < REACHED; k++)
                if (share[k] > 0.0f) add(&row, cells[k], own * share[k]);
            add(&row, c, own * own);
            remember(cells, share, c, own);
            from[list[i]] = 0.0f;
        }
        weights.data[c] = (double)row.values[c] + 1e-5;
        for (int64_t i = 0; i < row.count && kept < half.size; i++) {
            int32_t other = row.touched[i];
            double value = (double)row.values[other];
            if (other == c || value * value < LOOSE * LOOSE * weights.data[c] * weights.data[other]) continue;
            below.data[kept] = other;
            half.data[kept++] = row.values[other];
            starts.data[c]++, starts.data[other]++;
        }
    }
    firsts[m] = (int32_t)kept;
    int64_t end = 0;
    for (int64_t c = 0; c < m; c++) starts.data[c] = end += starts.data[c];
    starts.data[m] = end;
    for (int64_t c = m; c-- > 0;) /* rows are filled from behind, until `starts` are where they start */
        for (int32_t i = firsts[c]; i < firsts[c + 1]; i++) {
            int32_t other = below.data[i];
            int64_t here = --starts.data[c], there = --starts.data[other];
            ends.data[here] = other, ends.data[there] = (int32_t)c;
            values.data[here] = values.data[there] = half.data[i];
        }
    return end;
}

INLINE double bits_of(int32_t level) {
    uint32_t size = (uint32_t)(level < 0 ? -level : level);
    return size > 0 ? 1.5 * (double)(32 - __builtin_clz(size)) : 0.0;
}

/* Choose levels from axis `first` on. `pulls` (m x 3), how the cost falls with places, over 2, is kept up. */
int64_t level_cells(ConstLongs starts, ConstInts ends, ConstSingles values, ConstDoubles weights, ConstDoubles2 frames,
    ConstDoubles2 steps, int64_t first, Doubles2 pulls, Ints2 levels) {
    int64_t m = weights.size, changed = 0;
    if (frames.rows != m || frames.columns != 9 || steps.rows != m || steps.columns != 3 || pulls.rows != m
        || pulls.columns != 3 || levels.rows != m || levels.columns != 3 || first < 0)
        return MISUSED;
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int64_t c = 0; c < m; c++)
            for (int64_t k = first; k < 3; k++) {
                const double *axis = frames.data + 9 * c + 3 * k;
                double step = steps.data[3 * c + k], weight = weights.data[c];
                int32_t *level = levels.data + 3 * c + k, best = *level;
                /* How many steps more would be best, and what the cost of others is beyond that. */
                double wanted = dot3(pulls.data + 3 * c, axis) / (weight * step), lowest = DBL_MAX;
                if (!(wanted < FARTHEST && wanted > -FARTHEST)) continue;
                int32_t near = *level + (int32_t)(wanted + __builtin_copysign(0.5, wanted));
                int32_t tried[] = {*level, near, near - 1, near + 1, 0};
                for (int i = 0; i < 5; i++) {
                    double off = (double)tried[i] - (double)*level - wanted;
                    double cost = weight * off * off + CODED * bits_of(tried[i]);
                    if (cost < lowest) lowest = cost, best = tried[i];
                }
                if (best == *level || best > FARTHEST || best < -FARTHEST) continue;
                double moved = ((double)best - (double)*level) * step;
                *level = best;
                changed++;
                for (int d = 0; d < 3; d++) pulls.data[3 * c + d] -= weight * moved * axis[d];
                for (int64_t i = starts.data[c]; i < starts.data[c + 1]; i++)
                    for (int d = 0; d < 3; d++)
                        pulls.data[3 * (int64_t)ends.data[i] + d] -= (double)values.data[i] * moved * axis[d];
            }
    return changed;
}
