/* The random-walk Laplacian: every vertex less the mean of its neighbours; zero where it has none. */
#include "codec/denoise/noise/estimate.h"

void minus_mean(ConstDoubles2 values, ConstLongs starts, ConstInts members, Doubles2 rest) {
    int64_t width = values.columns;
    for (int64_t v = 0; v < values.rows; v++) {
        int64_t first = starts.data[v], last = starts.data[v + 1];
        for (int64_t axis = 0; axis < width; axis++) {
            double total = 0.0;
            for (int64_t k = first; k < last; k++) total += values.data[width * members.data[k] + axis];
            rest.data[width * v + axis] =
                first == last ? 0.0 : values.data[width * v + axis] - total / (double)(last - first);
        }
    }
}
