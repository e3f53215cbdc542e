/* A picture of a mesh, from one side: a depth buffer, and shades from normals that are interpolated over faces. */
#include "codec/geometry/geometry.h"
#include "codec/look/look.h"

#define DARK 1e-24f /* the squared length of a normal that is none */
#define FAR 1e6     /* a place in samples, within which sums are exact to far less than one */
#define NEAR 6.0f /* depths that rounding may put between faces at one place */
#define TILE 8    /* pixels of the side of squares that faces may be hidden in */
#define SAMPLE 4096 /* faces that tell which half is ahead */
#define LANES 8   /* faces, or rows, that are prepared side by side */
#define SPAN 4    /* pixels that are drawn side by side */
#define EACH_LANE _Pragma("GCC unroll 1") for (int k = 0; k < LANES; k++) /* as vectors */
#define CAMERA 15 /* three rows of a rotation with an offset each, then the light in the mesh's own axes */
#define WHOLE 6755399441055744.0 /* 1.5 * 2^52: a sum with it ends in the nearest whole number */

/* The whole number at `x` or below, of less than 2^51. */
INLINE double floor_of(double x) {
    double nearest = (x + WHOLE) - WHOLE;
    return nearest - (nearest > x ? 1.0 : 0.0);
}

INLINE double clamped(double x, double most) {
    x = x > 0.0 ? x : 0.0;
    return x < most ? x : most;
}

/* The first pixel whose center is at `x` or behind, and behind the last one at `x` or before, in 0..size. */
INLINE double first_center(double x, double size) { return -floor_of(-clamped(x - 0.5, size)); }
INLINE double behind_center(double x, double size) { return floor_of(clamped(x + 0.5, size)); }

/* Depths are whole numbers, so that faces at one place are at one depth, whatever their corners. */
INLINE float depth_of(double z) { return (float)((z + WHOLE) - WHOLE); }

INLINE double within(double x) { return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0; }

INLINE double lower(double a, double b) { return a < b ? a : b; }
INLINE double higher(double a, double b) { return a > b ? a : b; }

typedef struct {
    const double *placed;
    const int32_t *faces;
    const float *normals;
    const double *light;
} Model;

typedef struct {
    const double *a, *b, *c;
    double area;
} Face;

INLINE Face face_at(Model model, int64_t number) {
    const int32_t *corners = model.faces + 3 * number;
    const double *a = model.placed + 3 * (int64_t)corners[0], *b = model.placed + 3 * (int64_t)corners[1],
                 *c = model.placed + 3 * (int64_t)corners[2];
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
    float nearest = depth_of(a[2] + higher(b[2] - a[2], 0.0) + higher(c[2] - a[2], 0.0)) + NEAR;
    bool behind = true;
    for (int64_t row = first; row <= last && behind; row++) {
        const float *tiles = farthest.data + row * farthest.columns;
        behind = (nearest < tiles[from]) & (nearest < tiles[to]);
        for (int64_t column = from + 1; column < to; column++) behind &= nearest < tiles[column];
    }
    return behind;
}

/* Faces side by side: their edges from the upper ends, so that faces on both sides of one cross each row at the same
 * place, and the rows and columns that they have pixels in. */
typedef struct {
    double inverse[LANES], top_x[LANES], top_y[LANES], middle_x[LANES], middle_y[LANES];
    double whole[LANES], upper[LANES], beneath[LANES], first[LANES], end[LANES], left[LANES], right[LANES];
} Batch;

INLINE double slope_of(double across, double rise) {
    double slope = across / rise;
    return rise > 0.0 ? slope : 0.0;
}

