/* The kernels of geometry. */
#pragma once

#include "bitstream/kernel.h"

/* Compressed rows: those of i are `members` from `starts` i to i + 1. */
typedef struct {
    ConstLongs starts;
    ConstInts members;
} Lists;

/* Of each face. */
typedef struct {
    ConstDoubles2 centroids;
    ConstDoubles areas;
    ConstDoubles2 normals;
} FaceGeometry;

/* Triangles, nine numbers a row, in the `order` of a tree of boxes: see build_tree. */
typedef struct {
    ConstDoubles2 triangles, low, high;
    ConstLongs first, count, order;
} Tree;

/* Whether there are as many neighbors as the offsets of a graph say. */
INLINE bool fits_graph(ConstInts offsets, ConstInts neighbors) {
    return offsets.size > 0 && offsets.data[offsets.size - 1] >= 0 && neighbors.size >= offsets.data[offsets.size - 1];
}

INLINE double dot3(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* The square of a distance. */
INLINE double apart(const double *a, const double *b) {
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
}

/* The normal of a triangle, as long as twice its area. */
INLINE void cross3(const double *a, const double *b, const double *c, double *n) {
    double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2], vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    n[0] = uy * vz - uz * vy;
    n[1] = uz * vx - ux * vz;
    n[2] = ux * vy - uy * vx;
}

INLINE void cross_of_face(const double *positions, const int32_t *face, double *n) {
    cross3(positions + 3 * (int64_t)face[0], positions + 3 * (int64_t)face[1], positions + 3 * (int64_t)face[2], n);
}

int64_t collect_edges(ConstInts2 faces, Ints offsets, Ints filled, Ints ends, Ints second);
int64_t equal_rows(ConstLongs2 rows, int64_t seed, Ints places, Ints numbers);
int64_t label_components(ConstInts offsets, ConstInts neighbors, Ints waiting, Ints labels);
bool reaches_all(ConstInts offsets, ConstInts neighbors, Ints scratch);
void vertex_faces(ConstInts2 faces, Longs starts, Ints members);
void face_geometry(
    ConstDoubles2 positions, ConstInts2 faces, Doubles2 centroids, Doubles areas, Doubles2 normals, Bytes whole);
void geometric_laplacian(ConstDoubles2 positions, Lists neighbors, Doubles2 result);
double weighted_angle(ConstDoubles2 normals, ConstDoubles weights, ConstDoubles2 decoded, ConstInts2 faces,
                      double lost);
int64_t build_tree(ConstDoubles2 lowest, ConstDoubles2 highest, Longs order, Doubles2 low,
                   Doubles2 high, Longs first, Longs count);
double nearest_distances(ConstDoubles2 points, Tree tree, Doubles distances, Longs which);

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

INLINE double square(double x) { return x * x; }

INLINE double to_segment(const double *p, const double *a, const double *b) {
    double length = 0.0, reached = 0.0, total = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        length += square(b[axis] - a[axis]);
        reached += (b[axis] - a[axis]) * (p[axis] - a[axis]);
    }
    double t = length > 0.0 ? reached / length : 0.0;
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    for (int axis = 0; axis < 3; axis++) total += square(a[axis] + t * (b[axis] - a[axis]) - p[axis]);
    return total;
}

/* Squared distance: to the plane where the foot lies inside, otherwise to the nearest edge. */
INLINE double to_triangle(const double *p, const double *triangle) {
    const double *a = triangle, *b = triangle + 3, *c = triangle + 6;
    double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    double wx = p[0] - a[0], wy = p[1] - a[1], wz = p[2] - a[2];
    double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    double squared = nx * nx + ny * ny + nz * nz;
    if (squared > 0.0) {
        /* Barycentric coordinates of the foot, times the square. */
        double at_c = (uy * wz - uz * wy) * nx + (uz * wx - ux * wz) * ny + (ux * wy - uy * wx) * nz;
        double at_b = (wy * vz - wz * vy) * nx + (wz * vx - wx * vz) * ny + (wx * vy - wy * vx) * nz;
        if (at_b >= 0.0 && at_c >= 0.0 && at_b + at_c <= squared) {
            double height = wx * nx + wy * ny + wz * nz;
            return height * height / squared;
        }
    }
    double nearest = to_segment(p, a, b), second = to_segment(p, b, c), third = to_segment(p, c, a);
    nearest = second < nearest ? second : nearest;
    return third < nearest ? third : nearest;
}
