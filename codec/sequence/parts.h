/* Parts of a mesh whose frames move: what they hang on, and their dictionaries (specification, S 3, S 8.2). */
#pragma once

#include "codec/sequence/temporal.h"
#include "codec/basis/dictionaries.h"

/* A part of the mesh (S 3). */
typedef struct {
    Patch patch;
    Doubles springs, stiffness;
    Ints starts, outer, around; /* `outer`: which of the vertices `around` each spring goes to */
    Factor factor;
    /* columns of the dictionary; row of the first vertex around it, where rows of all parts are stacked */
    int64_t width, first;
    /* bytes that stay, and that making the dictionary takes; nanoseconds that it took, -1 before */
    double memory, making, work;
    Singles2 dictionary;  /* no rows unless it is kept */
    Mark before;
} Site;

/* All parts of a mesh, and their dictionaries as far as there is room. */
typedef struct {
    Context *context;
    const Header *header;
    const Graph *graph;
    const Blocks *blocks;
    Arena *arena;         /* what stays */
    Arena dictionaries;
    int64_t count, kept, rows, largest; /* parts; first ones whose dictionaries are kept; stacked rows */
    Site *part;
    double around, reserved, use, making;
} Parts;

bool find_parts(Parts *parts, ConstInts2 faces, ConstDoubles2 first_frame, Arena *scratch);
bool reserve_dictionaries(Parts *parts, double memory, double use, double *work);
void release_dictionaries(Parts *parts);
/* U of a part, until `scratch` is released or room is reserved again. */
bool lend_dictionary(Parts *parts, int64_t index, Arena *scratch, Singles2 *dictionary);
/* What continues a field into a part, of which `ends` are the rows around it. */
bool extend_part(const Site *part, ConstDoubles2 ends, Arena *scratch, Doubles2 extension);