INLINE void prepare(Model model, const int32_t *numbers, Canvas on, Batch *g) {
    double corner[6][LANES], rows = (double)on.picture.rows, columns = (double)on.picture.columns;
    for (int k = 0; k < LANES; k++)
        for (int i = 0; i < 3; i++) {
            const double *at = model.placed + 3 * (int64_t)model.faces[3 * (int64_t)numbers[k] + i];
            corner[2 * i][k] = at[0];
            corner[2 * i + 1][k] = at[1];
        }
    EACH_LANE {
        double ax = corner[0][k], ay = corner[1][k], bx = corner[2][k], by = corner[3][k], cx = corner[4][k],
               cy = corner[5][k];
        double above_x = ay > by ? bx : ax, above_y = ay > by ? by : ay;
        double below_x = ay > by ? ax : bx, below_y = ay > by ? ay : by;
        double bottom_x = below_y > cy ? below_x : cx, bottom_y = below_y > cy ? below_y : cy;
        double rest_x = below_y > cy ? cx : below_x, rest_y = below_y > cy ? cy : below_y;
        double top_x = above_y > rest_y ? rest_x : above_x, top_y = above_y > rest_y ? rest_y : above_y;
        double middle_x = above_y > rest_y ? above_x : rest_x, middle_y = above_y > rest_y ? above_y : rest_y;
        g->inverse[k] = 1.0 / ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax));
        g->top_x[k] = top_x, g->top_y[k] = top_y, g->middle_x[k] = middle_x, g->middle_y[k] = middle_y;
        g->whole[k] = slope_of(bottom_x - top_x, bottom_y - top_y);
        g->upper[k] = slope_of(middle_x - top_x, middle_y - top_y);
        g->beneath[k] = slope_of(bottom_x - middle_x, bottom_y - middle_y);
        g->left[k] = first_center(lower(lower(ax, bx), cx), columns);
        g->right[k] = behind_center(higher(higher(ax, bx), cx), columns);
        g->first[k] = first_center(top_y, rows);
        g->end[k] = behind_center(bottom_y, rows);
    }
}

typedef struct {
    double from, to;
} PixelRange;

/* The pixels of a row at `y` that are inside face `k`. */
INLINE PixelRange crossed(const Batch *g, int k, double y, double size) {
    double one = g->top_x[k] + (y - g->top_y[k]) * g->whole[k];
    double above = g->top_x[k] + (y - g->top_y[k]) * g->upper[k];
    double below = g->middle_x[k] + (y - g->middle_y[k]) * g->beneath[k];
    double other = y < g->middle_y[k] ? above : below;
    return (PixelRange){first_center(one < other ? one : other, size), behind_center(one < other ? other : one, size)};
}

/* The pixels of up to `rows` rows of each face, and how many they are. */
INLINE void cover(const Batch *g, int rows, double size, double (*from)[LANES], double (*to)[LANES], double *inside) {
    EACH_LANE inside[k] = 0.0;
    for (int j = 0; j < rows; j++)
        EACH_LANE {
            double y = g->first[k] + (double)j + 0.5;
            PixelRange span = crossed(g, k, y, size);
            from[j][k] = span.from;
            to[j][k] = y < g->end[k] ? span.to : 0.0;
            inside[k] += higher(to[j][k] - from[j][k], 0.0);
        }
}

/* What a face shows at a place from its first corner on: its depth, and how much of its normal is along the light, are
 * sums of a constant and parts of both coordinates. The squared length of the normal has parts of squares, too. */
typedef struct {
    double at[2], low, high, depth[3], facing[3], length[6];
    int32_t number;
} ShadedPlane;

INLINE ShadedPlane plane_of(Model model, int32_t number, double inverse) {
    Face face = face_at(model, number);
    const double *a = face.a, *b = face.b, *c = face.c, *light = model.light;
    const float *normals = model.normals + 9 * (int64_t)number;
    double across[2] = {(c[1] - a[1]) * inverse, (a[1] - b[1]) * inverse};
    double down[2] = {(a[0] - c[0]) * inverse, (b[0] - a[0]) * inverse};
    double second = b[2] - a[2], third = c[2] - a[2], n[3], x[3], y[3];
    for (int d = 0; d < 3; d++) {
        n[d] = (double)normals[d];
        double one = (double)normals[3 + d] - n[d], other = (double)normals[6 + d] - n[d];
        x[d] = one * across[0] + other * across[1];
        y[d] = one * down[0] + other * down[1];
    }
    return (ShadedPlane){{a[0], a[1]},
                         a[2] + lower(lower(second, third), 0.0),
                         a[2] + higher(higher(second, third), 0.0),
                         {a[2], second * across[0] + third * across[1], second * down[0] + third * down[1]},
                         {dot3(n, light), dot3(x, light), dot3(y, light)},
                         {dot3(n, n), 2.0 * dot3(n, x), 2.0 * dot3(n, y), dot3(x, x), 2.0 * dot3(x, y), dot3(y, y)},
                         number};
}

