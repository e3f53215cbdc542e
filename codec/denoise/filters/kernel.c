/* Joint bilateral filter of face normals (paper, equations 9 to 11). */
#include "codec/denoise/filters/exponential.h"
#include "codec/denoise/filters/kernel.h"
#include "codec/denoise/filters/vectors3.h"

KERNEL void filter_normals(ConstDoubles2 centroids, ConstDoubles areas, ConstDoubles2 normals, ConstDoubles2 guide,
                           ConstLongs starts, ConstInts near, double sigma_s, double sigma_r, Doubles2 filtered) {
    double spatial = -0.5 / (sigma_s * sigma_s), range = -0.5 / (sigma_r * sigma_r);
    for (int64_t f = 0; f < normals.rows; f++) {
        Vector3 centre = row_of(centroids.data, f), likeness = row_of(guide.data, f), sum = {0.0, 0.0, 0.0};
        for (int64_t first = starts.data[f]; first < starts.data[f + 1]; first += EIGHT) {
            const int32_t *row = near.data + first;
            int64_t count = least(EIGHT, starts.data[f + 1] - first);
            Eight weights = {0.0};
            for (int64_t k = 0; k < count; k++) {
                Vector3 apart = less(row_of(centroids.data, row[k]), centre);
                Vector3 unlike = less(row_of(guide.data, row[k]), likeness);
                /* Both kernels are Gaussian, so one exponential of the sum serves. */
                weights[k] = spatial * dot(apart, apart) + range * dot(unlike, unlike);
            }
            weights = exponentials(weights);
            for (int64_t k = 0; k < count; k++)
                sum = plus_scaled(sum, areas.data[row[k]] * weights[k], row_of(normals.data, row[k]));
        }
        put_row(filtered.data, f, direction(sum, row_of(normals.data, f)));
    }
}
