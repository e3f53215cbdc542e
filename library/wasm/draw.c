/* What a page draws, normals and bounds: WebAssembly is fast from its first call on, JavaScript is not. */
#include "library/wasm/page.h"

#include <math.h>
#include <string.h>

enum { AXES = 3 };
/* What happens to vertices: they come or move, or a face at them is whole now. */
enum { CAME = 1, MOVED = 2, BESIDE = 4 };

/* Cosines of the angles by which faces turn at edges: where vertices are parted, and beyond which an edge is sharp (60
 * degrees) or bent (30). CAD models have 4 sharp edges and more for each bent one,
 * scans 1.2 at most (19 meshes). */
static const double USUAL = 0.766, SHARP = 0.5, BENT = 0.866;
enum { CLEAR = 2 }; /* sharp edges for each bent one */

/* Move `count` vertices, from `first` on or as `chosen`, to `rows`; those that have no origin come with `block`. */
void page_move(const double *rows, int count, const int32_t *chosen, int first, int32_t block, double *p,
    int32_t *origin, uint8_t *news) {
    for (int i = 0; i < count; i++) {
        int v = chosen != NULL ? chosen[i] : first + i;
        memcpy(p + AXES * v, rows + AXES * i, AXES * sizeof *p);
        news[v] |= origin[v] < 0 ? CAME : MOVED;
        if (origin[v] < 0) origin[v] = block;
    }
}

/* A vector across a face, twice as long as its area. */
static void cross_edges(const int32_t *face, const double *p, double *across) {
    const double *a = p + AXES * face[0], *b = p + AXES * face[1], *c = p + AXES * face[2];
    double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    across[0] = uy * vz - uz * vy;
    across[1] = uz * vx - ux * vz;
    across[2] = ux * vy - uy * vx;
}

/* Find the faces that became whole, and the vertices to draw again. A face is whole when each of its corners has an
 * origin (0 or more). The corners of faces that became whole move to the front of `faces`; list[0] is their number.
 * Vertices that came or moved, or share a whole face with one that did, follow in `list`. Their origins, places and
 * unit normals (of their whole faces, weighted by area) move to the front of `origin`, `places` and `n`. */
int page_grow(int32_t *faces, int corners, int32_t *origin, const double *p, float *places, int vertices,
    uint8_t *news, int32_t *list, float *n) {
    int32_t *whole = faces;
    int count = 0;
    memset(n, 0, sizeof *n * AXES * (size_t)vertices);
    for (const int32_t *face = faces, *last = faces + corners; face < last; face += AXES) {
        int32_t v[AXES] = {face[0], face[1], face[2]};
        if ((origin[v[0]] | origin[v[1]] | origin[v[2]]) < 0) continue;
        int what = news[v[0]] | news[v[1]] | news[v[2]];
        double across[AXES];
        cross_edges(face, p, across);
        for (int i = 0; i < AXES; i++) {
            float *to = n + AXES * v[i];
            for (int j = 0; j < AXES; j++) to[j] = (float)(to[j] + across[j]);
            if (what & (MOVED | CAME)) news[v[i]] |= BESIDE;
            if (what & CAME) *whole++ = v[i];
        }
    }
    *list = (int32_t)(whole - faces);
    for (int v = 0; v < vertices; v++) {
        if (news[v] == 0) continue;
        double square = 0;
        for (int j = 0; j < AXES; j++) square += (double)n[AXES * v + j] * n[AXES * v + j];
        double length = square > 0 ? __builtin_sqrt(square) : 1;
        for (int j = 0; j < AXES; j++) {
            places[AXES * count + j] = (float)p[AXES * v + j];
            n[AXES * count + j] = (float)(n[AXES * v + j] / length);
        }
        origin[count] = origin[v];
        list[++count] = v;
    }
    return count;
}

/* The lowest and the highest place on each axis, the center of these, and how far from it a vertex is at most. */
void page_bounds(const float *p, int vertices, double *bounds) {
    const float *end = p + AXES * vertices;
    double *center = bounds + 2 * AXES, most = 0;
    for (int j = 0; j < AXES; j++) {
        double low = INFINITY, high = -INFINITY;
        for (const float *at = p + j; at < end; at += AXES) {
            if (*at < low) low = *at;
            if (*at > high) high = *at;
        }
        bounds[j] = low;
        bounds[AXES + j] = high;
        center[j] = (low + high) / 2;
    }
    for (const float *at = p; at < end; at += AXES) {
        double square = 0;
        for (int j = 0; j < AXES; j++) square += (at[j] - center[j]) * (at[j] - center[j]);
        if (square > most) most = square;
    }
    center[AXES] = __builtin_sqrt(most);
}

/* The corner that stands for all corners of a group. */
static int32_t group_of(int32_t *parent, int32_t corner) {
    while (parent[corner] != corner) corner = parent[corner] = parent[parent[corner]];
    return corner;
}

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Part vertices at edges where faces turn by more than the angle whose cosine is `least`. Below -1 the angle is the
 * usual one, and only meshes with clearly sharp edges are parted, as CAD models have and scans have not. Each group of
 * corners at a vertex becomes a vertex, and `source` says of which. `work` has 2 * vertices + 3 * corners zeros,
 * `source` and `n` have room for `corners`. Returns the number of vertices; 0: none is parted. */
int page_crease(int32_t *faces, int corners, const double *p, int vertices, double least, int32_t *source,
    int32_t *work, double *n) {
    int32_t *heads = work, *met = heads + vertices, *next = met + vertices, *number = next + corners; /* 0: none */
    int32_t *parent = number + corners;
    int sharp = 0, bent = 0, count = 0, is_free = least < -1;
    for (int i = 0; i < corners; i++) {
        parent[i] = i;
        next[i] = heads[faces[i]]; /* the corners of a vertex are a chain */
        heads[faces[i]] = i + 1;
        if (i % AXES == 0) cross_edges(faces + i, p, n + i);
    }
    for (int v = 0; v < vertices; v++) {
        for (int corner = heads[v] - 1; corner >= 0; corner = next[corner] - 1) {
            const double *a = n + (corner - corner % AXES);
            for (int k = 1; k < AXES; k++) {
                int32_t *place = met + faces[corner - corner % AXES + (corner + k) % AXES], other = *place - 1;
                *place = corner + 1;
                if (other < 0 || faces[other] != v) continue; /* it was met from another vertex */
                const double *b = n + (other - other % AXES);
                double turn = dot(a, b) / __builtin_sqrt(dot(a, a) * dot(b, b));
                sharp += turn < SHARP; /* not a number for a face without area, which is joined with none */
                bent += turn < BENT;
                if (turn >= (is_free ? USUAL : least)) parent[group_of(parent, corner)] = group_of(parent, other);
            }
        }
    }
    if (is_free && (sharp == 0 || sharp < CLEAR * (bent - sharp))) return 0;
    for (int i = 0; i < corners; i++) {
        int32_t *group = number + group_of(parent, i);
        if (*group == 0) {
            source[count++] = faces[i];
            *group = count;
        }
        faces[i] = *group - 1;
    }
    return count;
}