typedef double Four __attribute__((vector_size(8 * SPAN)));
typedef int64_t FourLongs __attribute__((vector_size(8 * SPAN)));
typedef int64_t HalfLongs __attribute__((vector_size(4 * SPAN)));
typedef float FourSingles __attribute__((vector_size(4 * SPAN)));
typedef int32_t FourInts __attribute__((vector_size(4 * SPAN)));
typedef float Eight __attribute__((vector_size(4 * TILE)));
typedef int32_t EightInts __attribute__((vector_size(4 * TILE)));
typedef Eight UnalignedEight __attribute__((aligned(4), may_alias));
typedef FourSingles UnalignedSingles __attribute__((aligned(4), may_alias));
typedef FourInts UnalignedInts __attribute__((aligned(4), may_alias));

/* Each from `low` to `high`. */
INLINE Four all_within(Four x, double low, double high) {
    Four least = (Four){0.0} + low, most = (Four){0.0} + high;
    FourLongs above = x > least;
    x = (Four)((above & (FourLongs)x) | (~above & (FourLongs)least));
    FourLongs below = x < most;
    return (Four)((below & (FourLongs)x) | (~below & (FourLongs)most));
}

INLINE void keep(FourInts mask, FourInts values, void *to) {
    UnalignedInts *at = to;
    *at = (mask & values) | (~mask & *at);
}

INLINE bool any(FourInts mask) {
    HalfLongs halves = (HalfLongs)mask;
    return halves[0] | halves[1];
}

/* Draw those of `SPAN` columns whose bits are set in `inside`: depths at the centers of pixels, and shades. */
INLINE void draw_span(const ShadedPlane *plane, int64_t row, int64_t column, int32_t inside, Canvas on) {
    const double *depth = plane->depth, *light = plane->facing, *square = plane->length;
    const Four lanes = {0.5, 1.5, 2.5, 3.5};
    const FourInts bits = {1, 2, 4, 8};
    Four x = ((double)column + lanes) - plane->at[0];
    double y = (double)row + 0.5 - plane->at[1];
    /* In narrow faces, rounding errors are larger than depths and normals. */
    Four deep = all_within(depth[0] + y * depth[2] + x * depth[1], plane->low, plane->high);
    FourSingles z = __builtin_convertvector((deep + WHOLE) - WHOLE, FourSingles);
    int64_t pixel = row * on.picture.columns + column;
    FourSingles before = *(const UnalignedSingles *)(on.depth.data + pixel);
    FourInts seen = (z >= before - NEAR) & ((inside & bits) != 0), nearest = seen & (z > before);
    if (!any(seen)) return;
    double start = square[0] + y * (square[2] + y * square[5]), slope = square[1] + y * square[4];
    FourSingles facing = __builtin_convertvector(light[0] + y * light[2] + x * light[1], FourSingles);
    FourSingles length = __builtin_convertvector(start + x * (slope + x * square[3]), FourSingles);
    FourInts lit = length > DARK + facing * facing;
    for (int k = 0; k < SPAN; k++) length[k] = __builtin_sqrtf(length[k]);
    FourInts share = (FourInts)(facing / length) & lit & INT32_MAX;
    FourSingles shades = AMBIENT + DIFFUSE * (FourSingles)share;
    FourInts tied = seen & (z <= before + NEAR);
    if (any(tied)) seen &= ~tied | (shades > *(const UnalignedSingles *)(on.picture.data + pixel));
    if (on.owner.rows) keep(seen, (FourInts){0} + plane->number, on.owner.data + pixel);
    keep(nearest, (FourInts)z, on.depth.data + pixel);
    keep(seen, (FourInts)shades, on.picture.data + pixel);
}

