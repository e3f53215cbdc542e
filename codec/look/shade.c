/* A picture of a mesh, from one side: a depth buffer, and shades from normals that are interpolated over faces. */
#include "codec/look/look.h"

#define AMBIENT 0.12f
#define DIFFUSE 0.78f
#define DARK 1e-24f /* the squared length of a normal that is none */
#define BACKGROUND 1.0f
#define TILE 8    /* pixels of the side of squares that faces may be hidden in */
#define SAMPLE 4096 /* faces that tell which half is ahead */
#define LANES 8   /* pixels of a row that are drawn at once */
#define EACH_LANE _Pragma("GCC unroll 1") for (int k = 0; k < LANES; k++) /* as vectors */
#define CAMERA 15 /* three rows of a rotation with an offset each, then the light in the mesh's own axes */

/* The first pixel whose center is at `x` or behind, in 0..size. */
INLINE int64_t first_center(double x, int64_t size) {
    double start = x - 0.5;
    if (!(start > 0.0)) return 0;
    if (start >= (double)size) return size;
    int64_t pixel = (int64_t)start;
    return pixel + ((double)pixel < start);
}

/* Behind the last pixel whose center is at `x` or before, in 0..size. */
INLINE int64_t behind_center(double x, int64_t size) {
    double end = x + 0.5;
    if (!(end > 0.0)) return 0;
    return end >= (double)size ? size : (int64_t)end;
}

/* Depths are whole numbers, so that faces at one place are at one depth, whatever their corners. */
INLINE float depth_of(double z) { return (float)__builtin_rint(z); }

INLINE float shade_of(float facing, float length) {
    return AMBIENT + DIFFUSE * (length > DARK ? __builtin_fabsf(facing) / __builtin_sqrtf(length) : 0.0f);
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

INLINE double lower(double a, double b) { return a < b ? a : b; }
INLINE double higher(double a, double b) { return a > b ? a : b; }

typedef struct {
    const double *a, *b, *c;
    double area;
} Face;

INLINE Face face_at(const double *placed, const int32_t *corners) {
    const double *a = placed + 3 * (int64_t)corners[0], *b = placed + 3 * (int64_t)corners[1],
                 *c = placed + 3 * (int64_t)corners[2];
    return (Face){a, b, c, (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])};
}

INLINE int64_t tile_at(double x, int64_t tiles) { return least((int64_t)(higher(x, 0.0) * (1.0 / TILE)), tiles - 1); }

/* Whether something nearer than all of a face is at every pixel of the tiles that it touches. */
INLINE bool hidden(Face face, ConstSingles2 farthest) {
    const double *a = face.a, *b = face.b, *c = face.c;
    int64_t first = tile_at(lower(lower(a[1], b[1]), c[1]), farthest.rows);
    int64_t last = tile_at(higher(higher(a[1], b[1]), c[1]), farthest.rows);
    int64_t from = tile_at(lower(lower(a[0], b[0]), c[0]), farthest.columns);
    int64_t to = tile_at(higher(higher(a[0], b[0]), c[0]), farthest.columns);
    float nearest = depth_of(a[2] + higher(b[2] - a[2], 0.0) + higher(c[2] - a[2], 0.0));
    bool behind = true;
    for (int64_t row = first; row <= last && behind; row++) {
        const float *tiles = farthest.data + row * farthest.columns;
        behind = (nearest < tiles[from]) & (nearest < tiles[to]);
        for (int64_t column = from + 1; column < to; column++) behind &= nearest < tiles[column];
    }
    return behind;
}

/* `LANES` pixels of a row from `x` on, as those of `draw_face` one by one; false, and nothing is drawn, where one of
 * them is as near as what is there. */
INLINE bool draw_lanes(Face face, double inverse, const float *n, const double *light, int32_t number, double x,
                       double y, float *restrict depths, float *restrict lengths, float *restrict facings,
                       int32_t *restrict owners) {
    const double *a = face.a, *b = face.b, *c = face.c;
    double bx = b[0] - a[0], by = b[1] - a[1], cx = c[0] - a[0], cy = c[1] - a[1];
    double ax = a[0], az = a[2], bz = b[2] - a[2], cz = c[2] - a[2], down = y - a[1], s[LANES], r[LANES];
    float z[LANES], facing[LANES], length[LANES];
    int32_t any = 0, ties = 0;
    EACH_LANE {
        double across = (x + (double)k) - ax;
        s[k] = within((across * cy - down * cx) * inverse);
        r[k] = within((bx * down - by * across) * inverse);
        z[k] = depth_of(az + s[k] * bz + r[k] * cz);
    }
    EACH_LANE {
        any |= z[k] > depths[k];
        ties |= z[k] == depths[k];
    }
    if (ties) return false;
    if (!any) return true;
    EACH_LANE {
        double q = 1.0 - s[k] - r[k];
        double nx = q * (double)n[0] + s[k] * (double)n[3] + r[k] * (double)n[6];
        double ny = q * (double)n[1] + s[k] * (double)n[4] + r[k] * (double)n[7];
        double nz = q * (double)n[2] + s[k] * (double)n[5] + r[k] * (double)n[8];
        facing[k] = (float)(nx * light[0] + ny * light[1] + nz * light[2]);
        length[k] = (float)(nx * nx + ny * ny + nz * nz);
    }
    EACH_LANE {
        bool shown = z[k] > depths[k];
        depths[k] = shown ? z[k] : depths[k];
        facings[k] = shown ? facing[k] : facings[k];
        lengths[k] = shown ? length[k] : lengths[k];
        owners[k] = shown ? number : owners[k];
    }
    return true;
}

