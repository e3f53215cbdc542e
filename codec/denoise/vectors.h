/* Three numbers, places and directions; and eight side by side. */
#pragma once

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
/* The direction of `a`, or `otherwise` where it has none. */
INLINE Vector3 direction(Vector3 a, Vector3 otherwise) {
    double length = length_of(a);
    return length > 0.0 ? (Vector3){a.x / length, a.y / length, a.z / length} : otherwise;
}

/* Additions and products alone: the same to the last bit on every processor. */
enum { EIGHT = 8, CHUNK = 32 };
typedef double Four __attribute__((vector_size(32), aligned(8)));
typedef double Eight __attribute__((vector_size(64)));
typedef int64_t EightLongs __attribute__((vector_size(64)));

typedef float Lanes __attribute__((vector_size(32), aligned(4), may_alias));
typedef int32_t LaneInts __attribute__((vector_size(32), aligned(4)));

/* exp(x) to 2e-7 of itself, for x of at most 0; below -80 what exp(-80) is. */
INLINE Lanes exponentials(Lanes x) {
    LaneInts above = x > -80.0f;
    Lanes lowest = x * 0.0f - 80.0f;
    x = (Lanes)(((LaneInts)x & above) | ((LaneInts)lowest & ~above));
    Lanes shifted = x * 1.44269504f + 12582912.0f, whole = shifted - 12582912.0f; /* 1.5 * 2^23 */
    Lanes rest = (x - whole * 0.693145752f) - whole * 1.42860677e-6f;
    Lanes sum = rest * (1.0f / 720.0f) + 1.0f / 120.0f;
    sum = sum * rest + 1.0f / 24.0f;
    sum = sum * rest + 1.0f / 6.0f;
    sum = sum * rest + 0.5f;
    sum = sum * rest + 1.0f;
    sum = sum * rest + 1.0f;
    return (Lanes)((LaneInts)sum + ((LaneInts)shifted << 23));
}
