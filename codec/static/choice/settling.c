/* Levels chosen by what each error costs where it is, and by their bits. Encoder only: decoders see levels.
 *
 * In: where each vertex should lie along three axes, what an error costs there, and what a level costs by its
 * distance from what its neighbors suggest. Out: levels, changed in place, and counts of what was taken, from which
 * the caller makes the rates of the next sweep. Rounding alone would spend the same bits where an error shows (a
 * bend, a silhouette) and where it does not. The choice is a field in which each level depends on its neighbors, so
 * the least sum cannot be found; coordinate descent, vertex after vertex and axis after axis, comes near it in two
 * sweeps. Only the levels that may be best are tried: the nearest one, that of the neighbors, none, and those beside
 * the one at hand. Normals come last, since they make good what was left along the surface. No vertex may end beyond
 * its reach, or the largest error that the encoder promises would be lost. */
#include "codec/geometry/geometry.h"
#include "codec/static/choice/choice.h"

/* levels that are compared; classes of surroundings; sizes of what is coded */
enum { TRIED = 5, AROUND = 10, SIZES = 16 };

INLINE int32_t nearest(double x) {
    double limit = 1073741823.0;
    x = x > -limit ? x < limit ? x : limit : -limit;
    return (int32_t)(x + __builtin_copysign(0.5, x));
}

