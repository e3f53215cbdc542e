/* What surrounds a face, as numbers in a frame of its own: filtered normals, how like its neighbors are, and how
 * normals and heights go about it on two circles. */
#include <math.h>

#include "codec/denoise/denoise.h"
#include "codec/denoise/vectors.h"

enum { RANGES = 4, SCALES = 2, SECTORS = 8, RINGS = 2, FILTERED = SCALES * (2 * RANGES + 1),
    LIKE = SCALES * 2 * RANGES };
enum { DESCRIBED = 3 * (1 + FILTERED) + 4 * SECTORS * RINGS + LIKE + SCALES + 1 };
/* Between the two circles, in distances of adjacent centroids. */
static const double BETWEEN = 2.0;

typedef struct {
    Vector3 x, y, z;
} Frame;

INLINE double *put_local(double *row, const Frame *frame, Vector3 v) {
    row[0] = dot(v, frame->x);
    row[1] = dot(v, frame->y);
    row[2] = dot(v, frame->z);
    return row + 3;
}

/* z: where the surface looks at large; x: the direction across it in which the normals about vary most. */
static Frame frame_of(Vector3 axis, const double *smooth, const double *areas, const int32_t *row, int64_t count) {
    Frame frame;
    frame.z = direction(axis, (Vector3){0.0, 0.0, 1.0});
    Vector3 aside = frame.z.x * frame.z.x < 0.5 ? (Vector3){1.0, 0.0, 0.0} : (Vector3){0.0, 1.0, 0.0};
    Vector3 u = direction(cross(frame.z, aside), (Vector3){1.0, 0.0, 0.0}), v = cross(frame.z, u);
    double uu = 0.0, uv = 0.0, vv = 0.0;
    for (int64_t k = 0; k < count; k++) {
        Vector3 normal = row_of(smooth, row[k]);
        double a = dot(normal, u), b = dot(normal, v), area = areas[row[k]];
        uu += area * a * a;
        uv += area * a * b;
        vv += area * b * b;
    }
    double turn = 0.5 * atan2(2.0 * uv, uu - vv);
    frame.x = plus_scaled((Vector3){cos(turn) * u.x, cos(turn) * u.y, cos(turn) * u.z}, sin(turn), v);
    frame.y = cross(frame.z, frame.x);
    return frame;
}

/* Eight neighbors side by side: what there is of them, and nothing for lanes without one. */
typedef struct {
    Eight areas, normal[3], apart[3], unlike_guide;
} Neighbors;

INLINE Eight squared_length(const Eight *v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

INLINE double sum_of_eight(Eight v) { return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])); }

INLINE Vector3 sums_of_eight(const Eight *v) {
    return (Vector3){sum_of_eight(v[0]), sum_of_eight(v[1]), sum_of_eight(v[2])};
}

/* exp(-d^2 / 2 r^2) for r = 0.6, 0.6 / sqrt 2, 0.3 and 0.15: one exponential, squared again and again. */
INLINE void ranges_of(Eight squared, Eight *weights) {
    Eight e = exponentials(squared * (-0.5 / 0.36)), e2 = e * e, e4 = e2 * e2, e8 = e4 * e4;
    weights[0] = e;
    weights[1] = e2;
    weights[2] = e4;
    weights[3] = e8 * e8;
}

/* The angle of (a, b), of which one is not 0, in sectors from 0 to SECTORS, to a hundred-thousandth. */
INLINE double sector_of(double a, double b) {
    double wide = a < 0.0 ? -a : a, high = b < 0.0 ? -b : b, t = wide < high ? wide / high : high / wide, u = t * t;
    double turn = -0.11643287 + u * (0.05265332 - u * 0.01172120);
    turn = t * (0.99997726 + u * (-0.33262347 + u * (0.19354346 + u * turn)));
    turn *= SECTORS / (2.0 * 3.14159265358979323846);
    if (wide < high) turn = SECTORS / 4.0 - turn;
    if (a < 0.0) turn = SECTORS / 2.0 - turn;
    return b < 0.0 ? SECTORS - turn : turn;
}

