#ifndef BSM_HOUSEHOLDER_H
#define BSM_HOUSEHOLDER_H

#include "bitstream/kernel.h"

void householder(Doubles2 work, Doubles scratch, Doubles2 q);

#endif
