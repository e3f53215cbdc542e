/* Blocks as encoders step through them: what decoders do with each (codec/signal/decoding.h), levels in between. */
#pragma once

#include "codec/basis/basis.h"

/* One chain after the other, a part, or a graph alone: of an encoding, which has its errors. */
typedef struct CodedChain CodedChain;
struct PayloadWriter;
struct Payload;
/* Whether numbers are from `least` to below `bound`; whether each of those below it is among them. */
bool are_below(const int32_t *numbers, int64_t count, int64_t least, int64_t bound);
bool are_all_there(struct PayloadWriter *writer, const int32_t *numbers, int64_t count, int64_t bound);
CodedChain *open_chain(struct PayloadWriter *writer);
void close_chain(CodedChain *chain);

/* Of a graph: the part of each vertex; blocks of `size` vertices at most that grow from parts; and the rows of some of
 * its vertices in order, which `present_block` has. */
bool begin_graph(CodedChain *chain, ConstInts offsets, ConstInts neighbors);
bool label_graph(CodedChain *chain, int64_t parts, Ints labels);
typedef struct {
    ConstInts cores, members;
    ConstLongs starts, edges;
} GrownBlocks;
bool grow_parts(CodedChain *chain, ConstInts labels, int64_t parts, int64_t size, GrownBlocks *grown);
/* Cells around centers more than `reach` edges apart: the cell of each vertex, their graph and their faces. */
typedef struct {
    ConstInts own, offsets, neighbors;
    ConstInts2 faces;
} GraphCells;
bool cell_graph(CodedChain *chain, ConstInts2 faces, int64_t reach, GraphCells *cells);
/* The payload of parts that are numbered by their first vertices (C 10). */
bool write_labels(CodedChain *chain, ConstInts labels, int64_t parts, struct Payload *writing);
bool order_rows(CodedChain *chain, ConstInts members);
/* U of its L + shift after iterations of Algorithm 1 from a start. */
bool iterate_graph(CodedChain *chain, double shift, ConstSingles2 start, int64_t power, int64_t iterations,
    int64_t apart, Singles2 subspace);

/* The header's rules of dictionaries and chains; columns beyond half of `whole` rows are completed (M 8.7). Blocks have
 * levels for `width` columns at most. */
typedef struct {
    bool exact, springs;
    int power, iterations, key_iterations, apart;
    int64_t key_interval, whole, width;
    double shift;
} ChainRules;
/* All arrays stay with the caller, as long as the chain is used. */
bool begin_coded_chain(CodedChain *chain, ChainRules rules, ConstInts cores, ConstLongs starts, ConstLongs edges,
    ConstInts members);

/* A block that is not coded yet: its graph, the springs at its rows and their pulls, what continues those, and how much
 * its rows count in a blend. */
typedef struct {
    ConstInts vertices, offsets, neighbors;
    ConstDoubles springs, weights;
    ConstDoubles2 pulls, continued;
} CodedBlock;
bool begin_coded_block(CodedChain *chain, int64_t index);
const CodedBlock *present_block(const CodedChain *chain);
/* Decoders' work for a dictionary of so many columns, for the rest of this block, and their memory. */
typedef struct {
    double dictionary, rest, memory;
} BlockCosts;
BlockCosts costs_of_block(const CodedChain *chain, int64_t width);
/* U of this block, or one of the caller's: what the next functions take, until it is made again. */
bool make_coded_dictionary(CodedChain *chain, int64_t width);
bool give_dictionary(CodedChain *chain, ConstSingles2 own);
ConstSingles2 present_dictionary(const CodedChain *chain);
/* Write the levels nearest to coefficients, as `write_levels` of codec/signal/decoding.h. */
bool write_coded_block(CodedChain *chain, ConstDoubles2 prediction, ConstDoubles2 coefficients, double step, bool all,
    struct Payload *writing, int64_t *rows, Doubles2 positions);
/* Positions become what the next block knows, and the first `width` columns its predecessor's U. */
bool commit_coded_block(CodedChain *chain, int64_t width, ConstDoubles2 positions);

/* What all GOPs of a mesh share: the parts that blocks grew from, and the first values of attributes that move, side by
 * side in `starts`. `memory`: bytes that decoders keep, besides the dictionaries that they have room for. */
bool hang_parts(CodedChain *chain, ConstInts2 faces, ConstDoubles2 first_frame, ConstDoubles2 starts, ConstInts widths,
    double *memory);
/* Bytes for decoding a GOP whose fields have these widths and components. */
double memory_for_gop(const CodedChain *chain, int method, int64_t frames, ConstLongs2 fields);
/* Positions, or an attribute that moves, of a chain that stays, before the first GOP; or as another one is now. */
bool begin_track(CodedChain *track, const CodedChain *from, int64_t k);
/* Write a basis, of what is free in it, or the levels of a field (codec/sequence/gops.h); without rows it is not
 * coded. What is decoded lasts until the next call. */
bool write_track_basis(CodedChain *track, ConstInts exponents, ConstDoubles2 spectrum, struct Payload *writing,
    ConstDoubles2 *basis);
bool write_track(CodedChain *track, int method, int64_t frames, double step, int64_t back, ConstDoubles2 wanted,
    struct Payload *writing, ConstDoubles2 *field);
