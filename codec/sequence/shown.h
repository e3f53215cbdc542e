#ifndef BSM_SHOWN_H
#define BSM_SHOWN_H

#include "bitstream/kernel.h"

int64_t LEVEL(show_frames)(ConstDoubles2 field, int64_t first, ConstDoubles2 weights, Doubles2 frames);

#endif
