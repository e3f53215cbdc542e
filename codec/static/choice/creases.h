/* Pairs of faces that share a vertex and are bent by about as much as makes a crease: see creases.c. */
#ifndef BSM_CREASES_H
#define BSM_CREASES_H

#include "bitstream/kernel.h"

typedef struct {
    ConstInts2 faces;   /* m x 3 */
    ConstInts2 pairs;   /* k x 2, of faces */
    ConstBytes sharp;   /* k: whether there should be a crease between them */
    ConstDoubles costs; /* k: of being wrong about that */
    ConstInts starts;   /* n + 1, of the pairs whose bend hangs on a vertex */
    ConstInts members;
    double cosine;      /* of the bend from which on there is one */
} Creases;

int64_t collect_creases(ConstDoubles2 positions, ConstInts2 faces, ConstLongs starts, ConstInts around, int64_t most,
                        double cosine, double least, double largest, Doubles2 crosses, Ints2 pairs, Bytes sharp,
                        Doubles costs);
int64_t hang_creases(ConstInts2 faces, ConstInts2 pairs, Ints starts, Ints members);

bool fits_creases(const Creases *creases, int64_t vertices);
double wrong_creases(const Creases *creases, const double *positions, int64_t vertex);

#endif
