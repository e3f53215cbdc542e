/* Normals of faces, and the geometric Laplacian of NMSVE (paper, section 8). */
#include "codec/geometry/geometry.h"

/* Each vertex minus the mean of its neighbors, weighted by inverse distance; zero beside a neighbor at distance 0. */
void geometric_laplacian(ConstDoubles2 positions, Lists neighbors, Doubles2 result) {
    for (int64_t i = 0; i < positions.rows; i++) {
        const double *own = positions.data + 3 * i;
        double sum[3] = {0.0, 0.0, 0.0}, total = 0.0;
        for (int64_t k = neighbors.starts.data[i]; k < neighbors.starts.data[i + 1]; k++) {
            const double *other = positions.data + 3 * (int64_t)neighbors.members.data[k];
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

/* Centroids, areas and unit normals; the normal of a face without area is zero. To `whole`, if it has any room: whether
 * normals are not rounding alone, as `weighted_angle` tells. */
void face_geometry(
    ConstDoubles2 positions, ConstInts2 faces, Doubles2 centroids, Doubles areas, Doubles2 normals, Bytes whole) {
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        const double *a = positions.data + 3 * (int64_t)face[0], *b = positions.data + 3 * (int64_t)face[1];
        const double *c = positions.data + 3 * (int64_t)face[2];
        double cross[3];
        cross3(a, b, c, cross);
        double length = __builtin_sqrt(dot3(cross, cross)), by = length > 0.0 ? length : 1.0;
        areas.data[f] = 0.5 * length;
        double x = apart(a, b), y = apart(b, c), z = apart(c, a), most = x * y > y * z ? x * y : y * z;
        if (whole.size) whole.data[f] = length > 1e-9 * __builtin_sqrt(z * x > most ? z * x : most);
        for (int64_t j = 0; j < 3; j++) {
            normals.data[3 * f + j] = cross[j] / by;
            centroids.data[3 * f + j] = (a[j] + b[j] + c[j]) / 3.0;
        }
    }
}

/* Arc sine of x in 0 .. 1, to 1e-9: its series up to 1/2, and beyond that by half the complement. */
INLINE double arc_sine(double x) {
    static const double terms[TERMS] = {
        1.0, 1.0 / 6, 3.0 / 40, 5.0 / 112, 35.0 / 1152, 63.0 / 2816, 231.0 / 13312, 143.0 / 10240, 6435.0 / 557056,
        12155.0 / 1245184, 46189.0 / 5505024, 88179.0 / 12058624, 676039.0 / 104857600,
    };
    double small = x > 0.5 ? __builtin_sqrt((1.0 - x) * 0.5) : x, square = small * small, sum = terms[TERMS - 1];
    for (int k = TERMS - 1; k-- > 0;) sum = sum * square + terms[k];
    sum *= small;
    return x > 0.5 ? 1.5707963267948966 - 2.0 * sum : sum;
}

/* Sum over faces of weight times angle (radians) between a unit normal and the decoded face's; `lost` for a decoded
 * face so flat that its normal is rounding alone: the angle of its two longest edges has a sine below 1e-9. */
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
            double w0 = v0 - u0, w1 = v1 - u1, w2 = v2 - u2;
            double uu = u0 * u0 + u1 * u1 + u2 * u2, vv = v0 * v0 + v1 * v1 + v2 * v2, ww = w0 * w0 + w1 * w1 + w2 * w2;
            double sides = (uu > vv ? uu : vv) * ww > uu * vv ? (uu > vv ? uu : vv) * ww : uu * vv;
            bool whole = length > 1e-9 * __builtin_sqrt(sides);
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

/* Exact distances from points to the nearest of many triangles, by a tree of bounding boxes. */
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
        if (half > j && half < i) return;
        if (half <= j) end = j;
        if (half >= i) begin = i;
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

/* Squared distance from a point to the nearest triangle, or any that is at most `enough`; `found` is where the triangle
 * stands that the search begins with, and then the one that was found. */
static double nearest(const double *p, const Tree *tree, double enough, int64_t *found) {
    int64_t stack[DEPTH];
    const double *low = tree->low.data, *high = tree->high.data;
    double best = to_triangle(p, tree->triangles.data + 9 * *found);
    stack[0] = 0;
    /* A tree that halves is never so deep; what lies deeper in another one is left out. */
    for (int depth = 1; depth > 0 && depth < DEPTH - 1 && best > enough;) {
        int64_t node = stack[--depth];
        int64_t first = tree->first.data[node], count = tree->count.data[node];
        if (to_box(p, low + 3 * node, high + 3 * node) >= best) continue;
        if (count > 0) {
            for (int64_t k = first; k < first + count; k++) {
                double squared = to_triangle(p, tree->triangles.data + 9 * k);
                if (squared < best) best = squared, *found = k;
            }
            continue;
        }
        int64_t one = node + 1, two = first;
        bool nearer = to_box(p, low + 3 * one, high + 3 * one) <= to_box(p, low + 3 * two, high + 3 * two);
        stack[depth++] = nearer ? two : one;
        stack[depth++] = nearer ? one : two;
    }
    return best;
}

/* The largest distance of a point to the nearest triangle, and all of them if `distances` has room: exact where above
 * the number that it held; else smaller ones need not be exact; `which`, if it has room, gets the nearest triangles. */
double nearest_distances(ConstDoubles2 points, Tree tree, Doubles distances, Longs which) {
    int64_t found = 0;
    double most = 0.0;
    for (int64_t i = 0; i < points.rows; i++) {
        double enough = i < distances.size ? distances.data[i] * distances.data[i] : most;
        double squared = nearest(points.data + 3 * i, &tree, enough, &found);
        most = squared > most ? squared : most;
        if (i < distances.size) distances.data[i] = __builtin_sqrt(squared);
        if (i < which.size) which.data[i] = tree.order.data[found];
    }
    return __builtin_sqrt(most);
}
