/* Integers on vertices: positions on a grid, and levels that refine what blocks decoded to (specification, V, M 17). */
#ifndef BSMDEC_FIELDS_H
#define BSMDEC_FIELDS_H

#include "bitstream/fields/fields.h"
#include "engine/charges.h"
#include "engine/coding.h"

/* Corners of faces, their partners, and the rank of each vertex, which is its number until it is ordered (V 1). */
bool link_mesh(Context *context, ConstInts2 faces, int64_t vertices, Arena *arena, Arena *scratch, Corners *corners);
bool order_mesh(Corners *corners, Arena *arena, Arena *scratch, Ints *order);
/* Models and learners that have learnt nothing (V 4.3, V 6.1); a learner starts from the weights of its row of `starts`. */
MUST_CHECK bool make_value_model(Arena *arena, ValueModel *model);
MUST_CHECK bool make_learners(Arena *arena, int64_t count, Longs2 *learners);
INLINE void start_learner(Longs2 learners, int64_t k, int term, int64_t weight) {
    Learner *learner = (Learner *)learners.data + k;
    learner->weight[term] = learner->start[term] = weight;
}
/* What a kernel of values says of a payload: how many of `count` it has done. */
bool check_chunk_done(const Reading *reading, int64_t done, int64_t count);

/* Positions on a grid, and what is learnt of them. */
typedef struct {
    Context *context;
    const Header *header;
    ConstInts2 faces;
    Corners corners;
    ValueModel model;
    Grid grid;
    Light light;
    Floats floats;
    Ints largest, order;
    Ints2 values;
    Doubles2 positions; /* in the unit of the mesh */
    int64_t coded;
    bool broken;
} GridField;

bool begin_grid(GridField *field, Context *context, const Header *header, ConstInts2 faces, Arena *arena, Arena *scratch);
bool decode_grid(GridField *field, int64_t first, int64_t count, Span payload, Arena *scratch);

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
bool begin_layer(Layer *layer, Context *context, const Header *header, ConstInts2 faces, Doubles2 base, Bytes whole, Arena *arena, Arena *scratch);
bool decode_layer(Layer *layer, int64_t first, int64_t count, Span payload, Arena *scratch);

/* Marks of the vertices whose steps follow from whole ones alone; empty: all. */
bool fit_vertices(const Layer *layer, Arena *scratch, Bytes *fit);

#endif
