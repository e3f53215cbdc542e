#ifndef BSM_ROW_PREDICTION_H
#define BSM_ROW_PREDICTION_H

#include "bitstream/kernel.h"

/* The constants of row_prediction.py. */
typedef struct {
    double forgetting, ridge, noise, around;
    int64_t dense_rows, renewal;
} PredictionRules;

/* Rows of the Cholesky factor of moments + ridge I, extended over all columns. */
INLINE void factorize_moments(Doubles2 moments, double ridge, double *factor) {
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

/* Whether the weights of the prediction are made anew before row j. */
INLINE bool is_renewed(PredictionRules rules, int64_t j) { return j < rules.dense_rows || j % rules.renewal == 0; }

/* What is expected of the columns behind b, which is `surprise` off, given what was: `before`, or `after` itself. */
INLINE void expect_apart(
    const double *factor, int64_t width, int64_t b, double surprise, const double *before, double *after) {
    const double *line = factor + b * width;
    surprise /= line[b];
    for (int64_t c = b + 1; c < width; c++) after[c] = before[c] + surprise * line[c];
}

/* Let column b, which is `surprise` off, move what is expected of those behind it. */
INLINE void expect_behind(const double *factor, int64_t width, int64_t b, double surprise, double *expect) {
    expect_apart(factor, width, b, surprise, expect, expect);
}

/* Learn from row j, whose columns are all known. */
INLINE void learn_row(Doubles2 moments, PredictionRules rules, double step, int64_t j, const double *now) {
    if (j == 0) return;
    double energy = rules.noise * step * step;
    for (int64_t b = 0; b < moments.columns; b++) energy += now[b] * now[b];
    double weight = 1.0 / energy;
    for (int64_t a = 0; a < moments.rows; a++) {
        double share = weight * now[a], *line = moments.data + a * moments.columns;
        for (int64_t b = a; b < moments.columns; b++) line[b] = rules.forgetting * line[b] + share * now[b];
    }
}

void learn_around(ConstDoubles2 known, ConstDoubles2 field, Doubles2 moments, double step, PredictionRules rules,
    Doubles mean, Doubles row);
void follow_rows(ConstDoubles2 known, ConstInts2 levels, Doubles2 decoded, Doubles2 moments, double step,
    PredictionRules rules, Doubles2 factor, Doubles row, Doubles expected);

#endif
