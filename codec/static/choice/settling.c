/* Levels chosen by what each error costs where it is, and by their bits. Encoder only: decoders see levels.
 *
 * Coordinate descent, vertex after vertex and axis after axis, over the levels that may be best: the nearest one, that of
 * the neighbours, none, and those beside the one at hand. */
#include "codec/static/choice/settling.h"

enum { TRIED = 5, AROUND = 10, SIZES = 16 }; /* levels that are compared; classes of surroundings; sizes of what is coded */

INLINE double size(double x) { return x < 0.0 ? -x : x; }

INLINE int32_t nearest(double x) {
    double limit = 1073741823.0;
    x = x < -limit ? -limit : x > limit ? limit : x;
    return (int32_t)(x < 0.0 ? x - 0.5 : x + 0.5);
}

/* Classes of the mean size of what is around: none, up to a quarter, and twice as much each. */
INLINE int64_t class_of(double mean) {
    int64_t found = 0;
    for (double bound = 0.0; mean > bound && found < AROUND - 1; found++) bound = bound > 0.0 ? 2.0 * bound : 0.25;
    return found;
}

/* Which rate a level has that is expected to be `centre`. */
INLINE int64_t size_of(int32_t level, int32_t centre) {
    int64_t away = (int64_t)level - centre;
    return least(away < 0 ? -away : away, SIZES - 1);
}

/* One sweep over levels (n x axes): for each the least of its loss (`losses` times the square of its error) and its rate.
 * Rates have a row for each axis and class of what is around (mean size of the neighbours' levels), and depend on the
 * distance from `pull` times the neighbours' mean. No vertex ends up farther from its place than its `reach`, with `steps`
 * long levels, unless it was. Counts, in the shape of rates, are of the levels that were taken. Returns how often one
 * moved. */
KERNEL int64_t settle_levels(ConstDoubles2 wanted, ConstDoubles2 losses, ConstDoubles steps, ConstDoubles reach,
                             ConstInts starts, ConstInts members, ConstDoubles2 rates, double pull, Ints2 levels,
                             Doubles2 counts) {
    int64_t n = wanted.rows, axes = wanted.columns, moves = 0;
    if (losses.rows != n || losses.columns != axes || levels.rows != n || levels.columns != axes || steps.size != axes ||
        axes < 1 || axes > 3 || reach.size != n || starts.size != n + 1 || rates.rows != axes * AROUND ||
        rates.columns != SIZES || counts.rows != rates.rows || counts.columns != rates.columns)
        return MISUSED;
    for (int64_t v = 0; v < n; v++)
        if (starts.data[v] < 0 || starts.data[v] > starts.data[v + 1] || starts.data[v + 1] > members.size) return MISUSED;
    for (int64_t i = 0; i < members.size; i++)
        if (members.data[i] < 0 || members.data[i] >= n) return MISUSED;
    for (int64_t i = 0; i < counts.rows * counts.columns; i++) counts.data[i] = 0.0;
    for (int64_t v = 0; v < n; v++) {
        double far = 0.0, most = reach.data[v] * reach.data[v];
        int32_t first = starts.data[v], end = starts.data[v + 1];
        for (int a = 0; a < (int)axes; a++) {
            double off = steps.data[a] * (levels.data[v * axes + a] - wanted.data[v * axes + a]);
            far += off * off;
        }
        for (int a = 0; a < (int)axes; a++) {
            int32_t *level = levels.data + v * axes + a, before = *level;
            double sum = 0.0, sizes = 0.0, place = wanted.data[v * axes + a], loss = losses.data[v * axes + a];
            for (int32_t i = first; i < end; i++) {
                double other = levels.data[(int64_t)members.data[i] * axes + a];
                sum += other;
                sizes += size(other);
            }
            double share = end > first ? 1.0 / (end - first) : 0.0;
            int32_t centre = nearest(pull * sum * share);
            int64_t row = (a * AROUND + class_of(sizes * share)) * SIZES;
            const double *rate = rates.data + row;
            int32_t tried[TRIED] = {nearest(place), centre, 0, before - 1, before + 1};
            double step = steps.data[a], off = before - place, others = far - step * step * off * off;
            double best = loss * off * off + rate[size_of(before, centre)];
            for (int i = 0; i < TRIED; i++) {
                off = tried[i] - place;
                double then = others + step * step * off * off, cost = loss * off * off + rate[size_of(tried[i], centre)];
                if (cost >= best || (then > most && then > far)) continue;
                best = cost, *level = tried[i], far = then;
            }
            counts.data[row + size_of(*level, centre)] += 1.0;
            moves += *level != before;
        }
    }
    return moves;
}