INLINE void draw_face(Face face, const float *normals, const double *light, int32_t number, Singles2 depth,
                      Singles2 lengths, Singles2 picture, Ints2 owner) {
    const double *a = face.a, *b = face.b, *c = face.c;
    int64_t first = first_center(lower(lower(a[1], b[1]), c[1]), picture.rows);
    int64_t end = behind_center(higher(higher(a[1], b[1]), c[1]), picture.rows);
    if (first >= end) return;
    if (first_center(lower(lower(a[0], b[0]), c[0]), picture.columns) >=
        behind_center(higher(higher(a[0], b[0]), c[0]), picture.columns))
        return;
    /* Without branches, which nobody could foretell. */
    const double *above = a[1] > b[1] ? b : a, *below = a[1] > b[1] ? a : b;
    const double *bottom = below[1] > c[1] ? below : c, *rest = below[1] > c[1] ? c : below;
    const double *top = above[1] > rest[1] ? rest : above, *middle = above[1] > rest[1] ? above : rest;
    Edge whole = edge_between(top, bottom), upper = edge_between(top, middle), beneath = edge_between(middle, bottom);
    double inverse = 1.0 / face.area, bx = b[0] - a[0], by = b[1] - a[1], cx = c[0] - a[0], cy = c[1] - a[1];
    double bz = b[2] - a[2], cz = c[2] - a[2];
    const float *n = normals;
    for (int64_t row = first; row < end; row++) {
        double y = (double)row + 0.5;
        double from = crossing(whole, y), to = y < middle[1] ? crossing(upper, y) : crossing(beneath, y);
        int64_t column = first_center(from < to ? from : to, picture.columns);
        int64_t stop = behind_center(from < to ? to : from, picture.columns);
        int64_t alone = column; /* up to there pixels are drawn one by one */
        while (column < stop) {
            double x = (double)column + 0.5;
            int64_t pixel = row * picture.columns + column;
            if (stop - column >= LANES && column >= alone) {
                alone = column + LANES;
                if (draw_lanes(face, inverse, n, light, number, x, y, depth.data + pixel, lengths.data + pixel,
                               picture.data + pixel, owner.data + pixel)) {
                    column = alone;
                    continue;
                }
            }
            column++;
            double s = within(((x - a[0]) * cy - (y - a[1]) * cx) * inverse);
            double r = within((bx * (y - a[1]) - by * (x - a[0])) * inverse);
            float z = depth_of(a[2] + s * bz + r * cz);
            if (!(z >= depth.data[pixel])) continue;
            double q = 1.0 - s - r;
            double nx = q * (double)n[0] + s * (double)n[3] + r * (double)n[6];
            double ny = q * (double)n[1] + s * (double)n[4] + r * (double)n[7];
            double nz = q * (double)n[2] + s * (double)n[5] + r * (double)n[8];
            float facing = (float)(nx * light[0] + ny * light[1] + nz * light[2]);
            float length = (float)(nx * nx + ny * ny + nz * nz);
            if (z == depth.data[pixel]) {
                float facing_before = picture.data[pixel], length_before = lengths.data[pixel];
                if (facing == facing_before && length == length_before) continue; /* drawn again: skip */
                if (!(shade_of(facing, length) > shade_of(facing_before, length_before))) continue;
            }
            owner.data[pixel] = number;
            depth.data[pixel] = z;
            picture.data[pixel] = facing;
            lengths.data[pixel] = length;
        }
    }
}

