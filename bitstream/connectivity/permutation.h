/* Permutations and rotations. See permutation.py. */
#ifndef BSM_PERMUTATION_H
#define BSM_PERMUTATION_H

#include "bitstream/entropy/mixing.h"

int64_t code_steps(Coder coder, Bank bank, Ints values, Ints tree);
int64_t code_turns(Coder coder, Bank bank, Ints values);

#endif
