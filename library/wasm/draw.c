/* Normals and bounds for a page: WebAssembly is fast from its first call on, JavaScript is not. */
#include "library/wasm/page.h"

#include <math.h>
#include <string.h>

enum { AXES = 3 };

/* Normals `n` of vertices at `p`: sums of those of faces, as long as twice their areas, whose corners all have an
 * origin, which is 0 or more. */
void page_normals(const int32_t *faces, int corners, const int32_t *origin, const double *p, float *n, int vertices) {
    float *end = n + AXES * vertices;
    memset(n, 0, sizeof(float) * AXES * (size_t)vertices);
    for (const int32_t *face = faces, *last = faces + corners; face < last; face += AXES) {
        if ((origin[face[0]] | origin[face[1]] | origin[face[2]]) < 0) continue;
        const double *a = p + AXES * face[0], *b = p + AXES * face[1], *c = p + AXES * face[2];
        double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
        double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
        double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
        for (int i = 0; i < AXES; i++) {
            float *to = n + AXES * face[i];
            to[0] = (float)(to[0] + x);
            to[1] = (float)(to[1] + y);
            to[2] = (float)(to[2] + z);
        }
    }
    for (float *at = n; at < end; at += AXES) {
        double x = at[0], y = at[1], z = at[2], length = __builtin_sqrt(x * x + y * y + z * z);
        if (!(length > 0)) continue;
        at[0] = (float)(x / length);
        at[1] = (float)(y / length);
        at[2] = (float)(z / length);
    }
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
