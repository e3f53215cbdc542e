/* Who is near whom, filters of face normals (paper, equations 9 to 11), what guides them, and vertices that follow. */
#include "codec/denoise/denoise.h"

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
INLINE Vector3 plus_scaled(Vector3 a, double s, Vector3 b) {
    return (Vector3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
INLINE double dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/* Additions and products alone: the same to the last bit on every processor. */
enum { EIGHT = 8, CHUNK = 32 };
typedef double Four __attribute__((vector_size(32), aligned(8)));
typedef float Lanes __attribute__((vector_size(32), aligned(4), may_alias));
typedef int32_t LaneInts __attribute__((vector_size(32), aligned(4)));

/* exp(x) to 2e-7 of itself, for x of at most 0; below -80 what exp(-80) is. */
INLINE Lanes exponentials(Lanes x) {
    LaneInts above = x > -80.0f;
    Lanes lowest = x * 0.0f - 80.0f;
    x = (Lanes)(((LaneInts)x & above) | ((LaneInts)lowest & ~above));
    Lanes shifted = x * 1.44269504f + 12582912.0f, whole = shifted - 12582912.0f; /* 1.5 * 2^23 */
    Lanes rest = (x - whole * 0.693145752f) - whole * 1.42860677e-6f;
    static const float factorials[] = {1.0f / 120.0f, 1.0f / 24.0f, 1.0f / 6.0f, 0.5f, 1.0f, 1.0f};
    Lanes sum = rest * 0.0f + 1.0f / 720.0f;
    for (int k = 0; k < 6; k++) sum = sum * rest + factorials[k];
    return (Lanes)((LaneInts)sum + ((LaneInts)shifted << 23));
}

typedef struct {
    Lanes place; /* centroid and guide over their kernels' widths, so that neighbors are compared whole */
    Four normal; /* and one, both times the area */
} Packed;

/* Joint bilateral filter: the sum of the neighbors' normals, by area, distance and likeness, and that of these weights;
 * `packed` is scratch, a row of 8 for each face. */
KERNEL void weighed_normals(FaceGeometry faces, ConstDoubles2 guide, Lists near, double sigma_s, double sigma_r,
    Doubles2 packed, Doubles2 sums) {
    ConstDoubles2 centroids = faces.centroids, normals = faces.normals;
    const int64_t *starts = near.starts.data;
    double spatial = __builtin_sqrt(0.5) / sigma_s, range = __builtin_sqrt(0.5) / sigma_r;
    Packed *rows = (Packed *)packed.data;
    for (int64_t f = 0; f < normals.rows; f++) {
        const double *c = centroids.data + 3 * f, *g = guide.data + 3 * f, *n = normals.data + 3 * f;
        double a = faces.areas.data[f];
        for (int i = 0; i < 3; i++) {
            double place = (c[i] - centroids.data[i]) * spatial;
            rows[f].place[i] = (float)(place < -1e15 ? -1e15 : place < 1e15 ? place : 1e15);
            rows[f].place[i + 4] = (float)(g[i] * range);
        }
        rows[f].normal = (Four){n[0] * a, n[1] * a, n[2] * a, a};
    }
    for (int64_t f = 0; f < normals.rows; f++) {
        Lanes place = rows[f].place;
        Four sum = {0.0};
        for (int64_t first = starts[f]; first < starts[f + 1]; first += CHUNK) {
            const int32_t *row = near.members.data + first;
            int64_t count = least(CHUNK, starts[f + 1] - first);
            float weights[CHUNK] = {0.0f};
            for (int64_t k = 0; k < count; k++) {
                Lanes apart = rows[row[k]].place - place, s = apart * apart;
                /* Both kernels are Gaussian, so one exponential of the sum serves. */
                weights[k] = -(((s[0] + s[4]) + (s[1] + s[5])) + (s[2] + s[6]));
            }
            Lanes *some = (Lanes *)weights;
            for (int64_t k = 0; k < count; k += EIGHT, some++) *some = exponentials(*some);
            for (int64_t k = 0; k < count; k++) sum += rows[row[k]].normal * (double)weights[k];
        }
        ((Four *)sums.data)[f] = sum;
    }
}

/* `steps`: distance between the normals of each pair of neighboring faces. A low score is a consistent patch; `guide`
 * gets the mean of the most consistent one that holds the face. */
KERNEL void patch_guidance(ConstDoubles2 normals, ConstDoubles areas, Lists patches, ConstDoubles steps, Lists inner,
    Doubles scores, Doubles2 means, Doubles2 guide) {
    ConstLongs starts = patches.starts;
    ConstInts members = patches.members;
    for (int64_t f = 0; f < normals.rows; f++) {
        int64_t first = starts.data[f], last = starts.data[f + 1];
        double widest = 0.0, total = 0.0, highest = 0.0;
        Vector3 sum = {0.0, 0.0, 0.0};
        for (int64_t k = first; k < last; k++)
            sum = plus_scaled(sum, areas.data[members.data[k]], row_of(normals.data, members.data[k]));
        for (int64_t k = first; k < last; k++) {
            Vector3 normal = row_of(normals.data, members.data[k]);
            for (int64_t q = k + 1; q < last; q++) {
                Vector3 apart = plus_scaled(row_of(normals.data, members.data[q]), -1.0, normal);
                widest = dot(apart, apart) > widest ? dot(apart, apart) : widest;
            }
        }
        for (int64_t k = inner.starts.data[f]; k < inner.starts.data[f + 1]; k++) {
            double step = steps.data[inner.members.data[k]];
            total += step;
            highest = step > highest ? step : highest;
        }
        scores.data[f] = __builtin_sqrt(widest) * highest / (total + 1e-9);
        double length = __builtin_sqrt(dot(sum, sum));
        put_row(means.data, f, plus_scaled((Vector3){0.0}, length > 0.0 ? 1.0 / length : 0.0, sum));
    }
    for (int64_t f = 0; f < scores.size; f++) {
        int32_t best = members.data[starts.data[f]];
        for (int64_t k = starts.data[f] + 1; k < starts.data[f + 1]; k++)
            if (scores.data[members.data[k]] < scores.data[best]) best = members.data[k];
        put_row(guide.data, f, row_of(means.data, best));
    }
}

/* Breadth-first from each point over adjacent points within the radius of it, point `begin` on; of rows of more than
 * `most` every second, third, ... point. Returns the point before which it stopped because a row of it might not fit
 * into `reached`. `seen`, one entry a point, holds -1 when the first point is asked for. */
int64_t reach(ConstDoubles2 points, Lists adjacent, double radius, int64_t most, int64_t begin, Ints seen,
    Longs reached_starts, Ints reached) {
    int64_t end = begin > 0 ? reached_starts.data[begin] : 0;
    reached_starts.data[0] = 0;
    for (int64_t i = begin; i < points.rows; i++) {
        if (end + points.rows > reached.size) return i;
        Vector3 center = row_of(points.data, i);
        int64_t first = end, head = end;
        reached.data[end++] = seen.data[i] = (int32_t)i;
        while (head < end) {
            int32_t g = reached.data[head++];
            for (int64_t k = adjacent.starts.data[g]; k < adjacent.starts.data[g + 1]; k++) {
                int32_t p = adjacent.members.data[k];
                if (seen.data[p] == i) continue;
                seen.data[p] = (int32_t)i;
                Vector3 apart = plus_scaled(row_of(points.data, p), -1.0, center);
                if (dot(apart, apart) <= radius * radius) reached.data[end++] = p;
            }
        }
        int64_t every = (end - first - 1) / most + 1;
        for (int64_t k = first; k < end; k += every) reached.data[first++] = reached.data[k];
        reached_starts.data[i + 1] = end = first;
    }
    return points.rows;
}

/* Every iteration moves each free vertex by the mean of its offsets from the planes through its faces' centroids with
 * the given normals, in place; `heights` of the planes are scratch, one a face. */
KERNEL void follow_normals(Doubles2 positions, ConstInts2 faces, Lists around, ConstDoubles2 normals,
    int64_t iterations, ConstBytes free, Doubles heights) {
    for (int64_t iteration = 0; iteration < iterations; iteration++) {
        for (int64_t f = 0; f < faces.rows; f++) {
            Vector3 normal = row_of(normals.data, f);
            heights.data[f] = 0.0;
            for (int corner = 0; corner < 3; corner++)
                heights.data[f] += dot(normal, row_of(positions.data, faces.data[3 * f + corner])) / 3.0;
        }
        for (int64_t v = 0; v < positions.rows; v++) {
            int64_t first = around.starts.data[v], last = around.starts.data[v + 1];
            if (first == last || !free.data[v]) continue;
            Vector3 place = row_of(positions.data, v), way = {0.0, 0.0, 0.0};
            for (int64_t k = first; k < last; k++) {
                Vector3 normal = row_of(normals.data, around.members.data[k]);
                way = plus_scaled(way, heights.data[around.members.data[k]] - dot(normal, place), normal);
            }
            put_row(positions.data, v, plus_scaled(place, 1.0 / (double)(last - first), way));
        }
    }
}
