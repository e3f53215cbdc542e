/* What surrounds a face, as numbers in a frame of its own: filtered normals, how like its neighbours are, and how normals
 * and heights go about it on two circles. */
#include <math.h>

#include "codec/denoise/filters/vectors3.h"
#include "codec/denoise/learnt/descriptors.h"

enum { RANGES = 4, SCALES = 2, SECTORS = 8, RINGS = 2, FILTERED = SCALES * (2 * RANGES + 1), LIKE = SCALES * 2 * RANGES };
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

/* exp(-d^2 / 2 r^2) for r = 0.6, 0.6 / sqrt 2, 0.3 and 0.15: one exponential, squared again and again. */
INLINE void ranges_of(double squared, double *weights) {
    double e = exp(squared * (-0.5 / 0.36)), e2 = e * e, e4 = e2 * e2, e8 = e4 * e4;
    weights[0] = e;
    weights[1] = e2;
    weights[2] = e4;
    weights[3] = e8 * e8;
}

/* Rows of `described` are of the faces `begin` and after, those of `frames` hold x, y and z. */
void describe_faces(ConstDoubles2 centroids, ConstDoubles areas, ConstDoubles2 normals, ConstDoubles2 guide,
                    ConstDoubles2 smooth, ConstDoubles2 axes, ConstLongs starts, ConstInts near, double distance,
                    int64_t begin, Doubles2 described, Doubles2 frames) {
    if (described.columns < DESCRIBED || frames.columns < 9) return;
    for (int64_t i = 0; i < described.rows; i++) {
        int64_t f = begin + i, first = starts.data[f], count = starts.data[f + 1] - first;
        const int32_t *row = near.data + first;
        Vector3 centre = row_of(centroids.data, f), own = row_of(normals.data, f), likeness = row_of(guide.data, f);
        Frame frame = frame_of(row_of(axes.data, f), smooth.data, areas.data, row, count);
        Vector3 sums[SCALES][2 * RANGES + 1] = {{{0.0, 0.0, 0.0}}};
        double totals[SCALES][2 * RANGES + 1] = {{0.0}}, weights[2 * RANGES + 1];
        Vector3 circles[RINGS][SECTORS] = {{{0.0, 0.0, 0.0}}};
        double heights[RINGS][SECTORS] = {{0.0}}, covered[RINGS][SECTORS] = {{0.0}};
        for (int64_t k = 0; k < count; k++) {
            int64_t h = row[k];
            Vector3 normal = row_of(normals.data, h), apart = less(row_of(centroids.data, h), centre);
            Vector3 unlike = less(normal, own), unlike_guide = less(row_of(guide.data, h), likeness);
            ranges_of(dot(unlike, unlike), weights);
            ranges_of(dot(unlike_guide, unlike_guide), weights + RANGES);
            weights[2 * RANGES] = 1.0;
            double squared = dot(apart, apart) / (distance * distance), wide = exp(-0.125 * squared);
            double spatial[SCALES] = {areas.data[h] * wide * wide * wide * wide, areas.data[h] * wide};
            for (int s = 0; s < SCALES; s++) {
                for (int r = 0; r <= 2 * RANGES; r++) {
                    totals[s][r] += spatial[s] * weights[r];
                    sums[s][r] = plus_scaled(sums[s][r], spatial[s] * weights[r], normal);
                }
            }
            if (h == f) continue;
            double a = dot(apart, frame.x), b = dot(apart, frame.y);
            double place = (atan2(b, a) / (2.0 * 3.14159265358979323846) + 1.0) * SECTORS, below = floor(place);
            int ring = squared < BETWEEN * BETWEEN ? 0 : 1;
            for (int side = 0; side < 2; side++) {
                int sector = ((int)below + side) % SECTORS;
                double share = areas.data[h] * (side ? place - below : 1.0 - (place - below));
                covered[ring][sector] += share;
                heights[ring][sector] += share * dot(apart, frame.z) / distance;
                circles[ring][sector] = plus_scaled(circles[ring][sector], share, normal);
            }
        }
        double *out = put_local(described.data + i * described.columns, &frame, own);
        for (int s = 0; s < SCALES; s++)
            for (int r = 0; r <= 2 * RANGES; r++) out = put_local(out, &frame, direction(sums[s][r], own));
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
            double whole = totals[s][2 * RANGES] > 0.0 ? totals[s][2 * RANGES] : 1.0;
            for (int r = 0; r < 2 * RANGES; r++) *out++ = totals[s][r] / whole;
            *out++ = length_of(sums[s][2 * RANGES]) / whole;
        }
        double usual = distance * distance;
        *out++ = areas.data[f] / (areas.data[f] + usual);
        put_row(frames.data + i * frames.columns, 0, frame.x);
        put_row(frames.data + i * frames.columns, 1, frame.y);
        put_row(frames.data + i * frames.columns, 2, frame.z);
    }
}
