/* Faces, and the part that each vertex is in (specification, C 4 to C 8, C 10). */
#ifndef BSMDEC_TOPOLOGY_H
#define BSMDEC_TOPOLOGY_H

#include "engine/structure.h"

bool decode_connectivity(Context *context, Span payload, const Header *header, Arena *arena, Arena *scratch,
    Ints2 *faces);
bool decode_labels(Context *context, Span payload, const Graph *graph, int64_t parts, Arena *scratch, Ints labels);

#endif
