/* The graph of a mesh, its blocks and their patches (specification, M 2 to M 6). */
#pragma once

#include "codec/basis/basis.h"
#include "bitstream/container/header.h"

typedef struct {
    int64_t size;
    ConstInts offsets, neighbors;
} Graph;

/* All blocks of a mesh, in the order of their chain. */
typedef struct {
    int64_t count;
    Ints cores;      /* vertices of the part that each grew from: the first of its members */
    Longs starts, edges;
    Ints members;
} Blocks;

/* One block, or the part of one: its vertices row after row, and L among them. */
typedef struct {
    int64_t size;
    ConstInts vertices, offsets, neighbors;
    ConstDoubles weights; /* of the entries of `neighbors`; empty: all are 1 */
    Doubles diagonal;
    Fronts fronts;
} Patch;

bool make_graph(Ints2 faces, int64_t size, Arena *arena, Arena *scratch, Graph *graph);
/* The part of each vertex that follows from the graph alone (M 4). */
bool derive_labels(Context *context, const Graph *graph, int64_t parts, Arena *scratch, Ints labels);
/* `labels`: the part of each vertex, or no array for what follows from the graph. */
bool make_blocks(Context *context, const Header *header, const Graph *graph, Ints labels, Arena *arena, Arena *scratch,
    Blocks *blocks);
/* Order the rows of a block of these vertices (M 6), and find what its factorization needs. */
bool order_patch(const Graph *graph, ConstInts members, Arena *arena, Patch *patch);
bool find_patch_fronts(Context *context, Arena *arena, Patch *patch);
/* Members of a block, or the `count` first of them. */
INLINE ConstInts members_of(const Blocks *blocks, int64_t index, int64_t count) {
    return (ConstInts){blocks->members.data + blocks->starts.data[index], count};
}
INLINE int64_t size_of_block(const Blocks *blocks, int64_t index) {
    return blocks->starts.data[index + 1] - blocks->starts.data[index];
}
