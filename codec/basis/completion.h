#ifndef BSM_COMPLETION_H
#define BSM_COMPLETION_H

#include "bitstream/kernel.h"

int64_t LEVEL(completion_space)(int64_t h);
int64_t LEVEL(complete_columns)(ConstDoubles2 first, double least_pivot, Doubles scratch, Doubles2 whole);

#endif
