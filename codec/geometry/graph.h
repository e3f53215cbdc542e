#ifndef BSM_GRAPH_H
#define BSM_GRAPH_H

#include "bitstream/kernel.h"

/* Whether there are as many neighbours as the offsets of a graph say. */
INLINE bool fits_graph(ConstInts offsets, ConstInts neighbours) {
    return offsets.size > 0 && offsets.data[offsets.size - 1] >= 0 && neighbours.size >= offsets.data[offsets.size - 1];
}

int64_t collect_edges(ConstInts2 faces, Ints offsets, Ints filled, Ints ends);
int64_t component_sizes(ConstInts offsets, ConstInts neighbours, Bytes seen, Ints waiting, Ints sizes);
int64_t reaches_all(ConstInts offsets, ConstInts neighbours, Ints scratch);

#endif
