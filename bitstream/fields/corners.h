/* What both sides know of a mesh before its values: the corners at each vertex, and those beyond its edges. */
#ifndef BSM_CORNERS_H
#define BSM_CORNERS_H

#include "bitstream/kernel.h"

enum { MOST_NEIGHBOURS = 16, MOST_FLAPS = 8 };

/* Corner k is corner k % 3 of face k / 3. Made by link_corners and order_vertices, which check. */
typedef struct {
    ConstInts2 faces; /* m x 3 */
    Ints starts;      /* n + 1: where the corners of each vertex begin in `corners` */
    Ints corners;     /* 3 m, ascending at each vertex */
    Ints opposite;    /* 3 m: the corner that faces the same edge from the other side, or -1 */
    Ints rank;        /* n: when each vertex is coded */
} Corners;

/* Two coded ends of an edge, and the coded vertex behind it as seen from the vertex to be coded. */
typedef struct {
    int32_t a, b, c, corner; /* the corner at c */
} Flap;

typedef struct { /* what is coded around a vertex */
    int neighbours, flaps;
    int32_t neighbour[MOST_NEIGHBOURS];
    Flap flap[MOST_FLAPS];
} Around;

INLINE int32_t next_corner(int32_t k) { return k % 3 == 2 ? k - 2 : k + 1; }
INLINE int32_t previous_corner(int32_t k) { return k % 3 == 0 ? k + 2 : k - 1; }
INLINE int32_t faces_at(const Corners *c, int32_t v) { return c->starts.data[v + 1] - c->starts.data[v]; }

bool fits_corners(const Corners *corners);
void gather_around(const Corners *corners, int32_t v, Around *around);

int64_t link_corners(Corners corners, Ints scratch);
int64_t order_vertices(Corners corners, Ints order, Ints2 scratch);

#endif