/* The farthest depth in each tile. */
INLINE void find_farthest(Singles2 depth, Singles2 farthest) {
    for (int64_t i = 0; i < farthest.rows * farthest.columns; i++) farthest.data[i] = __builtin_inff();
    for (int64_t row = 0; row < depth.rows; row++) {
        float *tiles = farthest.data + row / TILE * farthest.columns;
        const float *depths = depth.data + row * depth.columns;
        for (int64_t first = 0; first < depth.columns; first += TILE, tiles++)
            for (int64_t i = first; i < least(first + TILE, depth.columns); i++)
                *tiles = depths[i] < *tiles ? depths[i] : *tiles;
    }
}

/* `camera` takes a position to column, row and depth (larger is nearer), four numbers each, and holds the light; of
 * what is at one depth the brightest is shown. `placed` is room for all positions, `depth` and `lengths` for pictures,
 * `farthest` for one number of each tile. `owner` gets the face that each pixel shows, or -1.
 *
 * Of a closed surface one half faces the camera, and hides the other: that half comes first, and most of the other one
 * need not be drawn. */
KERNEL int64_t draw_shaded(ConstDoubles2 positions, ConstInts2 faces, ConstSingles2 normals, ConstDoubles camera,
                           Doubles2 placed, Singles2 depth, Singles2 lengths, Singles2 farthest, Singles2 picture,
                           Ints2 owner) {
    int64_t pixels = picture.rows * picture.columns;
    if (positions.columns != 3 || placed.columns != 3 || placed.rows < positions.rows || faces.columns != 3 ||
        normals.columns != 9 || normals.rows < faces.rows || camera.size != CAMERA || faces.rows > INT32_MAX ||
        owner.rows * owner.columns < pixels || depth.rows != picture.rows || depth.columns != picture.columns ||
        lengths.rows * lengths.columns < pixels || farthest.rows * TILE < picture.rows ||
        farthest.columns * TILE < picture.columns)
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
        depth.data[i] = -__FLT_MAX__;
        owner.data[i] = -1;
    }
    double ahead = 0.0;
    for (int64_t f = 0; f < faces.rows; f += 1 + faces.rows / SAMPLE) {
        Face face = face_at(placed.data, faces.data + 3 * f);
        ahead += face.area * (face.a[2] + face.b[2] + face.c[2]);
    }
    ConstSingles2 behind = {farthest.data, farthest.rows, farthest.columns};
    for (int pass = 0; pass < 2; pass++) {
        if (pass) find_farthest(depth, farthest);
        bool positive = (ahead > 0.0) != (pass > 0);
        for (int64_t f = 0; f < faces.rows; f++) {
            Face face = face_at(placed.data, faces.data + 3 * f);
            if (!(positive ? face.area > 0.0 : face.area < 0.0) || (pass && hidden(face, behind))) continue;
            draw_face(face, normals.data + 9 * f, m + 12, (int32_t)f, depth, lengths, picture, owner);
        }
    }
    int64_t columns = picture.columns;
    for (int64_t row = 0; row < picture.rows; row++) { /* as `shade_of`, in loops without branches */
        float *squares = lengths.data + row * columns, *shades = picture.data + row * columns;
        for (int64_t i = 0; i < columns; i++) {
            float square = squares[i] > DARK ? squares[i] : __builtin_inff();
            shades[i] = AMBIENT + DIFFUSE * (__builtin_fabsf(shades[i]) / __builtin_sqrtf(square));
        }
        for (int64_t i = 0; i < columns; i++) shades[i] = owner.data[row * columns + i] < 0 ? BACKGROUND : shades[i];
    }
    return 0;
}

/* What corners have, three times as many as `found` has rows in `values`, at each pixel that shows a face. `ways` has
 * of a face where its first corner is, and what a pixel's way from there is of the ways to both others: column, row,
 * then two factors of either. */
KERNEL int64_t interpolate_shown(ConstInts2 owner, ConstDoubles2 ways, ConstDoubles2 values, Doubles2 found) {
    int64_t count = 0, each = found.rows;
    if (ways.columns != 6 || values.rows != ways.rows || values.columns != 3 * each) return MISUSED;
    for (int64_t row = 0; row < owner.rows; row++)
        for (int64_t column = 0; column < owner.columns; column++) {
            int64_t face = owner.data[row * owner.columns + column];
            if (face < 0) continue;
            if (face >= ways.rows || count >= found.columns) return MISUSED;
            const double *way = ways.data + 6 * face, *first = values.data + 3 * each * face;
            double x = (double)column + 0.5 - way[0], y = (double)row + 0.5 - way[1];
            double s = within(x * way[2] + y * way[3]), r = within(x * way[4] + y * way[5]);
            for (int64_t k = 0; k < each; k++)
                found.data[k * found.columns + count] =
                    first[k] + s * (first[each + k] - first[k]) + r * (first[2 * each + k] - first[k]);
            count++;
        }
    return count == found.columns ? 0 : MISUSED;
}
