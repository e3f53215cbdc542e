/* Values of attributes on vertices. See values.py, values.c, and for each kind scalars.c, texcoords.c, normals.c. */
#ifndef BSM_ATTRIBUTE_VALUES_H
#define BSM_ATTRIBUTE_VALUES_H

#include "bitstream/fields/corners.h"
#include "bitstream/fields/seen.h"
#include "bitstream/fields/value.h"

enum {
    MOST_COMPONENTS = 4,
    VALENCES = 6,
    BASES = 4, /* numbers of known edges that are told apart: 0 to 3 or more */
};

/* As Python keeps it; n vertices of c components. */
typedef struct {
    ConstInts largest;   /* c: values of each component are 0 .. largest, below 2^20 */
    ConstInts order;     /* n: vertices as they are coded */
    ConstInts twin;      /* n: the next vertex at the same place, in a ring */
    ConstInts2 geometry; /* n x 3: where the vertices are; or 0 x 3, if that is not known */
    Ints2 values;        /* n x c */
    Ints2 gaps;          /* n x c: value less guess, in 1/16 */
    Longs2 sums;         /* n x (c + 1): values of the known neighbours, added, and how many they are */
    Longs2 seen;         /* c x words: bit v of a component tells that it has taken the value v */
    Longs2 learners;
    Ints2 directions;    /* normals: n x 12, their own, and what the surface tells */
    Longs chart;         /* texture coordinates: 2, see texcoords.c */
} Values;

typedef struct { /* what codes a vertex needs to know */
    RangeCoder coder;
    ValueModel model;
    Corners corners;
    Values values;
} Work;

/* Code vertex v; `last` is the one before it, or -1. False if a value is none. */
typedef bool CodeVertex(Work *work, int32_t v, int32_t last);

int64_t code_vertices(Coder given, Work *work, int64_t learners, int64_t first, int64_t count, CodeVertex *code_vertex);
void keep_value(const Values *values, int32_t v, int component, int32_t value);

int64_t expect_normals(Corners corners, Values values);
int64_t code_scalars(Coder coder, ValueModel model, Corners corners, Values values, int64_t first, int64_t count);
int64_t code_texcoords(Coder coder, ValueModel model, Corners corners, Values values, int64_t first, int64_t count);
int64_t code_normals(Coder coder, ValueModel model, Corners corners, Values values, int64_t first, int64_t count);

INLINE int32_t value_at(const Values *g, int32_t v, int j) { return g->values.data[g->values.columns * v + j]; }
INLINE int32_t near_seen(const Values *g, int j, int32_t v) {
    return nearest_seen(g->seen.data + j * g->seen.columns, g->seen.columns, v);
}
INLINE int32_t gap_at(const Values *g, int32_t v, int j) { return g->gaps.data[g->gaps.columns * v + j]; }

#endif
