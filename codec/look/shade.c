/* A picture of a mesh, from one side: a depth buffer, and shades from normals that are interpolated over faces. */
#include "codec/look/shade.h"

#define AMBIENT 0.12f
#define DIFFUSE 0.78f
#define BACKGROUND 1.0f
#define CAMERA 15 /* three rows of a rotation with an offset each, then the light in the mesh's own axes */

/* The first pixel whose centre is at `x` or behind, in 0..size. */
INLINE int64_t first_centre(double x, int64_t size) {
    double start = x - 0.5;
    if (!(start > 0.0)) return 0;
    if (start >= (double)size) return size;
    int64_t pixel = (int64_t)start;
    return pixel + ((double)pixel < start);
}

/* Behind the last pixel whose centre is at `x` or before, in 0..size. */
INLINE int64_t behind_centre(double x, int64_t size) {
    double end = x + 0.5;
    if (!(end > 0.0)) return 0;
    return end >= (double)size ? size : (int64_t)end;
}

INLINE double within(double x) { return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0; }

typedef struct {
    double x, y, slope;
} Edge;

/* From its upper end, so that faces on both sides of an edge cross each row at the same place. */
INLINE Edge edge_between(const double *upper, const double *lower) {
    double rise = lower[1] - upper[1];
    Edge edge = {upper[0], upper[1], rise > 0.0 ? (lower[0] - upper[0]) / rise : 0.0};
    return edge;
}

INLINE double crossing(Edge edge, double y) { return edge.x + (y - edge.y) * edge.slope; }

INLINE void swap_if_lower(const double **a, const double **b) {
    if ((*a)[1] > (*b)[1]) {
        const double *kept = *a;
        *a = *b;
        *b = kept;
    }
}

INLINE void draw_face(const double *a, const double *b, const double *c, const float *normals, const double *light,
                      int32_t face, Singles2 depth, Singles2 lengths, Singles2 picture, Ints2 owner) {
    double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (!(area > 0.0 || area < 0.0)) return;
    const double *top = a, *middle = b, *bottom = c;
    swap_if_lower(&top, &middle);
    swap_if_lower(&middle, &bottom);
    swap_if_lower(&top, &middle);
    int64_t first = first_centre(top[1], picture.rows), end = behind_centre(bottom[1], picture.rows);
    if (first >= end) return;
    double left = a[0] < b[0] ? a[0] : b[0], right = a[0] < b[0] ? b[0] : a[0];
    left = left < c[0] ? left : c[0];
    right = right < c[0] ? c[0] : right;
    if (first_centre(left, picture.columns) >= behind_centre(right, picture.columns)) return;
    Edge whole = edge_between(top, bottom), upper = edge_between(top, middle), lower = edge_between(middle, bottom);
    double inverse = 1.0 / area, bx = b[0] - a[0], by = b[1] - a[1], cx = c[0] - a[0], cy = c[1] - a[1];
    double bz = b[2] - a[2], cz = c[2] - a[2];
    const float *n = normals;
    for (int64_t row = first; row < end; row++) {
        double y = (double)row + 0.5;
        double from = crossing(whole, y), to = y < middle[1] ? crossing(upper, y) : crossing(lower, y);
        int64_t column = first_centre(from < to ? from : to, picture.columns);
        int64_t stop = behind_centre(from < to ? to : from, picture.columns);
        for (; column < stop; column++) {
            double x = (double)column + 0.5;
            double s = within(((x - a[0]) * cy - (y - a[1]) * cx) * inverse);
            double r = within((bx * (y - a[1]) - by * (x - a[0])) * inverse);
            int64_t pixel = row * picture.columns + column;
            float z = (float)(a[2] + s * bz + r * cz);
            if (!(z > depth.data[pixel])) continue;
            double q = 1.0 - s - r;
            double nx = q * (double)n[0] + s * (double)n[3] + r * (double)n[6];
            double ny = q * (double)n[1] + s * (double)n[4] + r * (double)n[7];
            double nz = q * (double)n[2] + s * (double)n[5] + r * (double)n[8];
            if (owner.rows) owner.data[pixel] = face;
            depth.data[pixel] = z;
            picture.data[pixel] = (float)(nx * light[0] + ny * light[1] + nz * light[2]);
            lengths.data[pixel] = (float)(nx * nx + ny * ny + nz * nz);
        }
    }
}

/* `camera` takes a position to column, row and depth (larger is nearer), four numbers each, and holds the light.
 * `placed` is room for all positions, `depth` and `lengths` for pictures. `owner` has the face that each pixel shows, or
 * -1; it may be empty. */
int64_t draw_shaded(ConstDoubles2 positions, ConstInts2 faces, ConstSingles2 normals, ConstDoubles camera,
                    Doubles2 placed, Singles2 depth, Singles2 lengths, Singles2 picture, Ints2 owner) {
    int64_t pixels = picture.rows * picture.columns;
    if (positions.columns != 3 || placed.columns != 3 || placed.rows < positions.rows || faces.columns != 3 ||
        normals.columns != 9 || normals.rows < faces.rows || camera.size != CAMERA || (owner.rows && owner.rows * owner.columns < pixels) ||
        depth.rows * depth.columns < pixels || lengths.rows * lengths.columns < pixels)
        return MISUSED;
    for (int64_t k = 0; k < 3 * faces.rows; k++)
        if (faces.data[k] < 0 || faces.data[k] >= positions.rows) return MISUSED;
    const double *m = camera.data;
    for (int64_t v = 0; v < positions.rows; v++) {
        const double *p = positions.data + 3 * v;
        for (int d = 0; d < 3; d++)
            placed.data[3 * v + d] = m[4 * d] * p[0] + m[4 * d + 1] * p[1] + m[4 * d + 2] * p[2] + m[4 * d + 3];
    }
    for (int64_t i = 0; i < pixels; i++) {
        depth.data[i] = -__builtin_inff();
        if (owner.rows) owner.data[i] = -1;
    }
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        draw_face(placed.data + 3 * (int64_t)face[0], placed.data + 3 * (int64_t)face[1],
                  placed.data + 3 * (int64_t)face[2], normals.data + 9 * f, m + 12, (int32_t)f, depth, lengths, picture,
                  owner);
    }
    for (int64_t i = 0; i < pixels; i++) {
        float length = lengths.data[i], facing = picture.data[i];
        float cosine = length > 1e-24f ? __builtin_fabsf(facing) / __builtin_sqrtf(length) : 0.0f;
        picture.data[i] = depth.data[i] == -__builtin_inff() ? BACKGROUND : AMBIENT + DIFFUSE * cosine;
    }
    return 0;
}
