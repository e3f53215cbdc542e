#ifndef BSM_COSINES_H
#define BSM_COSINES_H

#include "bitstream/kernel.h"

void LEVEL(cosines)(int64_t first, Doubles table, Doubles2 columns);
void LEVEL(resize_columns)(ConstDoubles2 previous, Doubles table, Doubles2 columns);

#endif
