/* The kernels of geometry. */
#ifndef BSM_GEOMETRY_H
#define BSM_GEOMETRY_H

#include "bitstream/kernel.h"

/* Whether there are as many neighbours as the offsets of a graph say. */
INLINE bool fits_graph(ConstInts offsets, ConstInts neighbours) {
    return offsets.size > 0 && offsets.data[offsets.size - 1] >= 0 && neighbours.size >= offsets.data[offsets.size - 1];
}

int64_t collect_edges(ConstInts2 faces, Ints offsets, Ints filled, Ints ends);
int64_t component_sizes(ConstInts offsets, ConstInts neighbours, Bytes seen, Ints waiting, Ints sizes);
int64_t reaches_all(ConstInts offsets, ConstInts neighbours, Ints scratch);
void vertex_faces(ConstInts2 faces, Longs starts, Ints members);
void face_normals(ConstDoubles2 positions, ConstInts2 faces, Doubles2 normals);
void crosses_around(ConstDoubles2 positions, ConstInts2 faces, Doubles2 crosses, Doubles lengths);
void geometric_laplacian(ConstDoubles2 positions, ConstLongs starts, ConstInts members, Doubles2 result);
double weighted_angle(ConstDoubles2 normals, ConstDoubles weights, ConstDoubles2 decoded, ConstInts2 faces,
                      double lost);
double farthest_apart(ConstDoubles2 original, ConstDoubles2 decoded);
int64_t build_tree(ConstDoubles2 lowest, ConstDoubles2 highest, Longs order, Doubles2 low,
                   Doubles2 high, Longs first, Longs count);
void nearest_distances(ConstDoubles2 points, ConstDoubles2 triangles, ConstDoubles2 low, ConstDoubles2 high,
                       ConstLongs first, ConstLongs count, Doubles distances);
double farthest_distance(ConstDoubles2 points, ConstDoubles2 triangles, ConstDoubles2 low, ConstDoubles2 high,
                         ConstLongs first, ConstLongs count);
void nearest_faces(ConstDoubles2 corners, Ints2 owner, Doubles2 depth);

/* Sort values that nearly always come nearly sorted: by insertion, and by a heap once that has moved too many of them,
 * so that none, however many and in whatever order, take more than n log n steps. */
INLINE void sort_ascending(int32_t *values, int64_t size) {
    int64_t moves = 32 * size, sorted = 1;
    for (; sorted < size && moves > 0; sorted++) {
        int32_t value = values[sorted];
        int64_t j = sorted;
        for (; j > 0 && values[j - 1] > value; j--) values[j] = values[j - 1];
        values[j] = value;
        moves -= sorted - j;
    }
    if (sorted >= size) return;
    for (int64_t start = size / 2, end = size; end > 1;) {
        if (start > 0) {
            start--;
        } else {
            end--;
            int32_t value = values[end];
            values[end] = values[0];
            values[0] = value;
        }
        int64_t root = start;
        int32_t value = values[root];
        for (int64_t child = 2 * root + 1; child < end; child = 2 * root + 1) {
            if (child + 1 < end && values[child + 1] > values[child]) child++;
            if (values[child] <= value) break;
            values[root] = values[child];
            root = child;
        }
        values[root] = value;
    }
}

#endif
