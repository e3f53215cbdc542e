/* Places of cells, spread to the vertices of a mesh by smoothing (specification, M 18.7). */
#include "codec/geometry/geometry.h"
#include "codec/signal/signal.h"

#include <stddef.h>

INLINE int64_t row_of(ConstInts rows, int64_t i) { return rows.data != NULL ? rows.data[i] : i; }

/* x becomes half of itself and half of the mean of its neighbors, in rows. */
KERNEL OFTEN static void smooth_once(ConstInts offsets, ConstInts neighbors, ConstInts rows, const FourSingles *from,
    FourSingles *to) {
    for (int64_t r = 0; r < rows.size; r++) {
        int64_t v = row_of(rows, r);
        int32_t first = offsets.data[v], last = offsets.data[v + 1];
        FourSingles sum = {0.0f, 0.0f, 0.0f, 0.0f};
        for (int32_t i = first; i < last; i++) sum += from[neighbors.data[i]];
        float weight = last > first ? 0.5f / (float)(last - first) : 0.0f;
        to[v] = 0.5f * from[v] + weight * sum;
    }
}

const FourSingles *prolong_rows(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstDoubles2 places,
    int64_t rounds, ConstInts rows, ConstLongs ends, Singles scratch) {
    FourSingles *from = (FourSingles *)scratch.data, *to = from + own.size;
    for (int64_t r = 0; r < rows.size; r++) {
        int64_t v = row_of(rows, r);
        const double *place = places.data + 3 * (int64_t)own.data[v];
        from[v] = (FourSingles){(float)place[0], (float)place[1], (float)place[2], 0.0f};
    }
    for (; rounds > 0; rounds--) {
        if (ends.size > 0) rows.size = ends.data[rounds - 1];
        smooth_once(offsets, neighbors, rows, from, to);
        FourSingles *other = from;
        from = to;
        to = other;
    }
    return from;
}

/* `scratch` has eight numbers a vertex. */
int64_t prolong(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstDoubles2 places, int64_t rounds,
    Singles scratch, Doubles2 positions) {
    int64_t n = own.size;
    if (!fits_graph(offsets, neighbors) || offsets.size != n + 1 || places.columns != 3 || positions.rows != n
        || positions.columns != 3 || scratch.size < 8 * n)
        return MISUSED;
    const FourSingles *found =
        prolong_rows(offsets, neighbors, own, places, rounds, (ConstInts){NULL, n}, (ConstLongs){NULL, 0}, scratch);
    for (int64_t v = 0; v < n; v++)
        for (int d = 0; d < 3; d++) positions.data[3 * v + d] = (double)found[v][d];
    return 0;
}
