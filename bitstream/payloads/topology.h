/* Faces, and the part that each vertex is in (specification, C 4 to C 8, C 10). */
#pragma once

#include "bitstream/connectivity/connectivity.h"
#include "bitstream/container/header.h"

/* Known to a writer only; all 0 for a reader. */
typedef struct {
    int64_t repeated, lonely, surplus, dummies; /* the counts of C 4.3 */
    Guide guide;
    int32_t *vertex;       /* of each fan */
    Ints used;             /* room for the vertices of fans, then those of faces that repeat a corner */
    Ints order, number;    /* of each vertex: room for those in the order of coding, and the place of each there */
} Surface;

bool code_connectivity(Context *context, Span payload, const Header *header, const Surface *surface, Arena *arena,
    Arena *scratch, Ints2 *faces);
/* `offsets`, `neighbors`: of the graph of a mesh. */
bool code_partition(Context *context, Span payload, ConstInts offsets, ConstInts neighbors, int64_t parts,
    Arena *scratch, Ints labels);
