/* What surrounds a face, as numbers in a frame of its own: filtered normals, how like its neighbors are, and how
 * normals and heights go about it on two circles. */
#include <math.h>

#include "codec/denoise/denoise.h"
#include "codec/denoise/vectors.h"

/* Between the two circles, a square of distances of adjacent centroids. */
static const float BETWEEN = 4.0f;

typedef struct {
    Vector3 x, y, z;
} Axes;

INLINE double *put_local(double *row, const Axes *frame, Vector3 v) {
    row[0] = dot(v, frame->x);
    row[1] = dot(v, frame->y);
    row[2] = dot(v, frame->z);
    return row + 3;
}

/* z: where the surface looks at large; x: the direction across it in which the normals about vary most. */
static Axes frame_of(Vector3 axis, const double *smooth, const double *areas, const int32_t *row, int64_t count) {
    Axes frame;
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
    Lanes areas, normal[3], apart[3], unlike_guide;
} Neighbors;

INLINE Lanes squared_length(const Lanes *v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

INLINE double sum_of_eight(Lanes v) { return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])); }

INLINE Vector3 sums_of_eight(const Lanes *v) {
    return (Vector3){sum_of_eight(v[0]), sum_of_eight(v[1]), sum_of_eight(v[2])};
}

/* exp(-d^2 / 2 r^2) for r = 0.6, 0.6 / sqrt 2, 0.3 and 0.15: one exponential, squared again and again. */
INLINE void ranges_of(Lanes squared, Lanes *weights) {
    Lanes e = exponentials(squared * (-0.5f / 0.36f)), e2 = e * e, e4 = e2 * e2, e8 = e4 * e4;
    weights[0] = e;
    weights[1] = e2;
    weights[2] = e4;
    weights[3] = e8 * e8;
}

INLINE Lanes chosen(LaneInts which, Lanes yes, Lanes no) {
    return (Lanes)(((LaneInts)yes & which) | ((LaneInts)no & ~which));
}

/* The angles of (a, b) in sectors from 0 to SECTORS, to a hundred-thousandth. */
INLINE Lanes sectors_of(Lanes a, Lanes b) {
    Lanes wide = chosen(a < 0.0f, -a, a), high = chosen(b < 0.0f, -b, b);
    LaneInts steep = wide < high;
    Lanes t = chosen(steep, wide, high) / (chosen(steep, high, wide) + 1e-30f), u = t * t;
    Lanes turn = -0.11643287f + u * (0.05265332f - u * 0.01172120f);
    turn = t * (0.99997726f + u * (-0.33262347f + u * (0.19354346f + u * turn)));
    turn *= (float)(SECTORS / (2.0 * 3.14159265358979323846));
    turn = chosen(steep, SECTORS / 4.0f - turn, turn);
    turn = chosen(a < 0.0f, SECTORS / 2.0f - turn, turn);
    return chosen(b < 0.0f, SECTORS - turn, turn);
}

INLINE Lanes along(const Lanes *v, Vector3 axis) {
    return v[0] * (float)axis.x + v[1] * (float)axis.y + v[2] * (float)axis.z;
}