INLINE void draw_row(const ShadedPlane *plane, int64_t row, double from, double to, Canvas on) {
    for (int64_t column = (int64_t)from; column < (int64_t)to; column += SPAN) {
        int64_t at = least(column, on.picture.columns - SPAN), last = least((int64_t)to - at, SPAN);
        draw_span(plane, row, at, (1 << last) - (1 << (column - at)), on);
    }
}

INLINE void draw_rows(const Batch *g, int at, const ShadedPlane *plane, Canvas on) {
    int64_t end = (int64_t)g->end[at];
    for (int64_t row = (int64_t)g->first[at]; row < end; row += LANES) {
        double from[LANES], to[LANES];
        EACH_LANE {
            PixelRange span = crossed(g, at, (double)row + (double)k + 0.5, (double)on.picture.columns);
            from[k] = span.from;
            to[k] = span.to;
        }
        for (int k = 0; k < LANES && row + k < end; k++) draw_row(plane, row + k, from[k], to[k], on);
    }
}

INLINE void draw_group(Model model, const int32_t *numbers, int count, Canvas on) {
    Batch g;
    double from[LANES][LANES], to[LANES][LANES], inside[LANES], most = 0.0;
    prepare(model, numbers, on, &g);
    for (int k = 0; k < LANES; k++) most = higher(most, g.end[k] - g.first[k] <= LANES ? g.end[k] - g.first[k] : 0.0);
    cover(&g, (int)most, (double)on.picture.columns, from, to, inside);
    for (int k = 0; k < count; k++) {
        bool small = g.end[k] - g.first[k] <= LANES;
        if (small ? !(inside[k] > 0.0) : !(g.left[k] < g.right[k])) continue;
        ShadedPlane plane = plane_of(model, numbers[k], g.inverse[k]);
        if (!small) draw_rows(&g, k, &plane, on);
        for (int j = 0; small && j < (int)(g.end[k] - g.first[k]); j++)
            draw_row(&plane, (int64_t)g.first[k] + j, from[j][k], to[j][k], on);
    }
}

/* The farthest depth in each tile that has any of `drawn`. */
INLINE void find_farthest(Singles2 depth, const int32_t *drawn, Singles2 farthest) {
    for (int64_t row = drawn[0] / TILE; TILE * row < drawn[1]; row++)
        for (int64_t column = drawn[2] / TILE; TILE * column < drawn[3]; column++) {
            /* The last ones are whole, too, and so overlap. */
            int64_t top = least(TILE * row, depth.rows - TILE), left = least(TILE * column, depth.columns - TILE);
            const float *depths = depth.data + top * depth.columns + left;
            float *whole = farthest.data + row * farthest.columns + column;
            Eight found = *(const UnalignedEight *)depths;
            for (int64_t y = 1; y < TILE; y++) {
                Eight other = *(const UnalignedEight *)(depths + y * depth.columns);
                EightInts less = other < found;
                found = (Eight)((less & (EightInts)other) | (~less & (EightInts)found));
            }
            *whole = found[0];
            for (int k = 1; k < TILE; k++) *whole = found[k] < *whole ? found[k] : *whole;
        }
}

/* `camera` takes a position to column, row and depth (larger is nearer), four numbers each, and holds the light; of
 * faces about as near, the brightest is shown. `placed` is room for all positions, `away` for all faces.
 *
 * Of a closed surface one half faces the camera, and hides the other: that half comes first, and most of the other one
 * need not be drawn. */
