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

int64_t collect_creases(ConstDoubles2 positions, ConstInts2 faces, Lists around, int64_t most, Bends bends,
    Doubles2 crosses, Ints2 pairs, Bytes sharp, Doubles costs);

bool fits_rows(ConstInts starts, ConstInts members, int64_t rows, int64_t count);
bool fits_creases(const Creases *creases, int64_t vertices);
double wrong_creases(const Creases *creases, const double *positions, int64_t vertex);

int64_t settle_levels(ConstDoubles2 offsets, ConstDoubles2 normals, ConstDoubles2 losses, ConstDoubles2 steps,
    ConstDoubles reach, ConstInts starts, ConstInts members, ConstDoubles2 rates, double pull, int64_t fixed,
    Creases creases, ConstDoubles2 places, ConstDoubles2 frames, Doubles2 moved, Ints2 levels, Doubles2 counts);

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

int64_t collect_flaps(ConstInts2 faces, ConstInts starts, ConstInts members, Ints pending, Ints2 flaps);
int64_t shape_levels(Wanted wanted, Aim aim, Doubles2 moved, Ints2 levels, ConstDoubles2 directions,
    ConstDoubles scales, double pull, Bytes open);
int64_t shape_grid(Wanted wanted, Aim aim, Doubles2 moved, Ints2 places, double step, ConstInts2 flaps,
    ConstInts starts, ConstInts members, Ints2 bends, ConstDoubles rates, Bytes open);
int64_t count_folds(ConstDoubles2 positions, ConstInts2 flaps, Bytes folded);
int64_t unfold_levels(Wanted wanted, ConstDoubles reach, Doubles2 moved, Ints2 levels, ConstDoubles2 directions,
    ConstInts2 flaps, ConstInts starts, ConstInts members, int64_t most, Bytes wrong, Bytes open);

int64_t fit_cells(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstInts links, ConstInts linked,
    ConstDoubles2 positions, int64_t rounds, double bent, int64_t steps, Singles scratch, Doubles2 places,
    Doubles2 pulls);
int64_t couple_cells(ConstInts offsets, ConstInts neighbors, ConstInts bounds, ConstInts order, ConstInts links,
    ConstInts linked, int64_t rounds, double bent, Singles scratch, Ints listed, Ints below, Singles half,
    Doubles weights, Longs starts, Ints ends, Singles values);
int64_t level_cells(ConstLongs starts, ConstInts ends, ConstSingles values, ConstDoubles weights, ConstDoubles2 frames,
    ConstDoubles2 steps, int64_t first, Doubles2 pulls, Ints2 levels);

int64_t find_motions(ConstDoubles2 positions, ConstInts2 faces, ConstInts degrees, double worth, Ints heads, Ints links,
    Bytes covered, Doubles room, Doubles2 found);
