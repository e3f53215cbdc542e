/* Local frames of a decoded mesh, and the displacement in them (specification, M 17). Continuous in the positions, and
 * nothing is compared: decoders whose positions differ by rounding get frames that differ by rounding. */
#include "codec/signal/frames.h"

/* Orthonormal. Few surfaces have a normal opposite the first, where the tangents turn fast. */
static const double POLE[3] = {0.48, 0.6, 0.64}, TANGENTS[2][3] = {{-0.8, 0.0, 0.6}, {0.36, -0.8, 0.48}};

INLINE double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Rows of `frames` are a vertex's normal and two tangents; `faces` are below the number of rows. */
int64_t local_frames(ConstDoubles2 positions, ConstInts2 faces, Doubles2 frames) {
    if (positions.columns != 3 || faces.columns != 3 || frames.columns != 9 || frames.rows != positions.rows)
        return MISUSED;
    for (int64_t i = 0; i < 9 * frames.rows; i++) frames.data[i] = 0.0;
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        const double *a = positions.data + 3 * (int64_t)face[0], *b = positions.data + 3 * (int64_t)face[1];
        const double *c = positions.data + 3 * (int64_t)face[2];
        double u[3], v[3];
        for (int j = 0; j < 3; j++) u[j] = b[j] - a[j], v[j] = c[j] - a[j];
        for (int j = 0; j < 3; j++) {
            double across = u[(j + 1) % 3] * v[(j + 2) % 3] - u[(j + 2) % 3] * v[(j + 1) % 3];
            for (int k = 0; k < 3; k++) frames.data[9 * (int64_t)face[k] + j] += across;
        }
    }
    double total = 0.0;
    for (int64_t v = 0; v < frames.rows; v++) total += dot(frames.data + 9 * v, frames.data + 9 * v);
    double soft = frames.rows ? __builtin_sqrt(total / (double)frames.rows) * 0x1p-10 + 0x1p-33 : 0.0;
    for (int64_t v = 0; v < frames.rows; v++) {
        double *normal = frames.data + 9 * v;
        for (int j = 0; j < 3; j++) normal[j] += soft * POLE[j];
        double length = __builtin_sqrt(dot(normal, normal) + 0x1p-200);
        for (int j = 0; j < 3; j++) normal[j] /= length;
        double along = 1.0 + dot(POLE, normal);
        if (along < 0x1p-20) along = 0x1p-20; /* continuous, too */
        for (int k = 0; k < 2; k++) {
            double share = dot(TANGENTS[k], normal) / along;
            for (int j = 0; j < 3; j++) normal[3 + 3 * k + j] = TANGENTS[k][j] - share * (POLE[j] + normal[j]);
        }
    }
    return 0;
}

/* Move positions by levels: the first along the normal in units of `step`, the others in the plane of `ratio * step`. */
int64_t add_levels(Doubles2 positions, ConstDoubles2 frames, ConstInts2 levels, double step, double ratio) {
    if (positions.columns != 3 || frames.columns != 9 || levels.columns < 1 || levels.columns > 3 ||
        frames.rows != positions.rows || levels.rows != positions.rows)
        return MISUSED;
    for (int64_t v = 0; v < levels.rows; v++)
        for (int64_t a = 0; a < levels.columns; a++) {
            double amount = levels.data[v * levels.columns + a] * (a == 0 ? step : step * ratio);
            for (int j = 0; j < 3; j++) positions.data[3 * v + j] += amount * frames.data[9 * v + 3 * a + j];
        }
    return 0;
}
