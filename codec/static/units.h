#ifndef BSM_UNITS_H
#define BSM_UNITS_H

#include "bitstream/kernel.h"

int64_t back_into_unit(ConstDoubles2 positions, double scale, ConstDoubles center, Doubles2 moved);

#endif
