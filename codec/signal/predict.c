/* What holds a block: the springs of the specification's M 7.3, summed over the rows' neighbors in their order; and
 * what continues the known (M 7.4), sums in the order of rows. */
#include "bitstream/trellis.h"
#include "codec/signal/signal.h"

static void hang(Doubles springs, Doubles2 pulls, int64_t row, double stiffness, const double *sum, double weight) {
    springs.data[row] += stiffness;
    for (int d = 0; d < 3; d++) pulls.data[3 * row + d] += stiffness * (sum[d] / weight);
}

static const double STIFFNESS = 8; /* half of it costs 1.0 %, twice 1.6 % */

/* Stiffnesses and pulls at the rows of the block of `vertices`. A vertex whose copies weigh anything is known, and is
 * at `sums` over `weights`. `inside`, one entry a vertex of the mesh, is zero before and after. */
void look_around(ConstInts offsets, ConstInts neighbors, ConstInts vertices, Bytes inside, ConstDoubles2 sums,
                 ConstDoubles weights, Doubles springs, Doubles2 pulls) {
    for (int64_t r = 0; r < vertices.size; r++) inside.data[vertices.data[r]] = 1;
    for (int64_t r = 0; r < vertices.size; r++) {
        int64_t v = vertices.data[r];
        springs.data[r] = 0.0;
        for (int d = 0; d < 3; d++) pulls.data[3 * r + d] = 0.0;
        if (weights.data[v] > 0.0) hang(springs, pulls, r, STIFFNESS, sums.data + 3 * v, weights.data[v]);
        for (int64_t i = offsets.data[v]; i < offsets.data[v + 1]; i++) {
            int64_t w = neighbors.data[i];
            if (!inside.data[w] && weights.data[w] > 0.0)
                hang(springs, pulls, r, 1.0, sums.data + 3 * w, weights.data[w]);
        }
    }
    for (int64_t r = 0; r < vertices.size; r++) inside.data[vertices.data[r]] = 0;
}

INLINE double mean_of(ConstDoubles2 pulls, int64_t d, double total) {
    double sum = 0.0;
    for (int64_t r = 0; r < pulls.rows; r++) sum += pulls.data[r * pulls.columns + d];
    return sum / total;
}

/* What continues the known into the rows of a block: mean + (L + S + delta)^-1 (y - S mean), with a factor of
 * `factorize_fronts`; zero without springs. `scratch` is what `solve_columns` asks for. */
void continue_known(Fronts fronts, Singles values, ConstSingles inverse, ConstDoubles springs, ConstDoubles2 pulls,
    Singles scratch, Doubles2 continued) {
    int64_t n = pulls.rows, m = pulls.columns;
    double total = 0.0;
    for (int64_t r = 0; r < n; r++) total += springs.data[r];
    if (!(total > 0.0)) {
        for (int64_t i = 0; i < n * m; i++) continued.data[i] = 0.0;
        return;
    }
    for (int64_t d = 0; d < m; d++) {
        double mean = mean_of(pulls, d, total);
        for (int64_t r = 0; r < n; r++) continued.data[r * m + d] = pulls.data[r * m + d] - springs.data[r] * mean;
    }
    solve_columns(fronts, values, inverse, (ConstDoubles2){continued.data, n, m}, scratch, continued);
    for (int64_t d = 0; d < m; d++) {
        double mean = mean_of(pulls, d, total);
        for (int64_t r = 0; r < n; r++) continued.data[r * m + d] += mean;
    }
}

/* Positions of a block from its levels (specification, M 10.2): what is expected, and U times the coefficients. */

/* `levels` are those of M 9.11, a row for each of the first columns of U; `scratch` has room for a number for each. */
void place_block(ConstDoubles2 prediction, ConstSingles2 subspace, ConstInts2 levels, double half_step,
    Doubles scratch, Doubles2 positions) {
    values_of_levels(levels.data, 3 * levels.rows, half_step, scratch.data);
    reconstruct(subspace, (ConstDoubles2){scratch.data, levels.rows, 3}, positions);
    for (int64_t i = 0; i < 3 * subspace.rows; i++) positions.data[i] += prediction.data[i];
}
