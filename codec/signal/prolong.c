/* Places of cells, spread to the vertices of a mesh by smoothing (specification, M 18.7). */
#include "codec/geometry/geometry.h"
#include "codec/signal/signal.h"

/* x becomes half of itself and half of the mean of its neighbors. */
KERNEL OFTEN static void smooth_once(ConstInts offsets, ConstInts neighbors, const FourSingles *from, FourSingles *to) {
    for (int64_t v = 0; v < offsets.size - 1; v++) {
        int32_t first = offsets.data[v], last = offsets.data[v + 1];
        FourSingles sum = {0.0f, 0.0f, 0.0f, 0.0f};
        for (int32_t i = first; i < last; i++) sum += from[neighbors.data[i]];
        float weight = last > first ? 0.5f / (float)(last - first) : 0.0f;
        to[v] = 0.5f * from[v] + weight * sum;
    }
}

/* `scratch` has eight numbers a vertex. */
int64_t prolong(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstDoubles2 places, int64_t rounds,
    Singles scratch, Doubles2 positions) {
    int64_t n = own.size;
    if (!fits_graph(offsets, neighbors) || offsets.size != n + 1 || places.columns != 3 || positions.rows != n
        || positions.columns != 3 || scratch.size < 8 * n)
        return MISUSED;
    FourSingles *from = (FourSingles *)scratch.data, *to = from + n;
    for (int64_t v = 0; v < n; v++) {
        const double *place = places.data + 3 * (int64_t)own.data[v];
        from[v] = (FourSingles){(float)place[0], (float)place[1], (float)place[2], 0.0f};
    }
    for (; rounds > 0; rounds--) {
        smooth_once(offsets, neighbors, from, to);
        FourSingles *other = from;
        from = to;
        to = other;
    }
    for (int64_t v = 0; v < n; v++)
        for (int d = 0; d < 3; d++) positions.data[3 * v + d] = (double)from[v][d];
    return 0;
}
