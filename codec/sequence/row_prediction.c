/* Prediction and quantization of the rows of a block in closed loop (specification, S 6).
 *
 * The columns of a row are known one after the other; each known one moves what is expected of those behind it, by the
 * Cholesky factor of the second moments of the rows before.
 */
#include "codec/sequence/row_prediction.h"

/* Rows of the Cholesky factor of moments + ridge I, extended over all columns. */
INLINE void factorize_moments(ConstDoubles2 moments, double ridge, double *factor) {
    int64_t size = moments.rows, width = moments.columns;
    for (int64_t a = 0; a < size; a++) {
        double *row = factor + a * width;
        for (int64_t b = a; b < width; b++) row[b] = moments.data[a * width + b];
        row[a] += ridge;
        for (int64_t k = 0; k < a; k++) {
            const double *before = factor + k * width;
            double share = before[a];
            for (int64_t b = a; b < width; b++) row[b] -= share * before[b];
        }
        double root = __builtin_sqrt(row[a]);
        for (int64_t b = a; b < width; b++) row[b] /= root;
    }
}

/* Go through all rows: fills `levels` from `targets` if encoding, reads them otherwise; `decoded` is what the decoder
 * has. `factor`, `row` and `expected`, of the shape of `moments` and as long as its rows, are scratch. */
KERNEL void follow_rows(ConstDoubles2 known, ConstDoubles2 targets, Ints2 levels, Doubles2 decoded, Doubles2 moments,
                        double step, double rounding, bool encoding, PredictionRules rules, Doubles2 factor, Doubles row,
                        Doubles expected) {
    int64_t count = known.columns, size = moments.rows, width = moments.columns, coded = width - count;
    double *expect = expected.data, *now = row.data;
    ConstDoubles2 past = {moments.data, size, width};
    for (int64_t j = 0; j < levels.rows; j++) {
        if (j < rules.dense_rows || j % rules.renewal == 0) factorize_moments(past, rules.ridge, factor.data);
        for (int64_t b = 0; b < width; b++) expect[b] = 0.0;
        double energy = rules.noise * step * step;
        for (int64_t b = 0; b < width; b++) {
            if (b < count) {
                now[b] = known.data[j * count + b];
            } else {
                int32_t *level = levels.data + j * coded + b - count;
                if (encoding) {
                    double scaled = (targets.data[j * coded + b - count] - expect[b]) / step;
                    double magnitude = __builtin_floor(__builtin_fabs(scaled) + (j > 0 ? rounding : 0.5));
                    if (!(magnitude < rules.largest_level)) magnitude = rules.largest_level;
                    *level = (int32_t)(scaled > 0.0 ? magnitude : -magnitude);
                }
                now[b] = expect[b] + *level * step;
                decoded.data[j * coded + b - count] = now[b];
            }
            energy += now[b] * now[b];
            if (b < size) {
                const double *line = factor.data + b * width;
                double surprise = (now[b] - expect[b]) / line[b];
                for (int64_t c = b + 1; c < width; c++) expect[c] += surprise * line[c];
            }
        }
        if (j == 0) continue;
        double weight = 1.0 / energy;
        for (int64_t a = 0; a < size; a++) {
            double share = weight * now[a], *line = moments.data + a * width;
            for (int64_t b = a; b < width; b++) line[b] = rules.forgetting * line[b] + share * now[b];
        }
    }
}
