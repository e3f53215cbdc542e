/* Normals of faces, what those of vertices are made of, and the geometric Laplacian of NMSVE (paper, section 8). */
#include "codec/geometry/geometry.h"

/* The cross product of two edges of a face, and its length: twice the area. */
typedef struct {
    double x, y, z, length;
} Cross;

static Cross cross_of(ConstDoubles2 positions, const int32_t *face) {
    const double *a = positions.data + 3 * (int64_t)face[0];
    const double *b = positions.data + 3 * (int64_t)face[1];
    const double *c = positions.data + 3 * (int64_t)face[2];
    double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    return (Cross){x, y, z, __builtin_sqrt(x * x + y * y + z * z)};
}

/* Unit normals; zero where a face has no area. */
void face_normals(ConstDoubles2 positions, ConstInts2 faces, Doubles2 normals) {
    for (int64_t f = 0; f < least(faces.rows, normals.rows); f++) {
        const int32_t *face = faces.data + 3 * f;
        const Cross cross = cross_of(positions, face);
        double *normal = normals.data + 3 * f;
        normal[0] = cross.length > 0.0 ? cross.x / cross.length : 0.0;
        normal[1] = cross.length > 0.0 ? cross.y / cross.length : 0.0;
        normal[2] = cross.length > 0.0 ? cross.z / cross.length : 0.0;
    }
}

/* Adds up around each vertex the cross products of its faces' edges, and their lengths; both begin as zeros. */
void crosses_around(ConstDoubles2 positions, ConstInts2 faces, Doubles2 crosses, Doubles lengths) {
    if (crosses.rows < positions.rows || lengths.size < positions.rows) return;
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        const Cross cross = cross_of(positions, face);
        for (int k = 0; k < 3; k++) {
            double *sum = crosses.data + 3 * (int64_t)face[k];
            sum[0] += cross.x;
            sum[1] += cross.y;
            sum[2] += cross.z;
            lengths.data[face[k]] += cross.length;
        }
    }
}

/* Each vertex minus the mean of its neighbours, weighted by inverse distance; zero beside a neighbour at distance 0. */
void geometric_laplacian(ConstDoubles2 positions, ConstLongs starts, ConstInts members, Doubles2 result) {
    for (int64_t i = 0; i < least(positions.rows, least(starts.size - 1, result.rows)); i++) {
        const double *own = positions.data + 3 * i;
        double sum[3] = {0.0, 0.0, 0.0}, total = 0.0;
        for (int64_t k = starts.data[i]; k < starts.data[i + 1]; k++) {
            const double *other = positions.data + 3 * (int64_t)members.data[k];
            double x = other[0] - own[0], y = other[1] - own[1], z = other[2] - own[2];
            double distance = __builtin_sqrt(x * x + y * y + z * z);
            if (distance == 0.0) {
                total = 0.0;
                break;
            }
            double weight = 1.0 / distance;
            total += weight;
            sum[0] += weight * x;
            sum[1] += weight * y;
            sum[2] += weight * z;
        }
        for (int d = 0; d < 3; d++) result.data[3 * i + d] = total > 0.0 ? -sum[d] / total : 0.0;
    }
}

/* How far a decoded mesh is from the original, in one pass and without temporaries: see metrics.py. */

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