/* Rows of `described` are of the faces `begin` and after, those of `frames` hold x, y and z. */
KERNEL void describe_faces(FaceGeometry faces, Filtered filtered, Lists near, double distance, int64_t begin,
    Doubles2 described, Doubles2 frames) {
    ConstDoubles2 centroids = faces.centroids, normals = faces.normals, guide = filtered.guide;
    ConstDoubles areas = faces.areas;
    const int64_t *starts = near.starts.data;
    double usual = distance * distance;
    for (int64_t i = 0; i < described.rows; i++) {
        int64_t f = begin + i, first = starts[f], count = starts[f + 1] - first;
        const int32_t *row = near.members.data + first;
        Vector3 own = row_of(normals.data, f), likeness = row_of(guide.data, f);
        Axes frame = frame_of(row_of(filtered.axes.data, f), filtered.smooth.data, areas.data, row, count);
        Lanes sums[SCALES][2 * RANGES + 1][3] = {{{{0.0f}}}}, totals[SCALES][2 * RANGES + 1] = {{{0.0f}}};
        Lanes circles[RINGS * SECTORS] = {{0.0f}}; /* area covered, normal, height */
        for (int64_t done = 0; done < count; done += EIGHT) {
            int64_t lanes = least(EIGHT, count - done);
            Neighbors near_by = {.areas = {0.0f}};
            for (int64_t k = 0; k < lanes; k++) {
                int64_t h = row[done + k];
                for (int c = 0; c < 3; c++) {
                    near_by.normal[c][k] = (float)normals.data[3 * h + c];
                    near_by.apart[c][k] = (float)((centroids.data[3 * h + c] - centroids.data[3 * f + c]) / distance);
                }
                Vector3 unlike = less(row_of(guide.data, h), likeness);
                near_by.unlike_guide[k] = (float)dot(unlike, unlike);
                near_by.areas[k] = (float)(areas.data[h] / usual);
            }
            Lanes unlike[3], weights[2 * RANGES + 1], squared = squared_length(near_by.apart);
            for (int c = 0; c < 3; c++) unlike[c] = near_by.normal[c] - (float)normals.data[3 * f + c];
            ranges_of(squared_length(unlike), weights);
            ranges_of(near_by.unlike_guide, weights + RANGES);
            weights[2 * RANGES] = squared * 0.0f + 1.0f;
            Lanes wide = exponentials(squared * -0.125f), wide2 = wide * wide;
            Lanes spatial[SCALES] = {near_by.areas * wide2 * wide2, near_by.areas * wide};
            for (int s = 0; s < SCALES; s++) {
                for (int r = 0; r <= 2 * RANGES; r++) {
                    Lanes weight = spatial[s] * weights[r];
                    totals[s][r] += weight;
                    for (int c = 0; c < 3; c++) sums[s][r][c] += weight * near_by.normal[c];
                }
            }
            Lanes x = along(near_by.apart, frame.x), y = along(near_by.apart, frame.y), place = sectors_of(x, y);
            Lanes height = along(near_by.apart, frame.z);
            LaneInts sector = __builtin_convertvector(place, LaneInts), ring = (squared >= BETWEEN) & SECTORS;
            Lanes part = place - __builtin_convertvector(sector, Lanes);
            Lanes aside = chosen((x == 0.0f) & (y == 0.0f), x, near_by.areas), later = aside * part;
            LaneInts first = ring + sector % SECTORS, second = ring + (sector + 1) % SECTORS;
            for (int64_t k = 0; k < lanes; k++) {
                Lanes seen = {1.0f, near_by.normal[0][k], near_by.normal[1][k], near_by.normal[2][k], height[k]};
                circles[first[k]] += seen * (aside[k] - later[k]);
                circles[second[k]] += seen * later[k];
            }
        }
        double *out = put_local(described.data + i * described.columns, &frame, own);
        for (int s = 0; s < SCALES; s++)
            for (int r = 0; r <= 2 * RANGES; r++)
                out = put_local(out, &frame, direction(sums_of_eight(sums[s][r]), own));
        for (int sector = 0; sector < RINGS * SECTORS; sector++) {
            /* A circle that leaves the mesh goes on as the surface does at large. */
            Lanes seen = circles[sector] / (circles[sector][0] > 0.0f ? circles[sector][0] : 1.0f);
            out = put_local(out, &frame, seen[0] > 0.0f ? (Vector3){seen[1], seen[2], seen[3]} : frame.z);
            *out++ = seen[4];
        }
        for (int s = 0; s < SCALES; s++) {
            double whole = sum_of_eight(totals[s][2 * RANGES]);
            whole = whole > 0.0 ? whole : 1.0;
            for (int r = 0; r < 2 * RANGES; r++) *out++ = sum_of_eight(totals[s][r]) / whole;
            *out++ = length_of(sums_of_eight(sums[s][2 * RANGES])) / whole;
        }
        *out++ = areas.data[f] / (areas.data[f] + usual);
        put_row(frames.data + i * frames.columns, 0, frame.x);
        put_row(frames.data + i * frames.columns, 1, frame.y);
        put_row(frames.data + i * frames.columns, 2, frame.z);
    }
}
