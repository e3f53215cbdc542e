/* Levels that refine what blocks decoded to (specification, V 11, M 17). */
#pragma once

#include "bitstream/fields/fields.h"
#include "bitstream/container/container.h"

/* What levels refine. */
typedef struct {
    Doubles2 base, frames; /* positions in BSM units, and their local frames */
    Bytes whole;           /* vertices that are as the encoder had them; empty: all */
} Refined;

/* A mesh of blocks, refined by levels. */
typedef struct {
    Context *context;
    const Header *header;
    ConstInts2 faces;
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
bool begin_levels(Layer *layer, Context *context, const Header *header, ConstInts2 faces, Arena *scratch);
void end_layer(Layer *layer);
/* Frames of the base, if there may be so large a layer. */
bool find_frames(Context *context, ConstInts2 faces, Arena *arena, Refined *refined);
/* `layer` is zero, or its levels are begun; `refined` is the layer's from here on. */
bool begin_layer(Layer *layer, Context *context, const Header *header, ConstInts2 faces, Refined refined, Arena *arena,
    Arena *scratch);
bool code_layer(Layer *layer, int64_t first, int64_t count, Span payload);
bool decode_layer(Layer *layer, int64_t first, int64_t count, Span payload, Arena *scratch);

/* Marks of the vertices whose steps follow from whole ones alone; empty: all. */
bool fit_vertices(const Layer *layer, Arena *scratch, Bytes *fit);
