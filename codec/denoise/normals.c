/* Filters of face normals (paper, equations 9 to 11), and what guides them. */
#include "codec/denoise/denoise.h"
#include "codec/denoise/vectors.h"

typedef struct {
    Lanes place; /* centroid and guide over their kernels' widths, so that neighbors are compared whole */
    Four normal;        /* times the area */
} Packed;

/* Joint bilateral filter of face normals; `packed` is scratch, a row of 8 for each face. */
KERNEL void filter_normals(FaceGeometry faces, ConstDoubles2 guide, Lists near, double sigma_s, double sigma_r,
    Doubles2 packed, Doubles2 filtered) {
    ConstDoubles2 centroids = faces.centroids, normals = faces.normals;
    const int64_t *starts = near.starts.data;
    double spatial = __builtin_sqrt(0.5) / sigma_s, range = __builtin_sqrt(0.5) / sigma_r;
    Packed *rows = (Packed *)packed.data;
    for (int64_t f = 0; f < normals.rows; f++) {
        const double *c = centroids.data + 3 * f, *g = guide.data + 3 * f, *n = normals.data + 3 * f;
        double a = faces.areas.data[f];
        for (int i = 0; i < 3; i++) {
            double place = (c[i] - centroids.data[i]) * spatial;
            rows[f].place[i] = (float)(place < -1e15 ? -1e15 : place < 1e15 ? place : 1e15);
            rows[f].place[i + 4] = (float)(g[i] * range);
        }
        rows[f].normal = (Four){n[0] * a, n[1] * a, n[2] * a, 0.0};
    }
    for (int64_t f = 0; f < normals.rows; f++) {
        Lanes place = rows[f].place;
        Four sum = {0.0};
        for (int64_t first = starts[f]; first < starts[f + 1]; first += CHUNK) {
            const int32_t *row = near.members.data + first;
            int64_t count = least(CHUNK, starts[f + 1] - first);
            float weights[CHUNK] = {0.0f};
            for (int64_t k = 0; k < count; k++) {
                Lanes apart = rows[row[k]].place - place, s = apart * apart;
                /* Both kernels are Gaussian, so one exponential of the sum serves. */
                weights[k] = -(((s[0] + s[4]) + (s[1] + s[5])) + (s[2] + s[6]));
            }
            Lanes *some = (Lanes *)weights;
            for (int64_t k = 0; k < count; k += EIGHT, some++) *some = exponentials(*some);
            for (int64_t k = 0; k < count; k++) sum += rows[row[k]].normal * (double)weights[k];
        }
        put_row(filtered.data, f, direction((Vector3){sum[0], sum[1], sum[2]}, row_of(normals.data, f)));
    }
}

/* `steps`: distance between the normals of each pair of neighboring faces. A low score is a consistent patch; `guide`
 * gets the mean of the most consistent one that holds the face. */
KERNEL void patch_guidance(ConstDoubles2 normals, ConstDoubles areas, Lists patches, ConstDoubles steps, Lists inner,
    Doubles scores, Doubles2 means, Doubles2 guide) {
    ConstLongs starts = patches.starts;
    ConstInts members = patches.members;
    for (int64_t f = 0; f < normals.rows; f++) {
        int64_t first = starts.data[f], last = starts.data[f + 1];
        double widest = 0.0, total = 0.0, highest = 0.0;
        Vector3 sum = {0.0, 0.0, 0.0};
        for (int64_t k = first; k < last; k++)
            sum = plus_scaled(sum, areas.data[members.data[k]], row_of(normals.data, members.data[k]));
        for (int64_t k = first; k < last; k += EIGHT) {
            Vector3 some[EIGHT];
            for (int lane = 0; lane < EIGHT; lane++)
                some[lane] = row_of(normals.data, members.data[least(k + lane, last - 1)]);
#define LANES(c) {some[0].c, some[1].c, some[2].c, some[3].c, some[4].c, some[5].c, some[6].c, some[7].c}
            Eight x = LANES(x), y = LANES(y), z = LANES(z), squares = {0.0};
            for (int64_t q = k + 1; q < last; q++) {
                Vector3 other = row_of(normals.data, members.data[q]);
                Eight a = x - other.x, b = y - other.y, c = z - other.z, squared = a * a + b * b + c * c;
                EightLongs wider = squared > squares;
                squares = (Eight)(((EightLongs)squared & wider) | ((EightLongs)squares & ~wider));
            }
            for (int lane = 0; lane < EIGHT; lane++) widest = squares[lane] > widest ? squares[lane] : widest;
        }
        for (int64_t k = inner.starts.data[f]; k < inner.starts.data[f + 1]; k++) {
            double step = steps.data[inner.members.data[k]];
            total += step;
            highest = step > highest ? step : highest;
        }
        scores.data[f] = __builtin_sqrt(widest) * highest / (total + 1e-9);
        put_row(means.data, f, direction(sum, (Vector3){0.0, 0.0, 0.0}));
    }
    for (int64_t f = 0; f < scores.size; f++) {
        int32_t best = members.data[starts.data[f]];
        for (int64_t k = starts.data[f] + 1; k < starts.data[f + 1]; k++)
            if (scores.data[members.data[k]] < scores.data[best]) best = members.data[k];
        put_row(guide.data, f, row_of(means.data, best));
    }
}
