/* Three numbers: places and directions. */
#ifndef BSM_VECTORS3_H
#define BSM_VECTORS3_H

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

#endif
