/* Normals of faces, what those of vertices are made of, and the geometric Laplacian of NMSVE (paper, section 8). */
#include "codec/geometry/metrics.h"

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
