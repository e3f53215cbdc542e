#ifndef BSM_GRAPH_H
#define BSM_GRAPH_H

#include "bitstream/kernel.h"

int64_t collect_edges(ConstInts2 faces, Ints offsets, Ints filled, Ints ends);
int64_t component_sizes(ConstInts offsets, ConstInts neighbours, Bytes seen, Ints waiting, Ints sizes);
int64_t reaches_all(ConstInts offsets, ConstInts neighbours, Ints scratch);

#endif
