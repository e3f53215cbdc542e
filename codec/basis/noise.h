#ifndef BSM_NOISE_H
#define BSM_NOISE_H

#include "bitstream/kernel.h"

void hash_columns(Doubles2 columns);

#endif
