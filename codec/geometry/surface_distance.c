/* Exact distances from points to the nearest of many triangles, by a tree of bounding boxes. */
#include "codec/geometry/geometry.h"

enum { LEAF = 4, DEPTH = 128 };

typedef struct {
    int64_t begin, end, parent;
} Range;

/* Put those boxes into the first half of `order[0 .. size - 1]` whose middles along one axis are the lower ones. */
static void halve_by_middle(int64_t *order, int64_t size, const double *low, const double *high, int axis) {
    for (int64_t begin = 0, end = size - 1, half = size / 2; begin < end;) {
        int64_t pivot = 3 * order[begin + (end - begin) / 2] + axis, i = begin, j = end;
        double middle = low[pivot] + high[pivot];
        while (i <= j) {
            while (low[3 * order[i] + axis] + high[3 * order[i] + axis] < middle) i++;
            while (low[3 * order[j] + axis] + high[3 * order[j] + axis] > middle) j--;
            if (i > j) break;
            int64_t swapped = order[i];
            order[i++] = order[j];
            order[j--] = swapped;
        }
        if (half <= j)
            end = j;
        else if (half >= i)
            begin = i;
        else
            return;
    }
}

/* Split the boxes at the median of their widest axis until few are left; nodes in pre-order. The first child of node k
 * is k + 1; `first[k]` is its other child (count 0) or its first triangle (count > 0). Returns the number of nodes, at
 * most 2 m + 1. */
int64_t build_tree(ConstDoubles2 lowest, ConstDoubles2 highest, Longs order, Doubles2 low,
                   Doubles2 high, Longs first, Longs count) {
    Range stack[DEPTH];
    int64_t nodes = 0, size = lowest.rows;
    for (int64_t i = 0; i < size; i++) order.data[i] = i;
    stack[0] = (Range){0, size, -1};
    for (int depth = 1; depth > 0;) {
        Range range = stack[--depth];
        int64_t node = nodes++;
        double *bottom = low.data + 3 * node, *top = high.data + 3 * node;
        if (range.parent >= 0) first.data[range.parent] = node;
        first.data[node] = range.begin;
        count.data[node] = 0;
        for (int axis = 0; axis < 3; axis++) {
            bottom[axis] = __builtin_inf();
            top[axis] = -__builtin_inf();
            for (int64_t k = range.begin; k < range.end; k++) {
                double a = lowest.data[3 * order.data[k] + axis], b = highest.data[3 * order.data[k] + axis];
                if (a < bottom[axis]) bottom[axis] = a;
                if (b > top[axis]) top[axis] = b;
            }
        }
        if (range.end - range.begin <= LEAF) {
            count.data[node] = range.end - range.begin;
            continue;
        }
        int widest = 0;
        for (int axis = 1; axis < 3; axis++)
            if (top[axis] - bottom[axis] > top[widest] - bottom[widest]) widest = axis;
        halve_by_middle(order.data + range.begin, range.end - range.begin, lowest.data, highest.data, widest);
        int64_t middle = (range.begin + range.end) / 2;
        stack[depth++] = (Range){middle, range.end, node};
        stack[depth++] = (Range){range.begin, middle, -1};
    }
    return nodes;
}

INLINE double square(double x) { return x * x; }

/* Squared distance from a point to a box. */
INLINE double to_box(const double *p, const double *low, const double *high) {
    double total = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        double below = low[axis] - p[axis], above = p[axis] - high[axis];
        double beyond = below > above ? below : above;
        if (beyond > 0.0) total += beyond * beyond;
    }
    return total;
}

static double to_segment(const double *p, const double *a, const double *b) {
    double length = 0.0, along = 0.0, total = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        length += square(b[axis] - a[axis]);
        along += (b[axis] - a[axis]) * (p[axis] - a[axis]);
    }
    double t = length > 0.0 ? along / length : 0.0;
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    for (int axis = 0; axis < 3; axis++) total += square(a[axis] + t * (b[axis] - a[axis]) - p[axis]);
    return total;
}

/* Squared distance: to the plane where the foot lies inside, otherwise to the nearest edge. */
static double to_triangle(const double *p, const double *triangle) {
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

/* Squared distance from a point to the nearest triangle, or any that is at most `enough`; `found` is where the triangle
 * stands that the search begins with, and then the one that was found. */
static double nearest(const double *p, ConstDoubles2 triangles, ConstDoubles2 low, ConstDoubles2 high, ConstLongs first,
                      ConstLongs count, double enough, int64_t *found) {
    int64_t stack[DEPTH];
    double best = to_triangle(p, triangles.data + 9 * *found);
    stack[0] = 0;
    for (int depth = 1; depth > 0 && best > enough;) {
        int64_t node = stack[--depth];
        if (to_box(p, low.data + 3 * node, high.data + 3 * node) >= best) continue;
        if (count.data[node] > 0) {
            for (int64_t k = first.data[node]; k < first.data[node] + count.data[node]; k++) {
                double squared = to_triangle(p, triangles.data + 9 * k);
                if (squared >= best) continue;
                best = squared;
                *found = k;
            }
            continue;
        }
        int64_t near = node + 1, far = first.data[node];
        if (to_box(p, low.data + 3 * near, high.data + 3 * near) >
            to_box(p, low.data + 3 * far, high.data + 3 * far)) {
            near = far;
            far = node + 1;
        }
        stack[depth++] = far;
        stack[depth++] = near;
    }
    return best;
}

/* Distance of each point to the nearest triangle; `triangles` has nine numbers a row, in the order of the tree. */
void nearest_distances(ConstDoubles2 points, ConstDoubles2 triangles, ConstDoubles2 low, ConstDoubles2 high,
                       ConstLongs first, ConstLongs count, Doubles distances) {
    int64_t found = 0;
    for (int64_t i = 0; i < least(points.rows, distances.size); i++)
        distances.data[i] = __builtin_sqrt(nearest(points.data + 3 * i, triangles, low, high, first, count, 0.0, &found));
}

/* The largest of these distances: what is nearer than the largest so far need not be known exactly. */
double farthest_distance(ConstDoubles2 points, ConstDoubles2 triangles, ConstDoubles2 low, ConstDoubles2 high,
                         ConstLongs first, ConstLongs count) {
    int64_t found = 0;
    double most = 0.0;
    for (int64_t i = 0; i < points.rows; i++) {
        double squared = nearest(points.data + 3 * i, triangles, low, high, first, count, most, &found);
        most = squared > most ? squared : most;
    }
    return __builtin_sqrt(most);
}