/* Classes of the mean size of what is around: none, up to a quarter, and twice as much each. */
INLINE int64_t class_of(double mean) {
    static const double bounds[AROUND - 1] = {0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
    int found = 0;
    for (int i = 0; i < AROUND - 1; i++) found += mean > bounds[i];
    return found;
}

/* Which rate a level has that is expected to be `center`. */
INLINE int64_t size_of(int32_t level, int32_t center) {
    int64_t away = (int64_t)level - center;
    return least(away < 0 ? -away : away, SIZES - 1);
}

/* What an error of a vertex costs: `across` by the square of its length, and `more` by that of its share along the
 * surface's normal; both in the axes of the levels. */
typedef struct {
    const double *normal;
    double across, more, error[3];
} ErrorCost;

INLINE double loss_of(const ErrorCost *x, const double *error) {
    double off = dot3(x->normal, error);
    return x->more * off * off + x->across * dot3(error, error);
}

/* The error along an axis that costs least beside those along others. */
INLINE double best_error(const ErrorCost *x, int a) {
    double own = x->normal[a], others = dot3(x->normal, x->error) - own * x->error[a];
    double bend = x->more * own * own + x->across;
    return bend > 0.0 ? -x->more * own * others / bend : 0.0;
}

INLINE void place(const double *frame, const double *origin, const double *error, double *to) {
    for (int d = 0; d < 3; d++)
        to[d] = origin[d] + error[0] * frame[d] + error[1] * frame[3 + d] + error[2] * frame[6 + d];
}

/* One sweep over levels (n x 3), but for those of the first `fixed` axes: for each the least of its loss and its rate.
 * A level moves a vertex by `steps` (n x 3) along its axes. Rates have a row for each axis and class of the mean size
 * of the neighbors' levels; the counts of the levels taken have the same shape. Wrong `creases` add their costs:
 * `moved` (n x 3) is room for where vertices come to lie. No vertex ends up farther from its place than its reach,
 * unless it was. Returns how often one moved. */
KERNEL int64_t settle_levels(Settled wanted, ConstDoubles2 steps, ConstInts starts, ConstInts members, Rates coding,
    int64_t fixed, Creases creases, Doubles2 moved, Ints2 levels) {
    ConstDoubles2 offsets = wanted.offsets, normals = wanted.normals, losses = wanted.losses, places = wanted.places,
        frames = wanted.frames, rates = coding.rates;
    ConstDoubles reach = wanted.reach;
    Doubles2 counts = coding.counts;
    int64_t n = offsets.rows, moves = 0;
    if (offsets.columns != 3 || normals.rows != n || normals.columns != 3 || losses.rows != n || losses.columns != 2 ||
        steps.rows != n || steps.columns != 3 || levels.rows != n || levels.columns != 3 || fixed < 0 ||
        reach.size != n || !fits_rows(starts, members, n, n) || rates.rows != 3 * AROUND || rates.columns != SIZES ||
        counts.rows != rates.rows || counts.columns != rates.columns || places.rows != n || places.columns != 3 ||
        frames.rows != n || frames.columns != 9 || moved.rows != n || moved.columns != 3 || !fits_creases(&creases, n))
        return MISUSED;
    for (int64_t i = 0; i < 3 * n; i++)
        if (!(steps.data[i] > 0.0)) return MISUSED;
    for (int64_t i = 0; i < counts.rows * counts.columns; i++) counts.data[i] = 0.0;
    for (int64_t v = 0; v < n; v++) {
        double error[3];
        for (int64_t i = 3 * v; i < 3 * v + 3; i++) error[i - 3 * v] = steps.data[i] * levels.data[i] - offsets.data[i];
        place(frames.data + 9 * v, places.data + 3 * v, error, moved.data + 3 * v);
    }
    for (int64_t v = 0; v < n; v++) {
        double far = 0.0, most = reach.data[v] * reach.data[v];
        int32_t first = starts.data[v], end = starts.data[v + 1];
        double share = end > first ? 1.0 / (end - first) : 0.0;
        ErrorCost x = {normals.data + 3 * v, losses.data[2 * v + 1], losses.data[2 * v], {0.0}};
        for (int a = 0; a < 3; a++) {
            x.error[a] = steps.data[3 * v + a] * levels.data[3 * v + a] - offsets.data[3 * v + a];
            far += x.error[a] * x.error[a];
        }
        const double *frame = frames.data + 9 * v, *origin = places.data + 3 * v;
        double *at = moved.data + 3 * v;
        bool hangs = creases.starts.data[v + 1] > creases.starts.data[v];
        double creased = hangs ? wrong_creases(&creases, moved.data, v) : 0.0;
        /* Normals last: they make good what was left along the surface where the axes are not quite its own. */
        for (int a = 3; a-- > (int)fixed;) {
            int32_t *level = levels.data + 3 * v + a, before = *level;
            double sum = 0.0, sizes = 0.0, step = steps.data[3 * v + a], offset = offsets.data[3 * v + a];
            for (int32_t i = first; i < end; i++) {
                double other = levels.data[3 * (int64_t)members.data[i] + a];
                sum += other;
                sizes += __builtin_fabs(other);
            }
            int32_t center = nearest(coding.pull * sum * share);
            int64_t row = (a * AROUND + class_of(sizes * share)) * SIZES;
            const double *rate = rates.data + row;
            int32_t ideal = nearest((offset + best_error(&x, a)) / step);
            int32_t tried[TRIED] = {ideal, center, 0, before - 1, before + 1};
            double best = loss_of(&x, x.error) + rate[size_of(before, center)] + creased;
            for (int i = 0; i < TRIED; i++) {
                if (tried[i] == *level || tried[i] == before) continue;
                double error[3] = {x.error[0], x.error[1], x.error[2]};
                error[a] = step * tried[i] - offset;
                double then = dot3(error, error), cost = loss_of(&x, error) + rate[size_of(tried[i], center)];
                if (cost >= best || (then > most && then > far)) continue;
                if (hangs) {
                    place(frame, origin, error, at);
                    double wrong = wrong_creases(&creases, moved.data, v);
                    cost += wrong;
                    if (cost >= best) continue;
                    creased = wrong;
                }
                best = cost, *level = tried[i], far = then, x.error[a] = error[a];
            }
            if (hangs) place(frame, origin, x.error, at);
            counts.data[row + size_of(*level, center)] += 1.0;
            moves += *level != before;
        }
    }
    return moves;
}
