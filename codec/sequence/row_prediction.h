#ifndef BSM_ROW_PREDICTION_H
#define BSM_ROW_PREDICTION_H

#include "bitstream/kernel.h"

/* The constants of row_prediction.py. */
typedef struct {
    double forgetting, ridge, noise, largest_level;
    int64_t dense_rows, renewal;
} PredictionRules;

void follow_rows(ConstDoubles2 known, ConstDoubles2 targets, Ints2 levels, Doubles2 decoded, Doubles2 moments, double step,
                 double rounding, bool encoding, PredictionRules rules, Doubles2 factor, Doubles row, Doubles expected);

#endif
