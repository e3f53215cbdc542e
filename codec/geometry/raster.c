/* Which face each pixel of a picture shows: a depth buffer. */
#include "codec/geometry/geometry.h"

INLINE double smallest3(double a, double b, double c) {
    double s = a < b ? a : b;
    return s < c ? s : c;
}

INLINE double largest3(double a, double b, double c) {
    double s = a > b ? a : b;
    return s > c ? s : c;
}

INLINE int64_t clamped(double x, int64_t size) { return x < 0.0 ? 0 : x > (double)size ? size : (int64_t)x; }

/* The face nearest to the camera in each pixel, or -1. `corners` has nine numbers a face: column, row and depth of each
 * corner; `depth` has the shape of `owner`. */
void nearest_faces(ConstDoubles2 corners, Ints2 owner, Doubles2 depth) {
    for (int64_t i = 0; i < owner.rows * owner.columns; i++) {
        owner.data[i] = -1;
        depth.data[i] = -__builtin_inf();
    }
    for (int64_t face = 0; face < corners.rows; face++) {
        const double *a = corners.data + 9 * face, *b = a + 3, *c = a + 6;
        double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if (!(area > 0.0 || area < 0.0)) continue;
        int64_t top = clamped(smallest3(a[1], b[1], c[1]), owner.rows);
        int64_t bottom = clamped(largest3(a[1], b[1], c[1]) + 1.0, owner.rows);
        int64_t left = clamped(smallest3(a[0], b[0], c[0]), owner.columns);
        int64_t right = clamped(largest3(a[0], b[0], c[0]) + 1.0, owner.columns);
        for (int64_t row = top; row < bottom; row++) {
            for (int64_t column = left; column < right; column++) {
                double x = (double)column + 0.5, y = (double)row + 0.5;
                double u = ((b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)) / area;
                double v = ((c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)) / area;
                double w = 1.0 - u - v;
                if (u < 0.0 || v < 0.0 || w < 0.0) continue;
                double z = u * a[2] + v * b[2] + w * c[2];
                int64_t pixel = row * owner.columns + column;
                if (z > depth.data[pixel]) {
                    depth.data[pixel] = z;
                    owner.data[pixel] = (int32_t)face;
                }
            }
        }
    }
}
