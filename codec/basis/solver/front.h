#ifndef BSM_FRONT_H
#define BSM_FRONT_H

#include "codec/basis/solver/solver.h"
#include "codec/basis/solver/vectors.h"

/* Front t: its own steps, its border, its matrix, and how far the rows of that are apart. */
typedef struct {
    int64_t first, own, edge, width, place, apart;
} Front;

INLINE Front front_at(const Fronts *fronts, int64_t t) {
    Front front;
    front.first = fronts->firsts.data[t];
    front.own = fronts->firsts.data[t + 1] - front.first;
    front.edge = fronts->starts.data[t];
    front.width = front.own + fronts->starts.data[t + 1] - front.edge;
    front.place = fronts->places.data[t];
    front.apart = whole_vectors(front.width);
    return front;
}

#endif
