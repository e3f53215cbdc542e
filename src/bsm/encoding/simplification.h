/* Fewer triangles. */
#pragma once

#include "codec/geometry/geometry.h"

/* Room for the work: of vertices their quadrics, where their faces begin, these, where they went in this pass, marks,
 * and who they are at the end; of wedges which they became; of edges their costs, and how many there are of each. */
typedef struct {
    Doubles2 quadrics;
    Longs starts;
    Ints around, ends, marks, joins, owners;
    Singles costs;
    Ints buckets;
} WorkingRoom;

int64_t simplify(Doubles2 positions, Ints2 faces, Ints2 wedges, Bytes states, WorkingRoom room, int64_t target,
    double along, double uneven);
