/* What chooses levels, places and transforms: shaping.c, settling.c, creases.c, congruence.c. Encoder only. */
#pragma once

#include "codec/geometry/geometry.h"

/* Pairs of faces that share a vertex and are bent by about as much as makes a crease. */
typedef struct {
    ConstInts2 faces;   /* m x 3 */
    ConstInts2 pairs;   /* k x 2, of faces */
    ConstBytes sharp;   /* k: whether there should be a crease between them */
    ConstDoubles costs; /* k: of being wrong about that */
    ConstInts starts;   /* n + 1, of the pairs whose bend hangs on a vertex */
    ConstInts members;
    double cosine;      /* of the bend from which on there is one */
} Creases;

/* Cosines of the bend from which on there is a crease, and of the bends between which one may come or go. */
typedef struct {
    double crease, least, largest;
} Bends;

/* Room for pairs of faces with such a bend: whether it is a crease, and what it costs to be wrong about that. */
typedef struct {
    Ints2 pairs;
    Bytes sharp;
    Doubles costs;
} NearCreases;

int64_t collect_creases(ConstDoubles2 positions, ConstInts2 faces, Lists around, int64_t most, Bends bends,
    Doubles2 crosses, NearCreases near);

bool fits_rows(ConstInts starts, ConstInts members, int64_t rows, int64_t count);
bool fits_creases(const Creases *creases, int64_t vertices);
double wrong_creases(const Creases *creases, const double *positions, int64_t vertex);

/* Where each vertex should lie, in axes of its own, and what an error costs there. */
typedef struct {
    ConstDoubles2 places;  /* n x 3, in the axes of the mesh */
    ConstDoubles2 frames;  /* n x 9: the axes of the vertex */
    ConstDoubles2 offsets; /* n x 3, along them */
    ConstDoubles2 normals; /* n x 3, in them */
    ConstDoubles2 losses;  /* n x 2: costs of the squared length of an error, and of its share along the normal */
    ConstDoubles reach;    /* n: the largest error */
} Settled;

/* Bits of levels by axis, class of the neighbors and distance from `pull` times their mean, and counts of levels. */
typedef struct {
    ConstDoubles2 rates;
    double pull;
    Doubles2 counts;
} Rates;

int64_t settle_levels(Settled wanted, ConstDoubles2 steps, ConstInts starts, ConstInts members, Rates rates,
    int64_t fixed, Creases creases, Doubles2 moved, Ints2 levels);

/* A mesh as it should be, and who is beside whom. */
typedef struct {
    ConstDoubles2 positions; /* n x 3 */
    ConstInts2 faces;        /* m x 3 */
    ConstLongs around_starts;
    ConstInts around; /* faces at each vertex */
    ConstInts beside_starts;
    ConstInts beside; /* neighbors of each vertex */
    ConstDoubles2 normals; /* m x 3 */
    ConstDoubles weights;  /* m */
} Wanted;

/* How levels are chosen. */
typedef struct {
    double worth;  /* what a nat costs, in units of weight times angle */
    double reach;  /* how far a vertex may come to lie from its place; where it is farther it may come nearer */
    int64_t sweeps;
} Aim;

/* Levels or places on a grid, the positions that they give, kept in step, and which vertices may still move. */
typedef struct {
    Doubles2 moved; /* n x 3 */
    Ints2 levels;
    Bytes open; /* n */
} Shaped;

/* Pairs of faces at an edge: its ends and the two corners opposite. Each vertex is in the rows `members` / 2 from its
 * start on, as an opposite corner where `members` is odd. */
typedef struct {
    ConstInts2 rows; /* k x 4 */
    ConstInts starts, members;
} Flaps;

int64_t collect_flaps(ConstInts2 faces, ConstInts starts, ConstInts members, Ints pending, Ints2 flaps);
int64_t list_flaps(ConstInts2 flaps, Ints starts, Ints members);
int64_t shape_levels(Wanted wanted, Aim aim, Shaped shaped, ConstDoubles2 directions, ConstDoubles scales, double pull);
int64_t shape_grid(
    Wanted wanted, Aim aim, Shaped shaped, double step, Flaps edges, Ints2 bends, ConstDoubles rates);
int64_t count_folds(ConstDoubles2 positions, ConstInts2 flaps, Bytes folded);
int64_t unfold_levels(Wanted wanted, ConstDoubles reach, Shaped shaped, ConstDoubles2 directions, Flaps edges,
    int64_t most, ConstBytes were);

int64_t fit_cells(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstInts links, ConstInts linked,
    ConstDoubles2 positions, int64_t rounds, double bent, int64_t steps, Singles scratch, Doubles2 places,
    Doubles2 pulls);
int64_t couple_cells(ConstInts offsets, ConstInts neighbors, ConstInts bounds, ConstInts order, ConstInts links,
    ConstInts linked, int64_t rounds, double bent, Singles scratch, Ints listed, Ints below, Singles half,
    Doubles weights, Longs starts, Ints ends, Singles values);
int64_t level_cells(ConstLongs starts, ConstInts ends, ConstSingles values, ConstDoubles weights, ConstDoubles2 frames,
    ConstDoubles2 steps, int64_t first, Doubles2 pulls, Ints2 levels);

/* Scratch of `find_motions`: a power of two of heads, n + m links; the rest is zero at first. */
typedef struct {
    Ints heads, links;
    Bytes covered;
    Doubles pool;
} MotionScratch;

int64_t find_motions(ConstDoubles2 positions, ConstInts2 faces, ConstInts degrees, double worth, MotionScratch scratch,
    Doubles2 found);
