/* Levels that refine what blocks decoded to (specification, V 11, M 17). */
#ifndef BSMDEC_LAYER_H
#define BSMDEC_LAYER_H

#include "bitstream/fields/fields.h"
#include "engine/header.h"

/* A mesh of blocks, refined by levels. */
typedef struct {
    Context *context;
    const Header *header;
    ConstInts2 faces;
    Arena own, models; /* levels; what only levels to come need, given back behind the last */
    Corners corners;
    Bank bank;
    Levels levels;
    Doubles2 base, positions, frames; /* in BSM units */
    Bytes whole;                      /* vertices that are as the encoder had them; empty: all */
    int64_t read, coded;              /* vertices whose levels are known, and those that are moved */
    bool begun, lossy;
} Layer;

/* What levels are read with; it needs faces alone. */
bool begin_levels(Layer *layer, Context *context, const Header *header, ConstInts2 faces, Arena *scratch);
void end_layer(Layer *layer);
/* `layer` is zero, or its levels are begun; `base` is the layer's from here on; `whole` as above. */
bool begin_layer(Layer *layer, Context *context, const Header *header, ConstInts2 faces, Doubles2 base, Bytes whole,
    Arena *arena, Arena *scratch);
bool decode_layer(Layer *layer, int64_t first, int64_t count, Span payload, Arena *scratch);

/* Marks of the vertices whose steps follow from whole ones alone; empty: all. */
bool fit_vertices(const Layer *layer, Arena *scratch, Bytes *fit);

#endif
