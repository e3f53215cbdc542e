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

INLINE float degree_of(Links graph, int64_t v) {
    int32_t degree = graph.offsets.data[v + 1] - graph.offsets.data[v];
    return degree > 0 ? (float)degree : 1.0f;
}

/* y = own x + around (mean of the neighbors' x). */
KERNEL OFTEN static void average(Links graph, float own, float around, const FourSingles *x, FourSingles *y) {
    for (int64_t v = 0; v < graph.offsets.size - 1; v++) {
        FourSingles sum = {0.0f, 0.0f, 0.0f, 0.0f};
        for (int32_t i = graph.offsets.data[v]; i < graph.offsets.data[v + 1]; i++) sum += x[graph.neighbors.data[i]];
        y[v] = own * x[v] + around / degree_of(graph, v) * sum;
    }
}

/* Averages are not symmetric, but those of values over degrees are: their transpose is an average between these two. */
static void divide_by_degrees(Links graph, FourSingles *x) {
    for (int64_t v = 0; v < graph.offsets.size - 1; v++) x[v] = 1.0f / degree_of(graph, v) * x[v];
}

static void multiply_by_degrees(Links graph, FourSingles *x) {
    for (int64_t v = 0; v < graph.offsets.size - 1; v++) x[v] = degree_of(graph, v) * x[v];
}

/* Smooth x, with room in y; returns which of them has the result. */
static FourSingles *smoothed(Links graph, int64_t rounds, FourSingles *x, FourSingles *y) {
    for (int64_t k = 0; k < rounds; k++) {
        average(graph, 0.5f, 0.5f, x, y);
        FourSingles *other = x;
        x = y;
        y = other;
    }
    return x;
}

/* F q, for the vertices of a mesh; x and y are room. */
static FourSingles *spread_cells(Links mesh, ConstInts own, int64_t rounds, const FourSingles *q, FourSingles *x,
    FourSingles *y) {
    for (int64_t v = 0; v < own.size; v++) x[v] = q[own.data[v]];
    return smoothed(mesh, rounds, x, y);
}

/* `result`, for the cells: F^T x; x is changed and y is room. */
static void gather_cells(Links mesh, ConstInts own, int64_t rounds, FourSingles *x, FourSingles *y, FourSingles *result,
    int64_t cells) {
    divide_by_degrees(mesh, x);
    const FourSingles *sums = smoothed(mesh, rounds, x, y);
    for (int64_t c = 0; c < cells; c++) result[c] = (FourSingles){0.0f, 0.0f, 0.0f, 0.0f};
    for (int64_t v = 0; v < own.size; v++) result[own.data[v]] += degree_of(mesh, v) * sums[v];
}

/* Add bent K^T K q + small q to `result`; `room` has two entries a cell. */
static void add_bend(Links cells, const FourSingles *q, float bent, float small, FourSingles *room,
    FourSingles *result) {
    int64_t m = cells.offsets.size - 1;
    FourSingles *x = room, *y = room + m;
    average(cells, 1.0f, -1.0f, q, x);
    divide_by_degrees(cells, x);
    average(cells, 1.0f, -1.0f, x, y);
    multiply_by_degrees(cells, y);
    for (int64_t c = 0; c < m; c++) result[c] += bent * y[c] + small * q[c];
}

static void add_products(const FourSingles *a, const FourSingles *b, int64_t count, double *sums) {
    for (int d = 0; d < 3; d++) sums[d] = 0.0;
    for (int64_t c = 0; c < count; c++)
        for (int d = 0; d < 3; d++) sums[d] += (double)a[c][d] * (double)b[c][d];
}

/* Bring `places` (m x 3) nearer to the least sum; `pulls` are half of how fast it falls there, without SMALL. `scratch`
 * has eight numbers a vertex and 24 a cell. */
int64_t fit_cells(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstInts links, ConstInts linked,
    ConstDoubles2 positions, int64_t rounds, double bent, int64_t steps, Singles scratch, Doubles2 places,
    Doubles2 pulls) {
    int64_t n = own.size, m = links.size - 1;
    if (!fits_graph(offsets, neighbors) || !fits_graph(links, linked) || offsets.size != n + 1 || positions.rows != n
        || positions.columns != 3 || places.rows != m || places.columns != 3 || pulls.rows != m || pulls.columns != 3
        || scratch.size < 8 * n + 24 * m)
        return MISUSED;
    Links mesh = {offsets, neighbors}, cells = {links, linked};
    FourSingles *x = (FourSingles *)scratch.data, *y = x + n, *rest = y + n, *way = rest + m,
                *image = way + m, *found = image + m, *room = found + m;
    for (int64_t c = 0; c < m; c++) {
        const double *place = places.data + 3 * c;
        found[c] = (FourSingles){(float)place[0], (float)place[1], (float)place[2], 0.0f};
    }
    FourSingles *vertices = spread_cells(mesh, own, rounds, found, x, y);
    for (int64_t v = 0; v < n; v++)
        for (int d = 0; d < 3; d++) vertices[v][d] = (float)(positions.data[3 * v + d] - (double)vertices[v][d]);
    gather_cells(mesh, own, rounds, vertices, vertices == x ? y : x, rest, m);
    for (int64_t c = 0; c < m; c++) image[c] = (FourSingles){0.0f, 0.0f, 0.0f, 0.0f};
    add_bend(cells, found, (float)bent, 0.0f, room, image);
    double before[3], after[3], along[3];
    for (int64_t c = 0; c < m; c++) way[c] = rest[c] = rest[c] - image[c];
    add_products(rest, rest, m, before);
    for (int64_t step = 0; step < steps; step++) {
        vertices = spread_cells(mesh, own, rounds, way, x, y);
        gather_cells(mesh, own, rounds, vertices, vertices == x ? y : x, image, m);
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
