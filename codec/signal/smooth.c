/* A polynomial of K = I - D^-1 A on positions (specification, M 12.2): sums over neighbors in ascending order. */
#include "codec/signal/signal.h"

#include <string.h>

#include "codec/geometry/geometry.h"

/* K V at one vertex. */
INLINE Four apply(ConstInts offsets, ConstInts neighbors, const double *values, int64_t v) {
    int64_t first = offsets.data[v], last = offsets.data[v + 1];
    Four sum = {0.0, 0.0, 0.0, 0.0};
    for (int64_t i = first; i < last; i++) sum += *(const UnalignedFour *)(values + 3 * (int64_t)neighbors.data[i]);
    double share = 1.0 / (double)largest(last - first, 1);
    Four moved = *(const UnalignedFour *)(values + 3 * v) - share * sum;
    return last == first ? (Four){0.0, 0.0, 0.0, 0.0} : moved;
}

/* By divided differences. */
void filter_polynomial(double amount, double *powers) {
    static const double NODES_OF[POWERS] = {0.4, 0.9, 1.4, 1.8};
    double table[POWERS], before[POWERS];
    for (int i = 0; i < POWERS; i++) {
        table[i] = -amount / (1.0 + amount * NODES_OF[i] * NODES_OF[i]);
        powers[i] = 0.0;
    }
    for (int level = 1; level < POWERS; level++)
        for (int i = POWERS - 1; i >= level; i--)
            table[i] = (table[i] - table[i - 1]) / (NODES_OF[i] - NODES_OF[i - level]);
    for (int i = POWERS - 1; i >= 0; i--) {
        memcpy(before, powers, sizeof before);
        for (int k = 0; k < POWERS; k++) {
            double product = NODES_OF[i] * before[k];
            powers[k] = (k > 0 ? before[k - 1] : table[i]) - product;
        }
    }
}

/* K V, and its weight in what is smoothed, if it is to have one. */
KERNEL OFTEN static void apply_once(ConstInts offsets, ConstInts neighbors, const double *values, double *result,
    bool counts, double weight, double *smoothed) {
    for (int64_t v = 0; v < offsets.size - 1; v++) {
        Four moved = apply(offsets, neighbors, values, v);
        *(UnalignedFour *)(result + 3 * v) = moved;
        if (counts)
            for (int d = 0; d < 3; d++) smoothed[3 * v + d] += weight * moved[d];
    }
}

/* V + the sum of powers[k] times K^(k + 2) V. `scratch` has room for 6 n + 2 numbers: the fourth of a vertex is
 * overwritten by the next one. */
KERNEL int64_t smooth_all(ConstInts offsets, ConstInts neighbors, ConstDoubles2 positions, double amount,
    Doubles scratch, Doubles2 smoothed) {
    int64_t n = offsets.size - 1;
    if (!fits_graph(offsets, neighbors) || positions.rows != n || positions.columns != 3 || smoothed.rows != n
        || smoothed.columns != 3 || scratch.size < 6 * n + 2)
        return MISUSED;
    double *values = scratch.data, *result = scratch.data + 3 * n + 1, powers[POWERS];
    filter_polynomial(amount, powers);
    for (int64_t i = 0; i < 3 * n; i++) values[i] = smoothed.data[i] = positions.data[i];
    values[3 * n] = result[3 * n] = 0.0;
    for (int64_t k = 0; k < DEGREE; k++) {
        apply_once(offsets, neighbors, values, result, k > 0, k > 0 ? powers[k - 1] : 0.0, smoothed.data);
        double *other = values;
        values = result;
        result = other;
    }
    return 0;
}

/* `vertices` and the rings around them; ring k ends before starts[k]; `number` becomes their place in the list `rows`,
 * which has room for all vertices, and is -1 everywhere before. Returns how many they are. */
int64_t find_rings(ConstInts offsets, ConstInts neighbors, Ints number, ConstInts vertices, Ints rows, Longs starts) {
    int64_t count = 0, head = 0;
    for (int64_t i = 0; i < vertices.size; i++) {
        int32_t v = vertices.data[i];
        if (number.data[v] >= 0) continue;
        number.data[v] = (int32_t)count;
        rows.data[count++] = v;
    }
    starts.data[0] = count;
    for (int64_t ring = 1; ring < starts.size; ring++) {
        for (int64_t end = count; head < end; head++) {
            int32_t v = rows.data[head];
            for (int64_t i = offsets.data[v]; i < offsets.data[v + 1]; i++) {
                int32_t w = neighbors.data[i];
                if (number.data[w] >= 0) continue;
                number.data[w] = (int32_t)count;
                rows.data[count++] = w;
            }
        }
        starts.data[ring] = count;
    }
    return count;
}

/* The filter on the innermost of the rings `rows`; each power of K is known on one ring less than the last. `current`
 * has a row for each of `rows`, `following` for all but those of the outermost ring. */
void filter_rows(ConstInts offsets, ConstInts neighbors, Rings rings, ConstDoubles2 positions, ConstDoubles weights,
    Doubles2 current, Doubles2 following, Doubles2 smoothed) {
    ConstInts rows = rings.rows;
    const int64_t *starts = rings.starts.data, degree = rings.starts.size - 1, inner = starts[0];
    for (int64_t r = 0; r < rows.size; r++)
        for (int d = 0; d < 3; d++) current.data[3 * r + d] = positions.data[3 * (int64_t)rows.data[r] + d];
    for (int64_t i = 0; i < 3 * inner; i++) smoothed.data[i] = current.data[i];
    double *from = current.data, *to = following.data;
    for (int64_t k = 0; k < degree; k++) {
        for (int64_t r = 0; r < starts[degree - 1 - k]; r++) {
            int64_t first = offsets.data[rows.data[r]], last = offsets.data[rows.data[r] + 1];
            double x = 0.0, y = 0.0, z = 0.0;
            for (int64_t i = first; i < last; i++) {
                const double *beside = from + 3 * (int64_t)rings.number.data[neighbors.data[i]];
                x += beside[0];
                y += beside[1];
                z += beside[2];
            }
            double share = last > first ? 1.0 / (double)(last - first) : 0.0;
            double *result = to + 3 * r;
            const double *own = from + 3 * r;
            result[0] = last > first ? own[0] - share * x : 0.0;
            result[1] = last > first ? own[1] - share * y : 0.0;
            result[2] = last > first ? own[2] - share * z : 0.0;
        }
        double *other = from;
        from = to;
        to = other;
        if (k == 0) continue;
        for (int64_t i = 0; i < 3 * inner; i++) smoothed.data[i] += weights.data[k - 1] * from[i];
    }
}
