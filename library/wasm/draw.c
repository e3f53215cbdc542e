/* What a page draws, normals and bounds: WebAssembly is fast from its first call on, JavaScript is not. */
#include "library/wasm/page.h"

#include <math.h>
#include <string.h>

enum { AXES = 3 };
/* What happens to vertices: they come or move, or a face at them is whole now. */
enum { CAME = 1, MOVED = 2, BESIDE = 4 };

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
        const double *a = p + AXES * v[0], *b = p + AXES * v[1], *c = p + AXES * v[2];
        double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
        double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
        double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
        for (int i = 0; i < AXES; i++) {
            float *to = n + AXES * v[i];
            to[0] = (float)(to[0] + x);
            to[1] = (float)(to[1] + y);
            to[2] = (float)(to[2] + z);
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
