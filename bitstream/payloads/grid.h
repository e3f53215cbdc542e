/* Positions on a grid (specification, V 7 to V 10, V 12, V 15 to V 17). */
#pragma once

#include "bitstream/fields/twins.h"
#include "bitstream/container/header.h"

/* Positions on a grid, and their models. */
typedef struct {
    Context *context;
    const Header *header;
    ConstInts2 faces;
    Corners corners;
    ValueModel model;
    Grid grid;
    Light light;
    Floats floats;
    Twins *twins;
    Ints2 transforms; /* as they are coded */
    Ints largest, order;
    Ints2 values;
    Doubles2 positions; /* in the unit of the mesh */
    int64_t coded;
    bool broken;
} GridField;

/* Numbers of floats in their order (V 16.1). */
INLINE int64_t number_of_float(double value) {
    float single = (float)value;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    return bits >> 31 ? (int64_t)INT32_MAX - (int64_t)bits : (int64_t)bits;
}

/* Begin, in full as another on the same faces, of which it has the corners; NULL: on its own. */
bool begin_grid(GridField *field, const GridField *like, Context *context, const Header *header, ConstInts2 faces,
    Arena *arena, Arena *scratch);
bool code_grid_values(GridField *field, int64_t first, int64_t count, Span payload);
bool place_floats(GridField *field, ConstInts vertices, Span payload, Arena *scratch);
bool decode_grid(GridField *field, int64_t first, int64_t count, Span payload, Arena *scratch);
