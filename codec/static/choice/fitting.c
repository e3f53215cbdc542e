/* Places of cells from which smoothing comes nearest to the vertices of a mesh. Encoder only: decoders see levels.
 *
 * Let F spread places q to vertices (M 18.7), and K be the mean of a cell's neighbors less the cell. Steps of conjugate
 * gradients lower |F q - X|^2 + bent |K q|^2 + SMALL |q - q_0|^2, q_0 being the places at first: without the second
 * term, places run wild that hardly any vertex notices. */
#include "codec/geometry/geometry.h"
#include "codec/signal/signal.h"
#include "codec/static/choice/choice.h"

static const float SMALL = 1e-5f;

typedef struct {
    ConstInts offsets, neighbors;
} Links;

INLINE float share_of(Links graph, int64_t v) {
    int32_t degree = graph.offsets.data[v + 1] - graph.offsets.data[v];
    return degree > 0 ? 1.0f / (float)degree : 0.0f;
}

/* y_v = own x_v + around (sum of the neighbors' z_u), times the share of v if it is `after`. */
KERNEL OFTEN static void gather(Links graph, float own, float around, bool after, const FourSingles *x,
    const FourSingles *z, FourSingles *y) {
    for (int64_t v = 0; v < graph.offsets.size - 1; v++) {
        FourSingles sum = {0.0f, 0.0f, 0.0f, 0.0f};
        for (int32_t i = graph.offsets.data[v]; i < graph.offsets.data[v + 1]; i++) sum += z[graph.neighbors.data[i]];
        float weight = after ? around * share_of(graph, v) : around;
        y[v] = own * x[v] + weight * sum;
    }
}

/* x in the end where it was: own x + around (mean of its neighbors), or its transpose; `y`, `z` are room. */
static void average(Links graph, float own, float around, bool transposed, FourSingles **x, FourSingles **y,
    FourSingles *z) {
    int64_t n = graph.offsets.size - 1;
    const FourSingles *shared = *x;
    if (transposed) {
        for (int64_t v = 0; v < n; v++) z[v] = share_of(graph, v) * (*x)[v];
        shared = z;
    }
    gather(graph, own, around, !transposed, *x, shared, *y);
    FourSingles *other = *x;
    *x = *y;
    *y = other;
}

/* Add bent K^T K q + small q to `result`; `room` has three entries a cell. */
static void add_bend(Links cells, const FourSingles *q, float bent, float small, FourSingles *room,
    FourSingles *result) {
    int64_t m = cells.offsets.size - 1;
    FourSingles *x = room, *y = room + m, *z = room + 2 * m;
    for (int64_t c = 0; c < m; c++) x[c] = q[c];
    average(cells, 1.0f, -1.0f, false, &x, &y, z);
    average(cells, 1.0f, -1.0f, true, &x, &y, z);
    for (int64_t c = 0; c < m; c++) result[c] += bent * x[c] + small * q[c];
}

/* Sums of the vertices of each cell, of F^T x; x and y, z are room. */
static void gather_cells(Links graph, ConstInts own, int64_t rounds, FourSingles *x, FourSingles *y, FourSingles *z,
    FourSingles *result, int64_t cells) {
    for (int64_t k = 0; k < rounds; k++) average(graph, 0.5f, 0.5f, true, &x, &y, z);
    for (int64_t c = 0; c < cells; c++) result[c] = (FourSingles){0.0f, 0.0f, 0.0f, 0.0f};
    for (int64_t v = 0; v < own.size; v++) result[own.data[v]] += x[v];
}

static void add_products(const FourSingles *a, const FourSingles *b, int64_t count, double *sums) {
    for (int d = 0; d < 3; d++) sums[d] = 0.0;
    for (int64_t c = 0; c < count; c++)
        for (int d = 0; d < 3; d++) sums[d] += (double)a[c][d] * (double)b[c][d];
}

/* Bring `places` (m x 3) nearer to the least sum; `pulls` are half of how fast it falls there, without SMALL. `scratch`
 * has twelve numbers a vertex and 28 a cell. */
int64_t fit_cells(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstInts links, ConstInts linked,
    ConstDoubles2 positions, int64_t rounds, double bent, int64_t steps, Singles scratch, Doubles2 places,
    Doubles2 pulls) {
    int64_t n = own.size, m = links.size - 1;
    if (!fits_graph(offsets, neighbors) || !fits_graph(links, linked) || offsets.size != n + 1 || positions.rows != n
        || positions.columns != 3 || places.rows != m || places.columns != 3 || pulls.rows != m || pulls.columns != 3
        || scratch.size < 12 * n + 28 * m)
        return MISUSED;
    Links mesh = {offsets, neighbors}, cells = {links, linked};
    FourSingles *x = (FourSingles *)scratch.data, *y = x + n, *z = y + n, *rest = z + n, *way = rest + m,
                *image = way + m, *found = image + m, *room = found + m;
    for (int64_t c = 0; c < m; c++) {
        const double *place = places.data + 3 * c;
        found[c] = (FourSingles){(float)place[0], (float)place[1], (float)place[2], 0.0f};
    }
    FourSingles *from = x, *to = y;
    for (int64_t v = 0; v < n; v++) from[v] = found[own.data[v]];
    for (int64_t k = 0; k < rounds; k++) average(mesh, 0.5f, 0.5f, false, &from, &to, z);
    for (int64_t v = 0; v < n; v++)
        for (int d = 0; d < 3; d++) from[v][d] = (float)(positions.data[3 * v + d] - (double)from[v][d]);
    gather_cells(mesh, own, rounds, from, to, z, rest, m);
    for (int64_t c = 0; c < m; c++) image[c] = (FourSingles){0.0f, 0.0f, 0.0f, 0.0f};
    add_bend(cells, found, (float)bent, 0.0f, room, image);
    double before[3], after[3], along[3];
    for (int64_t c = 0; c < m; c++) way[c] = rest[c] = rest[c] - image[c];
    add_products(rest, rest, m, before);
    for (int64_t step = 0; step < steps; step++) {
        from = x, to = y;
        for (int64_t v = 0; v < n; v++) from[v] = way[own.data[v]];
        for (int64_t k = 0; k < rounds; k++) average(mesh, 0.5f, 0.5f, false, &from, &to, z);
        gather_cells(mesh, own, rounds, from, to, z, image, m);
        add_bend(cells, way, (float)bent, SMALL, room, image);
        add_products(way, image, m, along);
        FourSingles length = {0.0f, 0.0f, 0.0f, 0.0f}, beta = length;
        for (int d = 0; d < 3; d++) length[d] = along[d] > 0.0 ? (float)(before[d] / along[d]) : 0.0f;
        for (int64_t c = 0; c < m; c++) found[c] += length * way[c], rest[c] -= length * image[c];
        add_products(rest, rest, m, after);
        for (int d = 0; d < 3; d++) beta[d] = before[d] > 0.0 ? (float)(after[d] / before[d]) : 0.0f;
        for (int64_t c = 0; c < m; c++) way[c] = rest[c] + beta * way[c];
        for (int d = 0; d < 3; d++) before[d] = after[d];
    }
    for (int64_t c = 0; c < m; c++)
        for (int d = 0; d < 3; d++) {
            places.data[3 * c + d] = (double)found[c][d];
            pulls.data[3 * c + d] = (double)rest[c][d];
        }
    return 0;
}
