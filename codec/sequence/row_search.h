/* Choosing the levels of a closed loop. See row_search.py. */
#ifndef BSM_ROW_SEARCH_H
#define BSM_ROW_SEARCH_H

#include "codec/sequence/row_prediction.h"

void search_rows(ConstDoubles2 known, ConstDoubles2 targets, ConstShorts prices, double weight, Ints2 levels,
    Doubles2 decoded, Doubles2 moments, double step, PredictionRules rules, Doubles2 factor, Doubles row,
    Doubles2 expected, Doubles2 values, Ints2 ways, Bytes2 origins);

#endif
