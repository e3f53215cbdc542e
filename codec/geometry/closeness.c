/* How far a decoded mesh is from the original, in one pass and without temporaries: see closeness.py. */
#include "codec/geometry/closeness.h"

/* Arc sine of x in 0 .. 1, to 1e-9: its series up to 1/2, and beyond that by half the complement. */
INLINE double arc_sine(double x) {
    double small = x > 0.5 ? __builtin_sqrt((1.0 - x) * 0.5) : x, square = small * small, term = small, sum = small;
    for (int k = 1; k <= 12; k++) {
        term *= square * (2 * k - 1) / (2 * k);
        sum += term / (2 * k + 1);
    }
    return x > 0.5 ? 1.5707963267948966 - 2.0 * sum : sum;
}

/* Sum over faces of weight times angle (radians) between a unit normal and the decoded face's; `lost` for a decoded face
 * so flat that its normal is rounding alone: two edges whose angle has a sine below 1e-9. */
KERNEL double weighted_angle(ConstDoubles2 normals, ConstDoubles weights, ConstDoubles2 decoded, ConstInts2 faces,
                             double lost) {
    double total = 0.0;
    for (int64_t f = 0; f < faces.rows; f++) {
        if (weights.data[f] == 0.0) continue;
        const int32_t *face = faces.data + 3 * f;
        const double *a = decoded.data + 3 * (int64_t)face[0], *b = decoded.data + 3 * (int64_t)face[1];
        const double *c = decoded.data + 3 * (int64_t)face[2], *normal = normals.data + 3 * f;
        double u0 = b[0] - a[0], u1 = b[1] - a[1], u2 = b[2] - a[2], v0 = c[0] - a[0], v1 = c[1] - a[1], v2 = c[2] - a[2];
        double n0 = u1 * v2 - u2 * v1, n1 = u2 * v0 - u0 * v2, n2 = u0 * v1 - u1 * v0;
        double length = __builtin_sqrt(n0 * n0 + n1 * n1 + n2 * n2), angle = lost;
        if (length > 1e-9 * __builtin_sqrt((u0 * u0 + u1 * u1 + u2 * u2) * (v0 * v0 + v1 * v1 + v2 * v2))) {
            double d0 = n0 / length - normal[0], d1 = n1 / length - normal[1], d2 = n2 / length - normal[2];
            double half = 0.5 * __builtin_sqrt(d0 * d0 + d1 * d1 + d2 * d2);
            angle = 2.0 * arc_sine(half < 1.0 ? half : 1.0);
        }
        total += weights.data[f] * angle;
    }
    return total;
}

/* Largest distance between corresponding rows. */
KERNEL double farthest_apart(ConstDoubles2 original, ConstDoubles2 decoded) {
    double most = 0.0;
    for (int64_t v = 0; v < least(original.rows, decoded.rows); v++) {
        const double *p = original.data + 3 * v, *q = decoded.data + 3 * v;
        double d0 = p[0] - q[0], d1 = p[1] - q[1], d2 = p[2] - q[2], square = d0 * d0 + d1 * d1 + d2 * d2;
        if (!(square <= most)) most = square;
    }
    return __builtin_sqrt(most);
}
