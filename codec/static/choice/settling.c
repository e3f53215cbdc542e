/* Levels chosen by what each error costs where it is, and by their bits. Encoder only: decoders see levels.
 *
 * Coordinate descent, vertex after vertex and axis after axis, over the levels that may be best: the nearest one, that of
 * the neighbours, none, and those beside the one at hand. */
#include "codec/static/choice/settling.h"

enum { TRIED = 5, FINE = 16 }; /* levels that are compared; entries of `rates` for each unit */

INLINE double size(double x) { return x < 0.0 ? -x : x; }

INLINE int32_t nearest(double x) {
    double limit = 1073741823.0;
    x = x < -limit ? -limit : x > limit ? limit : x;
    return (int32_t)(x < 0.0 ? x - 0.5 : x + 0.5);
}

/* What a level costs that is so far from where it is expected, in units of its axis. */
INLINE double rate(ConstDoubles rates, double away) {
    double place = away * FINE;
    return rates.data[place < (double)(rates.size - 1) ? (int64_t)place : rates.size - 1];
}

/* Levels (n x axes), nearest to `wanted` at first: for each the least of its loss (`losses` times the square of its error)
 * and its rate, by its distance from `pull` times the mean of the neighbours' over the mean size of the axis, but at least
 * `unit`. No vertex ends up farther from its place than its `reach`, with `steps` long levels, unless rounding has it so.
 * Returns how often one moved. */
KERNEL int64_t settle_levels(ConstDoubles2 wanted, ConstDoubles2 losses, ConstDoubles steps, ConstDoubles reach,
                             ConstInts starts, ConstInts members, ConstDoubles rates, double pull, double unit,
                             int64_t sweeps, Ints2 levels) {
    int64_t n = wanted.rows, axes = wanted.columns, moves = 0;
    if (losses.rows != n || losses.columns != axes || levels.rows != n || levels.columns != axes || steps.size != axes ||
        axes < 1 || axes > 3 || reach.size != n || starts.size != n + 1 || rates.size < 1)
        return MISUSED;
    for (int64_t v = 0; v < n; v++)
        if (starts.data[v] < 0 || starts.data[v] > starts.data[v + 1] || starts.data[v + 1] > members.size) return MISUSED;
    for (int64_t i = 0; i < members.size; i++)
        if (members.data[i] < 0 || members.data[i] >= n) return MISUSED;
    for (int64_t i = 0; i < n * axes; i++) levels.data[i] = nearest(wanted.data[i]);
    for (int64_t sweep = 0; sweep < sweeps; sweep++) {
        double scale[3] = {0.0, 0.0, 0.0};
        for (int64_t i = 0; i < n * axes; i++) scale[i % axes] += size((double)levels.data[i]);
        for (int a = 0; a < (int)axes; a++) scale[a] = scale[a] > unit * (double)n ? (double)n / scale[a] : 1.0 / unit;
        for (int64_t v = 0; v < n; v++) {
            double far = 0.0, most = reach.data[v] * reach.data[v];
            for (int a = 0; a < (int)axes; a++) {
                double off = steps.data[a] * (levels.data[v * axes + a] - wanted.data[v * axes + a]);
                far += off * off;
            }
            for (int a = 0; a < (int)axes; a++) {
                int32_t *level = levels.data + v * axes + a, before = *level, first = starts.data[v], end = starts.data[v + 1];
                double mean = 0.0, place = wanted.data[v * axes + a], loss = losses.data[v * axes + a];
                for (int32_t i = first; i < end; i++) mean += levels.data[(int64_t)members.data[i] * axes + a];
                mean = end > first ? pull * mean / (end - first) : 0.0;
                int32_t tried[TRIED] = {nearest(place), nearest(mean), 0, before - 1, before + 1};
                double step = steps.data[a], off = before - place, others = far - step * step * off * off;
                double best = loss * off * off + rate(rates, size(before - mean) * scale[a]);
                for (int i = 0; i < TRIED; i++) {
                    off = tried[i] - place;
                    double then = others + step * step * off * off;
                    double cost = loss * off * off + rate(rates, size(tried[i] - mean) * scale[a]);
                    if (cost >= best || (then > most && then > far)) continue;
                    best = cost, *level = tried[i], far = then;
                    others = far - step * step * off * off;
                }
                moves += *level != before;
            }
        }
    }
    return moves;
}
