#ifndef BSM_OVERLAP_H
#define BSM_OVERLAP_H

#include "bitstream/kernel.h"

int64_t grow_blocks(ConstInts offsets, ConstInts neighbours, ConstInts order, ConstInts bounds, ConstInts chain,
                    int64_t size, Ints seen, Longs starts, Ints members);
int64_t order_scratch(int64_t rows, int64_t edges);
int64_t order_block(ConstInts offsets, ConstInts neighbours, ConstInts rows, Ints vertices, Ints local_offsets,
                    Ints local_neighbours, Words scratch);
bool chain_parts(ConstLongs starts, ConstInts ends, ConstLongs edges, Longs shared, Longs seen, Ints trail,
                 Bytes visited, Ints chain);
int64_t chain_blocks(ConstInts offsets, ConstInts neighbours, ConstInts order, ConstInts bounds, ConstInts labels,
                     int64_t size, Ints links, Longs shares, Longs scratch, Ints seen, Ints chain, Longs starts,
                     Longs edges, Ints members);

#endif
