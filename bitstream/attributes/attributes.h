/* Values of attributes: where they are, what foretells them, and the kernels of this room. */
#pragma once

#include "bitstream/fields/fields.h"

/* An edge, as seen by the corner that faces it; OPEN: none faces it from beyond, and nothing is shared across it. */
enum { NO_SEAM, SEAM, OPEN, UNKNOWN };

/* Values of attributes on vertices. See values.c, and for each kind scalars.c, texcoords.c, normals.c. */
enum {
    MOST_COMPONENTS = 4,
    MOST_WHOLE = (1 << 20) - 1, PIECE_BITS = 16, /* larger values are coded in two pieces, the second of these bits */
    BASES = 4, /* classes by number of known edges: 0 to 3 or more */
};

/* n vertices of c components. */
typedef struct {
    ConstInts largest;   /* c: values of each component are 0 .. largest, below 2^20 */
    ConstInts order;     /* n: vertices as they are coded */
    ConstInts twin;      /* n: the next vertex at the same place, in a ring */
    ConstInts2 geometry; /* n x 3: where the vertices are; or 0 x 3, if that is not known */
    Ints2 values;        /* n x c */
    Ints2 gaps;          /* n x c: value less guess, in 1/16 */
    Longs2 sums;         /* n x (c + 1): values of the known neighbors, added, and how many they are */
    Longs2 seen;         /* c x words: bit v of a component tells that it has taken the value v */
    Longs2 learners;
    Ints2 directions;    /* normals: n x 12, their own, and what the surface tells */
    Longs chart;         /* texture coordinates: 2, see texcoords.c */
} Values;

typedef struct Work Work;
/* Code vertex v; `last` is the one before it, or -1. False if a value is invalid. */
typedef bool CodeVertex(Work *work, int32_t v, int32_t last);

struct Work { /* what codes a vertex needs to know */
    RangeCoder *coder;
    ValueModel model;
    Corners corners;
    Values values;
    CodeVertex *code;
};

int64_t code_vertices(Work *work, int64_t first, int64_t count);
void keep_value(const Values *values, int32_t v, int component, int32_t value);

int64_t expect_normals(Corners corners, Values values);
bool code_scalar(Work *work, int32_t v, int32_t last);
bool code_texcoord(Work *work, int32_t v, int32_t last);
bool code_normal(Work *work, int32_t v, int32_t last);

INLINE int32_t value_at(const Values *g, int32_t v, int j) { return g->values.data[g->values.columns * v + j]; }
INLINE int32_t near_seen(const Values *g, int j, int32_t v) {
    return nearest_seen(g->seen.data + j * g->seen.columns, g->seen.columns, v);
}
INLINE int32_t gap_at(const Values *g, int32_t v, int j) { return g->gaps.data[g->gaps.columns * v + j]; }

/* The learners of a component: one for each number of bases and valence, then one for each number of bases. */
INLINE void choose_learners(Forecast *f, const Values *g, int components, int j, int number, int valence) {
    Learner *learners = (Learner *)g->learners.data;
    f->guess = learners + (j * BASES + number) * VALENCES + valence;
    f->size = learners + components * BASES * VALENCES + j * BASES + number;
}

/* What is known around a vertex before its values. See values.c. */
enum { MOST_BASES = 8, MOST_TWINS = 8 };

/* An edge of the vertex's triangles of which both ends are known. */
typedef struct {
    int32_t a, b, c, tip; /* c: the known vertex beyond it, or -1; tip: its corner */
    int32_t error;
} Base;

typedef struct {
    Around around;
    int bases, number, valence; /* number: of bases, capped */
    Base base[MOST_BASES];      /* best-behaved first */
    int32_t twin;               /* the known vertex at this place that was coded last, or -1 */
    int32_t error;              /* mean size of the gaps around, or -1 */
} Place;

void survey_values(const Work *work, int32_t v, Place *place);
int32_t fold_at(const Work *work, int32_t v, const Base *base, int component);
int32_t gap_classes(const Work *work, const Place *place, int component, int32_t unit);
int64_t square_root(uint64_t x);

/* Values of attributes on faces. See faces.c. */
/* m faces of c components. */
typedef struct {
    ConstInts largest; /* c: values of each component are 0 .. largest, below 2^20 */
    Ints2 values;      /* m x c */
    Ints2 gaps;        /* m x c: value less guess, in 1/16 */
    Ints2 memory;      /* c x 257: what came last in each of 256 contexts, and one more than the greatest so far */
} FaceValues;

int64_t code_faces(
    RangeCoder *coder, ValueModel model, Corners corners, FaceValues values, int64_t first, int64_t count);

/* Edges across which an attribute changes, and the corners that share a value. See seams.c. */
extern INSIDE const BankPlan EDGE_BANK;
void code_edges(
    RangeCoder *coder, const Bank *bank, const Corners *corners, uint8_t *seam, const uint8_t *others, Ints2 ends);
int64_t join_corners(Corners corners, ConstBytes seams, Ints joined, Ints first);
int32_t first_joined(int32_t *joined, int32_t k);
void join_two(int32_t *joined, int32_t a, int32_t b);
