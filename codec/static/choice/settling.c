/* Levels chosen by what each error costs where it is, and by their bits. Encoder only: decoders see levels.
 *
 * Coordinate descent, vertex after vertex and axis after axis, over the levels that may be best: the nearest one, that of
 * the neighbours, none, and those beside the one at hand. */
#include "codec/static/choice/settling.h"

enum { TRIED = 5, AROUND = 10, SIZES = 16 }; /* levels that are compared; classes of surroundings; sizes of what is coded */

INLINE double size(double x) { return x < 0.0 ? -x : x; }

INLINE int32_t nearest(double x) {
    double limit = 1073741823.0;
    x = x > -limit ? x < limit ? x : limit : -limit;
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

/* What an error of a vertex costs: along the surface's normal, here in the axes of its levels, more than across. */
typedef struct {
    const double *normal, *steps;
    double across, more; /* by the square of its length, and of its share along the normal */
    double error[3], lean; /* lean: that share */
} Vertex;

INLINE double loss_of(const Vertex *x, double lean, double squares) { return x->more * lean * lean + x->across * squares; }

/* The error along an axis that costs least beside those along others. */
INLINE double best_error(const Vertex *x, int a) {
    double own = x->normal[a], others = x->lean - own * x->error[a], bend = x->more * own * own + x->across;
    return bend > 0.0 ? -x->more * own * others / bend : 0.0;
}

/* One sweep over levels (n x axes): for each the least of its loss and its rate. `offsets` (n x 3) is what is wanted, along
 * axes of which a level moves a vertex by `steps`; those that have no level keep it. An error costs `losses` (n x 2) times
 * the square of its length, and times that of its share along `normals` (n x 3, in the same axes). Rates have a row for
 * each axis and class of what is around (mean size of the neighbours' levels), and depend on the distance from `pull` times
 * the neighbours' mean. No vertex ends up farther from its place than its `reach`, unless it was. Counts, in the shape of
 * rates, are of the levels that were taken. Returns how often one moved. */
KERNEL int64_t settle_levels(ConstDoubles2 offsets, ConstDoubles2 normals, ConstDoubles2 losses, ConstDoubles steps,
                             ConstDoubles reach, ConstInts starts, ConstInts members, ConstDoubles2 rates, double pull,
                             Ints2 levels, Doubles2 counts) {
    int64_t n = offsets.rows, axes = levels.columns, moves = 0;
    if (offsets.columns != 3 || normals.rows != n || normals.columns != 3 || losses.rows != n || losses.columns != 2 ||
        levels.rows != n || steps.size != 3 || axes < 1 || axes > 3 || reach.size != n || starts.size != n + 1 ||
        rates.rows != axes * AROUND || rates.columns != SIZES || counts.rows != rates.rows ||
        counts.columns != rates.columns)
        return MISUSED;
    for (int a = 0; a < 3; a++)
        if (!(steps.data[a] > 0.0)) return MISUSED;
    for (int64_t v = 0; v < n; v++)
        if (starts.data[v] < 0 || starts.data[v] > starts.data[v + 1] || starts.data[v + 1] > members.size) return MISUSED;
    for (int64_t i = 0; i < members.size; i++)
        if (members.data[i] < 0 || members.data[i] >= n) return MISUSED;
    for (int64_t i = 0; i < counts.rows * counts.columns; i++) counts.data[i] = 0.0;
    for (int64_t v = 0; v < n; v++) {
        double far = 0.0, most = reach.data[v] * reach.data[v];
        int32_t first = starts.data[v], end = starts.data[v + 1];
        double share = end > first ? 1.0 / (end - first) : 0.0;
        Vertex x = {.normal = normals.data + 3 * v, .across = losses.data[2 * v + 1], .more = losses.data[2 * v]};
        for (int a = 0; a < 3; a++) {
            double moved = a < (int)axes ? steps.data[a] * levels.data[v * axes + a] : 0.0;
            x.error[a] = moved - offsets.data[3 * v + a];
            far += x.error[a] * x.error[a];
            x.lean += x.normal[a] * x.error[a];
        }
        /* Normals last: they make good what was left along the surface where the axes are not quite its own. */
        for (int a = (int)axes; a-- > 0;) {
            int32_t *level = levels.data + v * axes + a, before = *level;
            double sum = 0.0, sizes = 0.0, step = steps.data[a], offset = offsets.data[3 * v + a];
            for (int32_t i = first; i < end; i++) {
                double other = levels.data[(int64_t)members.data[i] * axes + a];
                sum += other;
                sizes += size(other);
            }
            int32_t centre = nearest(pull * sum * share);
            int64_t row = (a * AROUND + class_of(sizes * share)) * SIZES;
            const double *rate = rates.data + row;
            int32_t ideal = nearest((offset + best_error(&x, a)) / step);
            int32_t tried[TRIED] = {ideal, centre, 0, before - 1, before + 1};
            double others = far - x.error[a] * x.error[a], leaning = x.lean - x.normal[a] * x.error[a];
            double best = loss_of(&x, x.lean, far) + rate[size_of(before, centre)];
            for (int i = 0; i < TRIED; i++) {
                double error = step * tried[i] - offset, then = others + error * error;
                double lean = leaning + x.normal[a] * error, cost = loss_of(&x, lean, then) + rate[size_of(tried[i], centre)];
                if (cost >= best || (then > most && then > far)) continue;
                best = cost, *level = tried[i], far = then, x.lean = lean, x.error[a] = error;
            }
            counts.data[row + size_of(*level, centre)] += 1.0;
            moves += *level != before;
        }
    }
    return moves;
}
