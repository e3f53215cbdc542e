/* Who is near whom on a surface, and vertices that follow normals. */
#include "codec/denoise/denoise.h"
#include "codec/denoise/vectors.h"

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
