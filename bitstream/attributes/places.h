/* What is known around a vertex before its values. See places.c. */
#ifndef BSM_PLACES_H
#define BSM_PLACES_H

#include "bitstream/attributes/forecast.h"

enum { MOST_BASES = 8, MOST_TWINS = 8 };

/* An edge of the vertex's triangles of which both ends are known. */
typedef struct {
    int32_t a, b, c, tip; /* c: the known vertex behind it, or -1; tip: its corner */
    int32_t error;
} Base;

typedef struct {
    Around around;
    int bases, number, valence; /* number: of bases, capped */
    Base base[MOST_BASES];      /* best-behaved first */
    int32_t twin;               /* the known vertex at this place that was coded last, or -1 */
    int32_t error;              /* mean size of the gaps around, or -1 */
} Place;

void survey(const Work *work, int32_t v, Place *place);
int32_t balance(const Work *work, const Around *around, int component, int32_t otherwise);
int32_t fold_at(const Work *work, int32_t v, const Base *base, int component);
int32_t gap_classes(const Work *work, const Place *place, int component, int32_t unit);
int64_t square_root(uint64_t x);

#endif
