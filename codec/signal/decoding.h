/* Blocks and levels to meshes (specification, M 7 to M 12, M 17). */
#pragma once

#include "bitstream/coefficients/coefficients.h"
#include "bitstream/container/container.h"
#include "bitstream/fields/fields.h"
#include "bitstream/payloads/payloads.h"
#include "codec/basis/patches.h"

/* Blocks to positions: what the blocks of a chain know of those before them (specification, M 7 to M 12). */

/* Sums of weight times position, and weights. */
typedef struct {
    Doubles2 sums;
    Doubles weights;
} Blended;

/* One chain after the other: memory of the mesh, and of a chain. */
typedef struct {
    Context *context;
    const Header *header;
    const Graph *graph;
    const Blocks *blocks;
    Arena chain, subspaces[2]; /* what the coder has learned; the present dictionary, and the next */
    int present;
    Singles2 subspace;         /* of the block before; no rows if there is none */
    bool knows;                /* whether blocks know of others' positions */
    Blended known;
    Bytes inside;
    int64_t number, first, next;
    bool elsewhere;            /* what the chain has learned is not here: its blocks were decoded ahead */
    Bank bank;
    Past past;
    Ints expectations;
} Chains;

/* A block whose levels have not been read yet: its patch, its weights in a blend, the springs to known positions around
 * it, and the smooth continuation of these positions. */
typedef struct {
    Patch patch;
    Doubles weights, springs;
    Doubles2 pulls, continued;
    Factor factor;
} Suspended;

/* A block's own reconstruction, in BSM units; its arrays live until `scratch` is released. */
typedef struct {
    int64_t index;
    ConstInts vertices;
    ConstDoubles2 positions;
    ConstDoubles weights;
} DecodedBlock;

/* Copy a block into `arena`; without memory the arena's context has failed. */
bool copy_block(const DecodedBlock *block, Arena *arena, DecodedBlock *copy);
/* A block that was decoded ahead: the contents of its packet, where it ended, and the charges to make in its turn. */
typedef struct {
    int64_t index, coefficients, end;
    Span data;
    bool done;
    DecodedBlock block;
    Ledger ledger;
} ReadyBlock;

bool begin_chains(Chains *chains, Context *context, const Header *header, const Graph *graph, const Blocks *blocks,
    Arena *arena);
void end_chains(Chains *chains);
bool decode_block(Chains *chains, int64_t index, int64_t coefficients, Span payload, Arena *scratch,
    DecodedBlock *decoded);
/* The steps of decoding a block, which encoders also take: its surroundings, U in memory of the chain, and what the
 * next block knows of it. */
bool begin_chain(Chains *chains, int64_t number);
bool make_dictionary(Chains *chains, const Suspended *block, int64_t width, Arena *scratch, Singles2 *dictionary);
void commit_block(Chains *chains, Singles2 dictionary, const DecodedBlock *decoded);
#ifdef BSMDEC_WRITES
bool hang_block(Chains *chains, int64_t index, Arena *scratch, Suspended *block);
/* Leave the first columns of a dictionary. */
Singles2 first_columns(Singles2 dictionary, int64_t width);
/* Write the levels nearest to coefficients, in steps of the header: all `rows`, or those up to the last that is not 0;
 * and place the block as decoders will. */
bool write_levels(Chains *chains, ConstDoubles2 prediction, ConstSingles2 dictionary, ConstDoubles2 coefficients,
    bool all, Arena *scratch, int64_t *rows, Doubles2 positions);
#endif
/* Forget the chain under way: the next block begins one. */
void leave_chain(Chains *chains);
/* Count a block as decoded that other chains decoded, and make its charges. */
bool settle_block(Chains *chains, int64_t index, const Ledger *ledger);

/* Blocks put together to a mesh (specification, M 12). */
typedef struct {
    Blended blend;
    Bytes lost;  /* vertices of blocks that were lost */
    Bytes added; /* blocks that were added */
    bool lossy;
} Assembly;

