/* The conquest: triangle by triangle over a closed surface (specification, C 6). See conquest.py. */
#ifndef BSM_CONQUEST_H
#define BSM_CONQUEST_H

#include "bitstream/connectivity/valence_model.h"

typedef struct {
    ConstInts twin, corner, valence, vertex;
} Surface;

/* What only the encoder knows; a decoder has empty arrays. */
typedef struct {
    Surface surface;
    Bytes conquered;
    Ints node, number, fans, faces;
} Guide;

/* What both sides know; tallies: vertices, real vertices and faces so far; dummies, triangles and steps along the front
 * still allowed; first face that the encoder may have left; label of the latest real vertex. */
typedef struct {
    Front front;
    Longs2 vertices;
    Ints2 faces;
    Longs tallies;
} Conquest;

/* How a call ends; without room, make some and call again. */
enum { CONQUEST_DONE, CONQUEST_NONSENSE, CONQUEST_NO_ROOM };

int64_t conquer(Coder coder, Models models, Guide guide, Conquest conquest);

#endif
