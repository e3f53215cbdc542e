/* How far a decoded mesh is from the original, in one pass and without temporaries: see closeness.py. */
#include "codec/geometry/closeness.h"

enum { LANES = 8, TERMS = 13 };

/* Arc sine of x in 0 .. 1, to 1e-9: its series up to 1/2, and beyond that by half the complement. */
INLINE double arc_sine(double x) {
    static const double terms[TERMS] = {
        1.0,           1.0 / 6,         3.0 / 40,        5.0 / 112,         35.0 / 1152,         63.0 / 2816,        231.0 / 13312,
        143.0 / 10240, 6435.0 / 557056, 12155.0 / 1245184, 46189.0 / 5505024, 88179.0 / 12058624, 676039.0 / 104857600,
    };
    double small = x > 0.5 ? __builtin_sqrt((1.0 - x) * 0.5) : x, square = small * small, sum = terms[TERMS - 1];
    for (int k = TERMS - 1; k-- > 0;) sum = sum * square + terms[k];
    sum *= small;
    return x > 0.5 ? 1.5707963267948966 - 2.0 * sum : sum;
}

/* Sum over faces of weight times angle (radians) between a unit normal and the decoded face's; `lost` for a decoded face
 * so flat that its normal is rounding alone: two edges whose angle has a sine below 1e-9. */
KERNEL double weighted_angle(ConstDoubles2 normals, ConstDoubles weights, ConstDoubles2 decoded, ConstInts2 faces,
                             double lost) {
    double total = 0.0;
    for (int64_t first = 0; first < faces.rows; first += LANES) {
        double u[3][LANES] = {{0.0}}, v[3][LANES] = {{0.0}}, normal[3][LANES] = {{0.0}}, angle[LANES];
        int count = (int)least(LANES, faces.rows - first);
        for (int l = 0; l < count; l++) {
            const int32_t *face = faces.data + 3 * (first + l);
            const double *a = decoded.data + 3 * (int64_t)face[0], *b = decoded.data + 3 * (int64_t)face[1];
            const double *c = decoded.data + 3 * (int64_t)face[2];
            for (int j = 0; j < 3; j++) {
                u[j][l] = b[j] - a[j], v[j][l] = c[j] - a[j];
                normal[j][l] = normals.data[3 * (first + l) + j];
            }
        }
        for (int l = 0; l < LANES; l++) {
            double u0 = u[0][l], u1 = u[1][l], u2 = u[2][l], v0 = v[0][l], v1 = v[1][l], v2 = v[2][l];
            double n0 = u1 * v2 - u2 * v1, n1 = u2 * v0 - u0 * v2, n2 = u0 * v1 - u1 * v0;
            double length = __builtin_sqrt(n0 * n0 + n1 * n1 + n2 * n2);
            double sides = __builtin_sqrt((u0 * u0 + u1 * u1 + u2 * u2) * (v0 * v0 + v1 * v1 + v2 * v2));
            bool whole = length > 1e-9 * sides;
            double by = whole ? length : 1.0;
            double d0 = n0 / by - normal[0][l], d1 = n1 / by - normal[1][l], d2 = n2 / by - normal[2][l];
            double half = 0.5 * __builtin_sqrt(d0 * d0 + d1 * d1 + d2 * d2);
            angle[l] = whole ? 2.0 * arc_sine(half < 1.0 ? half : 1.0) : lost;
        }
        for (int l = 0; l < count; l++)
            if (weights.data[first + l] != 0.0) total += weights.data[first + l] * angle[l];
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
