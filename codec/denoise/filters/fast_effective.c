/* Thresholded averages of normals (Sun, Rosin, Martin, Langbein 2007). */
#include "codec/denoise/filters/fast_effective.h"
#include "codec/denoise/filters/vectors3.h"

void average_alike(ConstDoubles2 normals, ConstLongs starts, ConstInts members, double threshold, Doubles2 averaged) {
    for (int64_t f = 0; f < normals.rows; f++) {
        Vector3 own = row_of(normals.data, f), sum = {0.0, 0.0, 0.0};
        for (int64_t k = starts.data[f]; k < starts.data[f + 1]; k++) {
            Vector3 other = row_of(normals.data, members.data[k]);
            double excess = dot(own, other) - threshold;
            if (excess > 0.0) sum = plus_scaled(sum, excess * excess, other);
        }
        put_row(averaged.data, f, direction(sum, own));
    }
}
