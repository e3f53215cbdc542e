/* Local frames of a decoded mesh, and the displacement in them (specification, M 17). Continuous in the positions, and
 * nothing is compared: decoders whose positions differ by rounding get frames that differ by rounding. */
#include "codec/signal/signal.h"

#include "codec/geometry/geometry.h"

/* Orthonormal. Few surfaces have a normal opposite the first, where the tangents turn fast. */
static const double POLE[3] = {0.48, 0.6, 0.64}, TANGENTS[2][3] = {{-0.8, 0.0, 0.6}, {0.36, -0.8, 0.48}};

/* Rows of `frames` are a vertex's normal and two tangents; `faces` are below the number of rows. */
int64_t local_frames(ConstDoubles2 positions, ConstInts2 faces, Doubles2 frames) {
    if (positions.columns != 3 || faces.columns != 3 || frames.columns != 9 || frames.rows != positions.rows)
        return MISUSED;
    for (int64_t i = 0; i < 9 * frames.rows; i++) frames.data[i] = 0.0;
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        double across[3];
        cross_of_face(positions.data, face, across);
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) frames.data[9 * (int64_t)face[k] + j] += across[j];
    }
    double total = 0.0;
    for (int64_t v = 0; v < frames.rows; v++) total += dot3(frames.data + 9 * v, frames.data + 9 * v);
    double soft = frames.rows ? __builtin_sqrt(total / (double)frames.rows) * 0x1p-10 + 0x1p-33 : 0.0;
    for (int64_t v = 0; v < frames.rows; v++) {
        double *normal = frames.data + 9 * v;
        for (int j = 0; j < 3; j++) normal[j] += soft * POLE[j];
        double length = __builtin_sqrt(dot3(normal, normal) + 0x1p-200);
        for (int j = 0; j < 3; j++) normal[j] /= length;
        double along = 1.0 + dot3(POLE, normal);
        if (along < 0x1p-20) along = 0x1p-20; /* continuous, too */
        for (int k = 0; k < 2; k++) {
            double share = dot3(TANGENTS[k], normal) / along;
            for (int j = 0; j < 3; j++) normal[3 + 3 * k + j] = TANGENTS[k][j] - share * (POLE[j] + normal[j]);
        }
    }
    return 0;
}

static const double FLAT = 0x1p-12; /* bends that are flat; the ratio halves with every factor of 16 beyond */

enum { SOME = 256 }; /* faces of a call: what runs WebAssembly compiles a function better from one to the next */

/* Add to each corner of some faces their normal and area, and their rim around the corner, and the rim's length. */
KERNEL OFTEN static void add_bends(ConstDoubles2 positions, const int32_t *faces, int64_t count, double *sums) {
    for (const int32_t *face = faces; face < faces + 3 * count; face += 3) {
        const double *corner[3];
        double across[3], rims[3][3], lengths[4];
        cross_of_face(positions.data, face, across);
        lengths[0] = dot3(across, across);
        for (int k = 0; k < 3; k++) corner[k] = positions.data + 3 * (int64_t)face[k];
        for (int k = 0; k < 3; k++) {
            for (int j = 0; j < 3; j++) rims[k][j] = corner[(k + 2) % 3][j] - corner[(k + 1) % 3][j];
            lengths[1 + k] = dot3(rims[k], rims[k]);
        }
        for (int k = 0; k < 4; k++) lengths[k] = __builtin_sqrt(lengths[k]);
        for (int k = 0; k < 3; k++) {
            UnalignedFour *sum = (UnalignedFour *)(sums + 8 * (int64_t)face[k]);
            sum[0] += (Four){across[0], across[1], across[2], lengths[0]};
            sum[1] += (Four){rims[k][0], rims[k][1], rims[k][2], lengths[1 + k]};
        }
    }
}

/* How long a step in the plane is at each vertex, `steps` (n): `ratio` times `step` where the surface is flat, and less
 * the more it is bent, and at borders, down to `step`; `scratch` is n x 8. Continuous, too. */
int64_t tangent_steps(ConstDoubles2 positions, ConstInts2 faces, double step, double ratio, Doubles2 scratch,
                      Doubles steps) {
    int64_t n = positions.rows;
    if (positions.columns != 3 || faces.columns != 3 || scratch.columns != 8 || scratch.rows != n || steps.size != n)
        return MISUSED;
    double lowest = ratio < 1.0 ? ratio : 1.0;
    if (ratio <= 1.0) {
        for (int64_t v = 0; v < n; v++) steps.data[v] = step * lowest;
        return 0;
    }
    for (int64_t i = 0; i < 8 * n; i++) scratch.data[i] = 0.0;
    for (int64_t f = 0; f < faces.rows; f += SOME)
        add_bends(positions, faces.data + 3 * f, least(SOME, faces.rows - f), scratch.data);
    /* The bend of each vertex, more at borders, where what is around does not close; then four times the sum over its
     * corners, half of it of the others', and four times their number. */
    for (int64_t v = 0; v < n; v++) {
        double *at = scratch.data + 8 * v;
        double open = __builtin_sqrt(dot3(at + 4, at + 4)) / (at[7] + 0x1p-200);
        at[0] = 1.0 - __builtin_sqrt(dot3(at, at)) / (at[3] + 0x1p-200) + open;
        at[1] = at[2] = 0.0;
    }
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        double sum = 0.0;
        for (int k = 0; k < 3; k++) sum += scratch.data[8 * (int64_t)face[k]];
        for (int k = 0; k < 3; k++) {
            double *at = scratch.data + 8 * (int64_t)face[k];
            at[1] += at[0] + sum, at[2] += 4.0;
        }
    }
    for (int64_t v = 0; v < n; v++) {
        const double *at = scratch.data + 8 * v;
        double bend = at[2] > 0.0 ? at[1] / at[2] : 1.0;
        double share = ratio * __builtin_sqrt(__builtin_sqrt(FLAT / (FLAT + bend)));
        steps.data[v] = step * (share > lowest ? share : lowest);
    }
    return 0;
}

/* Move positions along their normals, by the first of each row of levels in units of `step`. */
int64_t add_heights(Doubles2 positions, ConstDoubles2 frames, ConstInts2 levels, double step) {
    if (positions.columns != 3 || frames.columns != 9 || levels.columns < 1 || frames.rows != positions.rows ||
        levels.rows != positions.rows)
        return MISUSED;
    for (int64_t v = 0; v < levels.rows; v++) {
        double amount = levels.data[v * levels.columns] * step;
        for (int j = 0; j < 3; j++) positions.data[3 * v + j] += amount * frames.data[9 * v + j];
    }
    return 0;
}

/* And in the plane, by the second and the third, in units of each vertex's own. */
int64_t add_slides(Doubles2 positions, ConstDoubles2 frames, ConstInts2 levels, ConstDoubles steps) {
    if (positions.columns != 3 || frames.columns != 9 || levels.columns != 3 || frames.rows != positions.rows ||
        levels.rows != positions.rows || steps.size != positions.rows)
        return MISUSED;
    for (int64_t v = 0; v < levels.rows; v++)
        for (int a = 1; a < 3; a++) {
            double amount = levels.data[3 * v + a] * steps.data[v];
            for (int j = 0; j < 3; j++) positions.data[3 * v + j] += amount * frames.data[9 * v + 3 * a + j];
        }
    return 0;
}
