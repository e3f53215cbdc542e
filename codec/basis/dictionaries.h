/* Dictionaries of patches: U, by orthogonal iterations (specification, M 8). */
#ifndef BSMDEC_DICTIONARIES_H
#define BSMDEC_DICTIONARIES_H

#include "codec/basis/dictionary_costs.h"
#include "codec/basis/structure.h"

/* C and D^-1 of L + diagonal. */
typedef struct {
    Singles values, inverse;
} Factor;

/* U of a patch that follows none (M 8.3 to M 8.5), of `width` columns, in `arena`; `held` is the factor of L + springs
 * + shift, or NULL. */
bool key_dictionary(Context *context, const Header *header, const Patch *patch, ConstDoubles springs,
    const Factor *held, int64_t width, Arena *arena, Arena *scratch, Singles2 *dictionary);
/* U of a patch whose predecessor has as many rows, and the dictionary `previous`. */
bool following_dictionary(Context *context, const Header *header, const Patch *patch, const Factor *factor,
    Singles2 previous, int64_t width, Arena *arena, Arena *scratch, Singles2 *dictionary);
bool factorize_patch(const Patch *patch, ConstDoubles springs, double shift, Arena *arena, Factor *factor);
INLINE int64_t solving_space(int64_t rows, int64_t columns) { return (rows + 4) * (columns + 16) + 15; }
MUST_CHECK bool take_factor(Arena *arena, const Patch *patch, Factor *factor);

#endif
