/* Single symbols, for the few that are coded one by one. Each returns what was coded, or MISUSED. */
#ifndef BSM_SYMBOLS_H
#define BSM_SYMBOLS_H

#include "bitstream/entropy/mixing.h"

int64_t code_one_bit(Coder coder, int64_t probability, int64_t bit);
int64_t code_one_uniform(Coder coder, int64_t value, int64_t count);
int64_t code_one_mixed_bit(Coder coder, Bank bank, ConstLongs contexts, int64_t node, int64_t selector, int64_t bit);
int64_t code_one_unsigned(
    Coder coder, Bank bank, ConstLongs contexts, int64_t selector, int64_t unary, int64_t value, int64_t node);
int64_t code_one_signed(Coder coder, Bank bank, ConstLongs contexts, int64_t selector, int64_t unary, int64_t value);

#endif
