/* Non-iterative smoothing (Jones, Durand, Desbrun 2003): robust means of what the faces around predict. */
#include <math.h>

#include "codec/denoise/filters/non_iterative.h"
#include "codec/denoise/filters/vectors3.h"

/* Each vertex to the Gaussian mean of the centroids near it. */
void mollify(ConstDoubles2 positions, ConstDoubles2 centroids, ConstDoubles areas, ConstLongs starts, ConstInts near,
             double width, Doubles2 moved) {
    for (int64_t v = 0; v < positions.rows; v++) {
        Vector3 place = row_of(positions.data, v), sum = {0.0, 0.0, 0.0};
        double total = 0.0;
        for (int64_t k = starts.data[v]; k < starts.data[v + 1]; k++) {
            Vector3 centroid = row_of(centroids.data, near.data[k]), apart = less(centroid, place);
            double weight = areas.data[near.data[k]] * exp(-0.5 * dot(apart, apart) / (width * width));
            total += weight;
            sum = plus_scaled(sum, weight, centroid);
        }
        put_row(moved.data, v, total > 0.0 ? over(sum, total) : place);
    }
}

/* Each vertex to the mean of its projections on the planes of the faces near it, weighed by distance and by height. */
void predict_from_planes(ConstDoubles2 positions, ConstDoubles2 centroids, ConstDoubles areas, ConstDoubles2 normals,
                         ConstLongs starts, ConstInts near, double spatial, double influence, Doubles2 moved) {
    for (int64_t v = 0; v < positions.rows; v++) {
        Vector3 place = row_of(positions.data, v), sum = {0.0, 0.0, 0.0};
        double total = 0.0;
        for (int64_t k = starts.data[v]; k < starts.data[v + 1]; k++) {
            Vector3 apart = less(row_of(centroids.data, near.data[k]), place), normal = row_of(normals.data, near.data[k]);
            double height = dot(apart, normal);
            double exponent = -0.5 * dot(apart, apart) / (spatial * spatial) - 0.5 * height * height / (influence * influence);
            double weight = areas.data[near.data[k]] * exp(exponent);
            total += weight;
            sum = plus_scaled(sum, weight * height, normal);
        }
        put_row(moved.data, v, total > 0.0 ? plus_scaled(place, 1.0 / total, sum) : place);
    }
}