/* Rows of `described` are of the faces `begin` and after, those of `frames` hold x, y and z. */
KERNEL void describe_faces(ConstDoubles2 centroids, ConstDoubles areas, ConstDoubles2 normals, ConstDoubles2 guide,
                           ConstDoubles2 smooth, ConstDoubles2 axes, ConstLongs starts, ConstInts near,
                           double distance, int64_t begin, Doubles2 described, Doubles2 frames) {
    if (described.columns < DESCRIBED || frames.columns < 9) return;
    for (int64_t i = 0; i < described.rows; i++) {
        int64_t f = begin + i, first = starts.data[f], count = starts.data[f + 1] - first;
        const int32_t *row = near.data + first;
        Vector3 own = row_of(normals.data, f), likeness = row_of(guide.data, f);
        Frame frame = frame_of(row_of(axes.data, f), smooth.data, areas.data, row, count);
        Eight sums[SCALES][2 * RANGES + 1][3] = {{{{0.0}}}}, totals[SCALES][2 * RANGES + 1] = {{{0.0}}};
        Vector3 circles[RINGS][SECTORS] = {{{0.0, 0.0, 0.0}}};
        double heights[RINGS][SECTORS] = {{0.0}}, covered[RINGS][SECTORS] = {{0.0}};
        for (int64_t done = 0; done < count; done += EIGHT) {
            int64_t lanes = least(EIGHT, count - done);
            Neighbors near_by = {.areas = {0.0}};
            for (int64_t k = 0; k < lanes; k++) {
                int64_t h = row[done + k];
                for (int c = 0; c < 3; c++) {
                    near_by.normal[c][k] = normals.data[3 * h + c];
                    near_by.apart[c][k] = centroids.data[3 * h + c] - centroids.data[3 * f + c];
                }
                Vector3 unlike = less(row_of(guide.data, h), likeness);
                near_by.unlike_guide[k] = dot(unlike, unlike);
                near_by.areas[k] = areas.data[h];
            }
            Eight unlike[3] = {near_by.normal[0] - own.x, near_by.normal[1] - own.y, near_by.normal[2] - own.z};
            Eight weights[2 * RANGES + 1], squared = squared_length(near_by.apart) / (distance * distance);
            ranges_of(squared_length(unlike), weights);
            ranges_of(near_by.unlike_guide, weights + RANGES);
            weights[2 * RANGES] = squared * 0.0 + 1.0;
            Eight wide = exponentials(squared * -0.125), wide2 = wide * wide;
            Eight spatial[SCALES] = {near_by.areas * wide2 * wide2, near_by.areas * wide};
            for (int s = 0; s < SCALES; s++) {
                for (int r = 0; r <= 2 * RANGES; r++) {
                    Eight weight = spatial[s] * weights[r];
                    totals[s][r] += weight;
                    for (int c = 0; c < 3; c++) sums[s][r][c] += weight * near_by.normal[c];
                }
            }
            for (int64_t k = 0; k < lanes; k++) {
                Vector3 apart = {near_by.apart[0][k], near_by.apart[1][k], near_by.apart[2][k]};
                double a = dot(apart, frame.x), b = dot(apart, frame.y);
                if (a == 0.0 && b == 0.0) continue;
                double place = sector_of(a, b), part = place - (int)place;
                int ring = squared[k] < BETWEEN * BETWEEN ? 0 : 1;
                for (int side = 0; side < 2; side++) {
                    int sector = ((int)place + side) % SECTORS;
                    double share = near_by.areas[k] * (side ? part : 1.0 - part);
                    covered[ring][sector] += share;
                    heights[ring][sector] += share * dot(apart, frame.z) / distance;
                    circles[ring][sector] = plus_scaled(
                        circles[ring][sector], share,
                        (Vector3){near_by.normal[0][k], near_by.normal[1][k], near_by.normal[2][k]});
                }
            }
        }
        double *out = put_local(described.data + i * described.columns, &frame, own);
        for (int s = 0; s < SCALES; s++)
            for (int r = 0; r <= 2 * RANGES; r++)
                out = put_local(out, &frame, direction(sums_of_eight(sums[s][r]), own));
        for (int ring = 0; ring < RINGS; ring++) {
            for (int sector = 0; sector < SECTORS; sector++) {
                /* A circle that leaves the mesh goes on as the surface does at large. */
                double total = covered[ring][sector];
                Vector3 mean = total > 0.0 ? over(circles[ring][sector], total) : frame.z;
                out = put_local(out, &frame, mean);
                *out++ = total > 0.0 ? heights[ring][sector] / total : 0.0;
            }
        }
        for (int s = 0; s < SCALES; s++) {
            double whole = sum_of_eight(totals[s][2 * RANGES]);
            whole = whole > 0.0 ? whole : 1.0;
            for (int r = 0; r < 2 * RANGES; r++) *out++ = sum_of_eight(totals[s][r]) / whole;
            *out++ = length_of(sums_of_eight(sums[s][2 * RANGES])) / whole;
        }
        double usual = distance * distance;
        *out++ = areas.data[f] / (areas.data[f] + usual);
        put_row(frames.data + i * frames.columns, 0, frame.x);
        put_row(frames.data + i * frames.columns, 1, frame.y);
        put_row(frames.data + i * frames.columns, 2, frame.z);
    }
}
