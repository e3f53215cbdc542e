/* Joint bilateral filter of face normals (paper, equations 9 to 11). */
#include <math.h>

#include "codec/denoise/filters/kernel.h"
#include "codec/denoise/filters/vectors3.h"

void filter_normals(ConstDoubles2 centroids, ConstDoubles areas, ConstDoubles2 normals, ConstDoubles2 guide,
                    ConstLongs starts, ConstInts near, double sigma_s, double sigma_r, Doubles2 filtered) {
    double spatial = -0.5 / (sigma_s * sigma_s), range = -0.5 / (sigma_r * sigma_r);
    for (int64_t f = 0; f < normals.rows; f++) {
        Vector3 centre = row_of(centroids.data, f), likeness = row_of(guide.data, f), sum = {0.0, 0.0, 0.0};
        for (int64_t k = starts.data[f]; k < starts.data[f + 1]; k++) {
            int64_t h = near.data[k];
            Vector3 apart = less(row_of(centroids.data, h), centre), unlike = less(row_of(guide.data, h), likeness);
            /* Both kernels are Gaussian, so one exponential of the sum serves. */
            double weight = areas.data[h] * exp(spatial * dot(apart, apart) + range * dot(unlike, unlike));
            sum = plus_scaled(sum, weight, row_of(normals.data, h));
        }
        put_row(filtered.data, f, direction(sum, row_of(normals.data, f)));
    }
}
