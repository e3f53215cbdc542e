#ifndef BSM_PARTITION_H
#define BSM_PARTITION_H

#include "bitstream/kernel.h"

void refine_partition(ConstInts offsets, ConstInts neighbours, Ints labels, int64_t passes, Longs sizes, Ints votes);
int64_t label_parts(ConstInts order, ConstInts bounds, Ints labels);
void group_by_label(ConstInts labels, Ints bounds, Ints order);

#endif
