/* The kernels of blocks. */
#pragma once

#include "bitstream/kernel.h"

/* Words of scratch that a graph of `size` vertices takes. */
INLINE int64_t bisection_scratch(int64_t size) { return 17 * size + 5; }

bool bisect(ConstInts offsets, ConstInts neighbors, Ints order, Ints bounds, Words scratch);
void refine_partition(ConstInts offsets, ConstInts neighbors, Ints labels, int64_t passes, Longs sizes, Ints votes);
int64_t label_parts(ConstInts order, ConstInts bounds, Ints labels);
void group_by_label(ConstInts labels, Ints bounds, Ints order);
int64_t order_scratch(int64_t rows, int64_t edges);
int64_t order_block(ConstInts offsets, ConstInts neighbors, ConstInts rows, Ints vertices, Ints local_offsets,
                    Ints local_neighbors, Words scratch);
/* Vertices by their parts: `order` has those of part p from `bounds[p]` on; `labels` has the part of each. */
typedef struct {
    ConstInts order, bounds, labels;
} Partition;

/* Room for the pairs of parts that share edges: the other part, and how many edges. */
typedef struct {
    Ints ends;
    Longs edges;
} PartLinks;

/* Blocks in the order of their chain: the part that each grew from, its first member in `members`, and how many ends
 * of edges it sees. */
typedef struct {
    Ints chain;
    Longs starts, edges;
    Ints members;
} BlockChain;

int64_t chain_blocks(ConstInts offsets, ConstInts neighbors, Partition parts, int64_t size, PartLinks links,
    Longs scratch, Ints seen, BlockChain blocks);
int64_t find_cells(ConstInts offsets, ConstInts neighbors, int64_t reach, Bytes far, Ints waiting, Ints own);
int64_t link_cells(ConstInts offsets, ConstInts neighbors, ConstInts own, Ints bounds, Ints order, Ints filled,
    Ints found, Ints links, Ints ends);
int64_t cell_faces(ConstInts2 faces, ConstInts own, Ints counts, Ints2 triples, Ints order, Ints sorted, Ints2 kept);
void add_copies(Doubles2 sums, Doubles total, ConstInts vertices, ConstDoubles2 positions, ConstDoubles weights);