KERNEL int64_t draw_shaded(ConstDoubles2 positions, ConstInts2 faces, ConstSingles2 normals, ConstDoubles camera,
                           Doubles2 placed, Ints away, Canvas on) {
    Singles2 depth = on.depth, farthest = on.farthest, picture = on.picture;
    Ints2 owner = on.owner;
    Ints drawn = on.drawn;
    int64_t pixels = picture.rows * picture.columns;
    if (positions.columns != 3 || placed.columns != 3 || placed.rows < positions.rows || faces.columns != 3 ||
        away.size < faces.rows || normals.columns != 9 || normals.rows < faces.rows || camera.size != CAMERA ||
        faces.rows > INT32_MAX || (owner.rows && owner.rows * owner.columns < pixels) || depth.rows != picture.rows ||
        depth.columns != picture.columns || picture.rows < TILE || picture.columns < TILE ||
        farthest.rows * TILE < picture.rows || farthest.columns * TILE < picture.columns || drawn.size != 4 ||
        drawn.data[0] < 0 || drawn.data[1] > picture.rows || drawn.data[2] < 0 || drawn.data[3] > picture.columns)
        return MISUSED;
    if (!all_below(faces.data, 3 * faces.rows, positions.rows)) return MISUSED;
    const double *m = camera.data;
    double low[3] = {FAR, FAR, FAR}, high[3] = {-FAR, -FAR, -FAR};
    for (int64_t v = 0; v < positions.rows; v++) {
        const double *p = positions.data + 3 * v;
        for (int d = 0; d < 3; d++) {
            double at = m[4 * d] * p[0] + m[4 * d + 1] * p[1] + m[4 * d + 2] * p[2] + m[4 * d + 3];
            placed.data[3 * v + d] = at, low[d] = lower(low[d], at), high[d] = higher(high[d], at);
        }
    }
    for (int64_t row = drawn.data[0]; row < drawn.data[1]; row++)
        for (int64_t i = row * picture.columns + drawn.data[2]; i < row * picture.columns + drawn.data[3]; i++) {
            depth.data[i] = -__FLT_MAX__;
            picture.data[i] = BACKGROUND;
        }
    for (int64_t i = 0; i < (owner.rows ? pixels : 0); i++) owner.data[i] = -1;
    for (int d = 0; d < 2; d++) {
        double size = (double)(d ? picture.rows : picture.columns);
        bool near = low[d] > -FAR && high[d] < FAR;
        drawn.data[2 - 2 * d] = near ? (int32_t)clamped(low[d] - 1.0, size) : 0;
        drawn.data[3 - 2 * d] = near ? (int32_t)clamped(high[d] + 2.0, size) : (int32_t)size;
    }
    Model model = {placed.data, faces.data, normals.data, m + 12};
    double ahead = 0.0;
    for (int64_t f = 0; f < faces.rows; f += 1 + faces.rows / SAMPLE) {
        Face face = face_at(model, f);
        ahead += face.area * (face.a[2] + face.b[2] + face.c[2]);
    }
    ConstSingles2 behind = {farthest.data, farthest.rows, farthest.columns};
    int32_t numbers[LANES] = {0};
    int64_t count = 0, others = 0;
    for (int pass = 0; pass < 2; pass++) {
        int64_t total = pass ? others : faces.rows;
        if (pass) find_farthest(depth, drawn.data, farthest);
        for (int64_t i = 0; i < total; i++) {
            int32_t number = pass ? away.data[i] : (int32_t)i;
            Face face = face_at(model, number);
            numbers[count] = number;
            if (pass) {
                count += !hidden(face, behind);
            } else {
                away.data[others] = number;
                count += ahead > 0.0 ? face.area > 0.0 : face.area < 0.0;
                others += ahead > 0.0 ? face.area < 0.0 : face.area > 0.0;
            }
            if (count < LANES && !(count && i + 1 == total)) continue;
            draw_group(model, numbers, (int)count, on);
            count = 0;
        }
    }
    return 0;
}

/* The face that a picture shows at a pixel; those side by side mostly show the same one. */
typedef struct {
    int64_t number;
    Face face;
    double inverse; /* of its area */
} ShownFace;