bool begin_assembly(Assembly *assembly, int64_t vertices, int64_t blocks, Arena *arena);
void add_block(Assembly *assembly, const DecodedBlock *block);
void lose_block(Assembly *assembly, const Blocks *blocks, int64_t index);
/* All positions in BSM units, smoothed; unknown ones are 0. */
bool blend_all(const Assembly *assembly, const Header *header, const Graph *graph, Arena *arena, Arena *scratch,
    Doubles2 *positions);
/* Marks of the vertices that are as the encoder had them, they and those at most `beyond` edges away; no array if all
 * are. */
bool mark_whole(const Assembly *assembly, const Header *header, const Graph *graph, Arena *arena, Arena *scratch,
    int beyond, Bytes *whole);
/* Mark the neighbors of marked vertices, a number of times. */
bool spread_marks(const Graph *graph, Bytes marks, int rings, Arena *scratch);
/* Places of cells spread to vertices, in BSM units (M 18.7). */
bool prolong_cells(const CellMesh *cells, const Graph *graph, ConstDoubles2 places, int rounds, Arena *arena,
    Arena *scratch, Doubles2 *positions);
/* The same of some vertices alone. */
bool prolong_some(const CellMesh *cells, const Graph *graph, ConstDoubles2 places, int rounds, ConstInts vertices,
    Arena *arena, Arena *scratch, Doubles2 *positions);
/* Marks of the vertices whose cells, and those at most `rings` edges away, are marked; no array if all cells are. */
bool mark_prolonged(const CellMesh *cells, const Graph *graph, ConstBytes marked, int rings, Arena *arena,
    Arena *scratch, Bytes *whole);
/* Let cells whose weights are 0 have the places of near ones. */
bool fill_unknown(const Graph *graph, ConstDoubles weights, Arena *scratch, Doubles2 places);
/* From BSM units to the unit of the mesh, in place (M 12.5). */
bool into_unit(Context *context, const Header *header, Doubles2 positions);

/* Levels that refine what blocks decoded to (specification, V 11, M 17). */

/* What levels refine. */
typedef struct {
    Doubles2 base, frames; /* positions in BSM units, and their local frames */
    Bytes whole;           /* vertices that are as the encoder had them; empty: all */
} Refined;

/* What a layer is on: vertices, or cells (M 18.6). */
typedef struct {
    ConstInts2 faces;
    int64_t vertices;
    double step, ratio;
} LayerPlan;

enum { RATIO_OF_CELLS = 3 };
INLINE LayerPlan plan_of_layer(const Header *header, ConstInts2 faces) {
    return (LayerPlan){faces, header->vertices, header->refinement[0], header->refinement[1]};
}
INLINE LayerPlan plan_of_cells(const Header *header, ConstInts2 faces) {
    double step = 1.0;
    for (int i = 0; i < header->base.halvings; i++) step *= 0.5;
    return (LayerPlan){faces, header->base.cells, step, RATIO_OF_CELLS};
}

/* A mesh of blocks, refined by levels. */
typedef struct {
    Context *context;
    LayerPlan plan;
    Arena own, models; /* levels; models of later levels, given back after the last */
    Corners corners;
    Bank bank;
    Levels levels;
    Refined refined;
    Doubles2 positions;
    int64_t read, coded; /* vertices whose levels are known, and those that are moved */
    bool begun, lossy;
} Layer;

/* What levels are read with; it needs faces alone. */
bool begin_levels(Layer *layer, Context *context, LayerPlan plan, Arena *scratch);
void end_layer(Layer *layer);
/* Frames of the base, if there may be so large a layer. */
bool find_frames(Context *context, ConstInts2 faces, Arena *arena, Refined *refined);
/* `layer` is zero, or its levels are begun; `refined` is the layer's from here on. */
bool begin_layer(Layer *layer, Context *context, LayerPlan plan, Refined refined, Arena *arena, Arena *scratch);
bool code_layer(Layer *layer, int64_t first, int64_t count, Span payload);
bool decode_layer(Layer *layer, int64_t first, int64_t count, Span payload, Arena *scratch);
/* Do without the levels that are missing: others move what they can (F 8). */
bool close_layer(Layer *layer, Arena *arena, Arena *scratch);

/* Marks of the vertices whose steps follow from whole ones alone; empty: all. */
bool fit_vertices(const Layer *layer, Arena *scratch, Bytes *fit);
