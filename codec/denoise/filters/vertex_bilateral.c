/* Bilateral mesh denoising (Fleishman, Drori, Cohen-Or 2003): a bilateral filter of heights over tangent planes. */
#include <math.h>

#include "codec/denoise/filters/vectors3.h"
#include "codec/denoise/filters/vertex_bilateral.h"

/* Length of the shortest edge at each vertex; 0 where there is none. */
void shortest_edges(ConstDoubles2 positions, ConstLongs starts, ConstInts members, Doubles lengths) {
    for (int64_t v = 0; v < positions.rows; v++) {
        double shortest = __builtin_inf();
        for (int64_t k = starts.data[v]; k < starts.data[v + 1]; k++) {
            Vector3 edge = less(row_of(positions.data, v), row_of(positions.data, members.data[k]));
            double squared = dot(edge, edge);
            shortest = squared < shortest ? squared : shortest;
        }
        lengths.data[v] = shortest < __builtin_inf() ? __builtin_sqrt(shortest) : 0.0;
    }
}

/* Variance of the absolute heights of some points over the tangent plane at a place. */
static double variance_of_heights(const double *positions, const int32_t *near, int64_t count, Vector3 place,
                                  Vector3 normal) {
    double mean = 0.0, square = 0.0;
    for (int64_t k = 0; k < count; k++) {
        double height = fabs(dot(less(row_of(positions, near[k]), place), normal));
        mean += height;
        square += height * height;
    }
    mean /= (double)count;
    double variance = square / (double)count - mean * mean;
    return variance > 0.0 ? variance : 0.0;
}

void filter_heights(ConstDoubles2 positions, ConstDoubles2 normals, ConstDoubles widths, ConstLongs starts, ConstInts near,
                    Doubles2 moved) {
    for (int64_t v = 0; v < positions.rows; v++) {
        const int32_t *row = near.data + starts.data[v];
        int64_t count = starts.data[v + 1] - starts.data[v];
        Vector3 place = row_of(positions.data, v), normal = row_of(normals.data, v);
        double width = widths.data[v], variance = 0.0;
        put_row(moved.data, v, place);
        if (count >= 2 && width > 0.0) variance = variance_of_heights(positions.data, row, count, place, normal);
        if (variance == 0.0) continue;
        double total = 0.0, moment = 0.0;
        for (int64_t k = 0; k < count; k++) {
            Vector3 apart = less(row_of(positions.data, row[k]), place);
            double height = dot(apart, normal);
            double weight = exp(-0.5 * dot(apart, apart) / (width * width) - 0.5 * height * height / variance);
            total += weight;
            moment += weight * height;
        }
        put_row(moved.data, v, plus_scaled(place, moment / total, normal));
    }
}
