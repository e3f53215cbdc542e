/* Who is near whom on a surface, and vertices that follow normals. */
#include "codec/denoise/denoise.h"
#include "codec/denoise/vectors.h"

/* Each face with the faces that share a vertex of at most `crowd` faces with it, itself first. Returns the number of
 * members; `seen` is scratch, one entry a face. */
int64_t face_patches(ConstInts2 faces, Lists around, int64_t crowd, Ints seen, Longs starts, Ints members) {
    int64_t end = 0;
    for (int64_t f = 0; f < faces.rows; f++) seen.data[f] = -1;
    starts.data[0] = 0;
    for (int64_t f = 0; f < faces.rows; f++) {
        seen.data[f] = (int32_t)f;
        members.data[end++] = (int32_t)f;
        for (int corner = 0; corner < 3; corner++) {
            int32_t v = faces.data[3 * f + corner];
            int64_t first = around.starts.data[v], last = around.starts.data[v + 1];
            for (int64_t k = last - first > crowd ? last : first; k < last; k++) {
                int32_t g = around.members.data[k];
                if (seen.data[g] != f) {
                    seen.data[g] = (int32_t)f;
                    members.data[end++] = g;
                }
            }
        }
        starts.data[f + 1] = end;
    }
    return end;
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
                Vector3 apart = less(row_of(points.data, p), center);
                if (dot(apart, apart) <= radius * radius) reached.data[end++] = p;
            }
        }
        int64_t every = (end - first - 1) / most + 1;
        for (int64_t k = first; k < end; k += every) reached.data[first++] = reached.data[k];
        reached_starts.data[i + 1] = end = first;
    }
    return points.rows;
}

/* Distance between the two rows of `values` that each pair names. */
void pair_distances(ConstDoubles2 values, ConstInts2 pairs, Doubles distances) {
    for (int64_t p = 0; p < distances.size; p++) {
        const int32_t *pair = pairs.data + 2 * p;
        distances.data[p] = length_of(less(row_of(values.data, pair[0]), row_of(values.data, pair[1])));
    }
}

/* Every iteration moves each free vertex by the mean of its offsets from the planes through its faces' centroids with
 * the given normals, in place: sum n (o - n . p) = sum n o - (sum n n') p. `planes`, a row of 4 for each face, and
 * `sums`, a row of 16 for each vertex, are scratch: normal and offset; place and the columns of sum n n'. */
KERNEL void follow_normals(Doubles2 positions, ConstInts2 faces, Lists around, ConstDoubles2 normals,
    int64_t iterations, ConstBytes free, Doubles2 planes, Doubles2 sums) {
    const int64_t *starts = around.starts.data;
    const int32_t *members = around.members.data;
    Four *plane = (Four *)planes.data;
    for (int64_t f = 0; f < faces.rows; f++) {
        Vector3 n = row_of(normals.data, f);
        plane[f] = (Four){n.x, n.y, n.z, 0.0};
    }
    for (int64_t v = 0; v < positions.rows; v++) {
        Four *own = (Four *)sums.data + 4 * v, zero = {0.0};
        Vector3 p = row_of(positions.data, v);
        own[0] = (Four){p.x, p.y, p.z, 0.0};
        own[1] = own[2] = own[3] = zero;
        for (int64_t k = starts[v]; k < starts[v + 1]; k++) {
            Four normal = plane[members[k]];
            for (int axis = 0; axis < 3; axis++) own[axis + 1] += normal * normal[axis];
        }
    }
    for (int64_t iteration = 0; iteration < iterations; iteration++) {
        for (int64_t f = 0; f < faces.rows; f++) {
            const int32_t *face = faces.data + 3 * f;
            const Four *place = (Four *)sums.data;
            Four along =
                plane[f] * (place[4 * (int64_t)face[0]] + place[4 * (int64_t)face[1]] + place[4 * (int64_t)face[2]]);
            plane[f][3] = (along[0] + along[1] + along[2]) / 3.0;
        }
        for (int64_t v = 0; v < positions.rows; v++) {
            int64_t first = starts[v], last = starts[v + 1];
            if (first == last || !free.data[v]) continue;
            Four *own = (Four *)sums.data + 4 * v, place = own[0], sum = {0.0};
            for (int64_t k = first; k < last; k++) sum += plane[members[k]] * plane[members[k]][3];
            sum -= own[1] * place[0] + own[2] * place[1] + own[3] * place[2];
            sum[3] = 0.0;
            own[0] = place + sum * (1.0 / (double)(last - first));
        }
    }
    for (int64_t v = 0; v < positions.rows; v++) {
        Four place = ((Four *)sums.data)[4 * v];
        put_row(positions.data, v, (Vector3){place[0], place[1], place[2]});
    }
}
