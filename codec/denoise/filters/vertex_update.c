/* Centroids, areas and normals of faces, and vertices that follow normals (paper, equations 12 and 13). */
#include "codec/denoise/filters/vertex_update.h"
#include "codec/denoise/filters/vectors3.h"

void face_geometry(ConstDoubles2 positions, ConstInts2 faces, Doubles2 centroids, Doubles areas, Doubles2 normals) {
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        Vector3 a = row_of(positions.data, face[0]), b = row_of(positions.data, face[1]);
        Vector3 c = row_of(positions.data, face[2]), normal = cross(less(b, a), less(c, a));
        areas.data[f] = 0.5 * length_of(normal);
        put_row(normals.data, f, direction(normal, (Vector3){0.0, 0.0, 0.0}));
        put_row(centroids.data, f, (Vector3){(a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0, (a.z + b.z + c.z) / 3.0});
    }
}

/* Distance between the two rows of `values` that each pair names. */
void pair_distances(ConstDoubles2 values, ConstInts2 pairs, Doubles distances) {
    for (int64_t p = 0; p < distances.size; p++) {
        const int32_t *pair = pairs.data + 2 * p;
        distances.data[p] = length_of(less(row_of(values.data, pair[0]), row_of(values.data, pair[1])));
    }
}

/* The plain mean of the normals of the faces around each vertex, of length one; zero where they cancel. */
void vertex_normals(ConstDoubles2 normals, ConstLongs starts, ConstInts around, Doubles2 averaged) {
    for (int64_t v = 0; v < starts.size - 1; v++) {
        Vector3 sum = {0.0, 0.0, 0.0};
        for (int64_t k = starts.data[v]; k < starts.data[v + 1]; k++)
            sum = plus_scaled(sum, 1.0, row_of(normals.data, around.data[k]));
        put_row(averaged.data, v, direction(sum, (Vector3){0.0, 0.0, 0.0}));
    }
}

/* Every iteration moves each free vertex by the mean of its offsets from the planes through its faces' centroids with
 * the given normals, in place and in turn. `offsets` is scratch, one entry a face. */
void follow_normals(Doubles2 positions, ConstInts2 faces, ConstLongs starts, ConstInts around, ConstDoubles2 normals,
                    int64_t iterations, ConstBytes free, Doubles offsets) {
    for (int64_t iteration = 0; iteration < iterations; iteration++) {
        for (int64_t f = 0; f < faces.rows; f++) {
            const int32_t *face = faces.data + 3 * f;
            Vector3 a = row_of(positions.data, face[0]), b = row_of(positions.data, face[1]);
            Vector3 c = row_of(positions.data, face[2]);
            Vector3 sum = {a.x + b.x + c.x, a.y + b.y + c.y, a.z + b.z + c.z};
            offsets.data[f] = dot(row_of(normals.data, f), sum) / 3.0;
        }
        for (int64_t v = 0; v < positions.rows; v++) {
            int64_t first = starts.data[v], last = starts.data[v + 1];
            if (first == last || !free.data[v]) continue;
            Vector3 place = row_of(positions.data, v), sum = {0.0, 0.0, 0.0};
            for (int64_t k = first; k < last; k++) {
                Vector3 normal = row_of(normals.data, around.data[k]);
                sum = plus_scaled(sum, offsets.data[around.data[k]] - dot(normal, place), normal);
            }
            put_row(positions.data, v, plus_scaled(place, 1.0 / (double)(last - first), sum));
        }
    }
}
