/* Three numbers, places and directions; and eight side by side. */
#ifndef BSM_DENOISE_VECTORS_H
#define BSM_DENOISE_VECTORS_H

#include "bitstream/kernel.h"

typedef struct {
    double x, y, z;
} Vector3;

INLINE Vector3 row_of(const double *data, int64_t row) {
    return (Vector3){data[3 * row], data[3 * row + 1], data[3 * row + 2]};
}
INLINE void put_row(double *data, int64_t row, Vector3 v) {
    data[3 * row] = v.x;
    data[3 * row + 1] = v.y;
    data[3 * row + 2] = v.z;
}
INLINE Vector3 less(Vector3 a, Vector3 b) { return (Vector3){a.x - b.x, a.y - b.y, a.z - b.z}; }
INLINE Vector3 plus_scaled(Vector3 a, double s, Vector3 b) {
    return (Vector3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
INLINE double dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
INLINE Vector3 cross(Vector3 a, Vector3 b) {
    return (Vector3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
INLINE double length_of(Vector3 a) { return __builtin_sqrt(dot(a, a)); }
INLINE Vector3 over(Vector3 a, double s) { return (Vector3){a.x / s, a.y / s, a.z / s}; }
/* The direction of `a`, or `otherwise` where it has none. */
INLINE Vector3 direction(Vector3 a, Vector3 otherwise) {
    double length = length_of(a);
    return length > 0.0 ? over(a, length) : otherwise;
}

/* Additions and products alone: the same to the last bit on every processor. */
enum { EIGHT = 8 };
typedef double Four __attribute__((vector_size(32), aligned(8)));
typedef double Eight __attribute__((vector_size(64)));
typedef int64_t EightLongs __attribute__((vector_size(64)));

/* exp(x) to 2e-11 of itself, for x of at most 0; below -700 what exp(-700) is, 1e-304. */
INLINE Eight exponentials(Eight x) {
    EightLongs above = x > -700.0;
    Eight lowest = {0.0};
    lowest -= 700.0;
    x = (Eight)(((EightLongs)x & above) | ((EightLongs)lowest & ~above));
    /* 1.5 * 2^52: the sum has the nearest whole number of halvings in its last bits. */
    Eight shifted = x * 1.4426950408889634 + 6755399441055744.0;
    Eight whole = shifted - 6755399441055744.0;
    Eight rest = (x - whole * 0.693147180369123816490) - whole * 1.90821492927058770002e-10;
    Eight sum = rest * (1.0 / 40320.0) + 1.0 / 5040.0;
    sum = sum * rest + 1.0 / 720.0;
    sum = sum * rest + 1.0 / 120.0;
    sum = sum * rest + 1.0 / 24.0;
    sum = sum * rest + 1.0 / 6.0;
    sum = sum * rest + 0.5;
    sum = sum * rest + 1.0;
    sum = sum * rest + 1.0;
    return (Eight)((EightLongs)sum + ((EightLongs)shifted << 52));
}

#endif
