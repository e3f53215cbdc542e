#ifndef BSM_SHAPING_H
#define BSM_SHAPING_H

#include "bitstream/kernel.h"

/* A mesh as it should be, and who is beside whom. */
typedef struct {
    ConstDoubles2 positions; /* n x 3 */
    ConstInts2 faces;        /* m x 3 */
    ConstLongs around_starts;
    ConstInts around; /* faces at each vertex */
    ConstInts beside_starts;
    ConstInts beside; /* neighbours of each vertex */
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
int64_t group_flaps(ConstInts2 flaps, Ints starts, Ints members);
int64_t shape_levels(Wanted wanted, Aim aim, Doubles2 moved, Ints2 levels, ConstDoubles2 directions, ConstDoubles scales,
                     double pull, Bytes open);
int64_t shape_grid(Wanted wanted, Aim aim, Doubles2 moved, Ints2 places, double step, ConstInts2 flaps, ConstInts starts,
                   ConstInts members, Ints2 bends, ConstDoubles rates, int64_t axes, Bytes open);
int64_t count_bends_on(ConstDoubles2 corners, double step, Ints2 counts);
int64_t count_bends(ConstInts2 bends, int64_t stride, Ints2 counts);

#endif
