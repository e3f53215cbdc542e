/* The part of each vertex. See partition.py. */
#ifndef BSM_PARTITION_H
#define BSM_PARTITION_H

#include "bitstream/entropy/mixing.h"

int64_t code_labels(Coder coder, Bank bank, ConstInts offsets, ConstInts neighbours, Ints labels, int64_t parts);

#endif
