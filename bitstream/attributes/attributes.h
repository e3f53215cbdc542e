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
/* The square root of x, 0 .. 2^62, rounded down. */
INLINE int64_t square_root(int64_t x) {
    int64_t root = (int64_t)__builtin_sqrt((double)x);
    while (root * root > x) root--; /* a double has 53 bits of x */
    while ((root + 1) * (root + 1) <= x) root++;
    return root;
}
/* x / n, towards zero, of numbers below 2^53: faster than a division of integers, and exact, too. */
INLINE int64_t quotient(int64_t x, int64_t n) { return (int64_t)((double)x / (double)n); }

/* Directions, on an octahedron (A 6.1, A 6.2). */
/* Numbers whose absolute values add up to 16 times the size of the octahedron, or nearly. */
typedef struct {
    int32_t axis[3];
} Direction;

typedef struct { /* the octahedron as seen from the axis that is nearest to a direction */
    int first, second, pole, sign;
    int32_t size; /* 16 times that of the octahedron */
} View;

enum { RIGHT_ANGLE = 1 << 12 };
INLINE int32_t middle(const Values *g) { return g->largest.data[0] / 2; }
INLINE Direction scaled_direction(const int64_t *x, int32_t size) {
    int64_t most = 0, sum = 0;
    Direction d = {{0, 0, size}};
    for (int j = 0; j < 3; j++) most = largest(most, largest(x[j], -x[j]));
    int shift = 0;
    while (most >> shift >= 1 << 28) shift++;
    for (int j = 0; j < 3; j++) sum += largest(x[j] >> shift, -(x[j] >> shift));
    for (int j = 0; j < 3 && sum > 0; j++) d.axis[j] = divided((x[j] >> shift) * size, (int32_t)sum);
    return d;
}

/* The lower half of the octahedron, folded outwards: it is the same both ways. */
INLINE void fold_out(int32_t *x, int32_t *y, int32_t size) {
    int32_t u = size - size_of(*y), w = size - size_of(*x);
    *x = *x < 0 ? -u : u;
    *y = *y < 0 ? -w : w;
}

INLINE View view_from(const Direction *d, int32_t size) {
    int pole = 0;
    for (int j = 1; j < 3; j++)
        if (size_of(d->axis[j]) > size_of(d->axis[pole])) pole = j;
    return (View){(pole + 1) % 3, (pole + 2) % 3, pole, d->axis[pole] < 0 ? -1 : 1, size};
}

INLINE void see(const View *view, const Direction *d, int32_t *pair) {
    pair[0] = d->axis[view->first], pair[1] = d->axis[view->second];
    if (d->axis[view->pole] * view->sign < 0) fold_out(&pair[0], &pair[1], view->size);
}

/* Twin of `see`, for points of the octahedron. */
INLINE Direction seen_as(const View *view, const int32_t *pair) {
    int32_t x = pair[0], y = pair[1], height = view->size - size_of(x) - size_of(y);
    if (height < 0) fold_out(&x, &y, view->size);
    Direction d;
    d.axis[view->first] = x, d.axis[view->second] = y, d.axis[view->pole] = height * view->sign;
    return d;
}

/* The angle that has this dot product and this length of the vector product, nearly. */
INLINE int64_t angle_of(int64_t dot, int64_t across) {
    int64_t along = largest(dot, -dot), high = largest(along, across);
    int64_t t = high > 0 ? least(along, across) * RIGHT_ANGLE / high : 0;
    int64_t angle = t * (RIGHT_ANGLE / 2 + ((RIGHT_ANGLE - t) * 711 >> 12)) >> 12;
    if (across > along) angle = RIGHT_ANGLE - angle;
    return dot < 0 ? 2 * RIGHT_ANGLE - angle : angle;
}

/* Where a base says that a vertex is in texture coordinates (A 5.3). */
typedef struct { /* in 1/16 */
    int32_t similar[2], affine[2], across[2];
    int32_t weight;
} Claim;

/* Which way round a, b, c are. */
int turn_of(const Values *values, int32_t a, int32_t b, int32_t c);
/* By the shape of the vertex's triangle, by that of the triangle beyond the edge, and by its parallelogram. */
Claim claim_of(const Values *values, int32_t v, const Base *base);

/* Values that are quick to decode (A 9). See swift.c. */
enum { SWIFT_TALLIES = 4, SWIFT_CONTEXTS = 512 };
typedef struct {
    Corners corners;
    Values own;           /* of which largest, geometry, values and chart are used */
    Ints2 tallies;        /* n x 4: how far each candidate was off, and the guess, in 1/16 */
    Ints2 directions;     /* normals: n x 6, their own, and what the surface tells */
    Words slots;          /* for each component as many */
    Ints weights;         /* of mixed decisions, LEAN_NODES x LEAN_INPUTS for each component */
    int64_t slots_of_one;
    bool normals, mixed;
} Swift;

int64_t code_swift(RangeCoder *coder, Swift *swift, int64_t first, int64_t count);
/* Fill what the surface tells of normals. `sums`: n x 3, zeros. */
void expect_directions(Swift *swift, int64_t *sums);

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