/* What corners of a face have, `values` of `each` numbers, at the middle of a pixel that it covers. */
INLINE void values_at(const ShownFace *shown, const double *values, int64_t each, int64_t row, int64_t column,
                      double *found) {
    const double *a = shown->face.a, *b = shown->face.b, *c = shown->face.c;
    double across = (double)column + 0.5 - a[0], down = (double)row + 0.5 - a[1];
    double s = within((across * (c[1] - a[1]) - down * (c[0] - a[0])) * shown->inverse);
    double r = within(((b[0] - a[0]) * down - (b[1] - a[1]) * across) * shown->inverse);
    for (int64_t k = 0; k < each; k++)
        found[k] = values[k] + s * (values[each + k] - values[k]) + r * (values[2 * each + k] - values[k]);
}

/* Find the face of a number, unless it is the latest one; false if there is none, or it has no such corners. */
INLINE bool find_face(ConstInts2 faces, ConstDoubles2 placed, int64_t number, ShownFace *shown) {
    if (number == shown->number) return true;
    if (number >= faces.rows || !all_below(faces.data + 3 * number, 3, placed.rows)) return false;
    Face face = face_at((Model){placed.data, faces.data, 0, 0}, number);
    *shown = (ShownFace){number, face, 1.0 / face.area};
    return true;
}

/* `picture` times the color that corners have, three numbers of each in `values`: red, green, and blue below each
 * other in `painted`. `owner` and `placed` are as `draw_shaded` leaves them. */
KERNEL int64_t paint_colors(ConstInts2 owner, ConstDoubles2 placed, ConstInts2 faces, ConstDoubles2 values,
                             ConstSingles2 picture, Singles2 painted) {
    int64_t pixels = owner.rows * owner.columns;
    if (placed.columns != 3 || faces.columns != 3 || values.columns != 9 || values.rows < faces.rows ||
        picture.rows * picture.columns != pixels || painted.rows * painted.columns != 3 * pixels)
        return MISUSED;
    ShownFace shown = {.number = -1};
    for (int64_t row = 0, i = 0; row < owner.rows; row++)
        for (int64_t column = 0; column < owner.columns; column++, i++) {
            int64_t face = owner.data[i];
            double found[3] = {1.0, 1.0, 1.0};
            if (face >= 0 && !find_face(faces, placed, face, &shown)) return MISUSED;
            if (face >= 0) values_at(&shown, values.data + 9 * face, 3, row, column, found);
            for (int k = 0; k < 3; k++) painted.data[k * pixels + i] = picture.data[i] * (float)found[k];
        }
    return 0;
}

/* `picture` times a checkerboard of squares of side 1 at the places of corners, two numbers of each in `values`; dark
 * ones are as bright as `dark`. Their sides are one over `steepness` wide on each face. */
KERNEL int64_t paint_checker(ConstInts2 owner, ConstDoubles2 placed, ConstInts2 faces, ConstDoubles2 values,
                             ConstDoubles steepness, double dark, Singles2 picture) {
    int64_t pixels = owner.rows * owner.columns;
    if (placed.columns != 3 || faces.columns != 3 || values.columns != 6 || values.rows < faces.rows ||
        steepness.size < faces.rows || picture.rows * picture.columns != pixels)
        return MISUSED;
    ShownFace shown = {.number = -1};
    for (int64_t row = 0, i = 0; row < owner.rows; row++)
        for (int64_t column = 0; column < owner.columns; column++, i++) {
            int64_t face = owner.data[i];
            double at[2], board = 1.0;
            if (face < 0) continue;
            if (!find_face(faces, placed, face, &shown)) return MISUSED;
            values_at(&shown, values.data + 6 * face, 2, row, column, at);
            for (int k = 0; k < 2; k++) {
                double square = floor_of(at[k]), inside = at[k] - square, odd = square - 2.0 * floor_of(0.5 * square);
                board *= lower(lower(inside, 1.0 - inside) * steepness.data[face], 1.0) * (1.0 - 2.0 * odd);
            }
            picture.data[i] *= (float)(0.5 * (1.0 + dark - (1.0 - dark) * board));
        }
    return 0;
}
