/* What entropy-coded payloads are read with (specification, C 1 to C 3): the kernels' coder and banks, of a decoder's
 * memory. */
#pragma once

#include "bitstream/entropy/entropy.h"
#include "bitstream/container/wire.h"
#include "bitstream/payloads/payloads.h"

/* A payload that is read; it must not be moved, for `coder` points into it. */
typedef struct {
    Context *context;
    int64_t state[CODER_STATES];
    Coder coder;
} Coding;

bool begin_coding(Context *context, Span payload, Coding *coding);
/* Let a writer write so many bytes more; a reader has all bytes that it will have. */
#ifdef BSMDEC_WRITES
bool room_to_write(Coding *coding, int64_t bytes);
#else
INLINE bool room_to_write(Coding *coding, int64_t bytes) { return (void)coding, (void)bytes, true; }
#endif
/* Whether more was read than any payload of this length can hold (C 1.6). */
bool ran_over(const Coding *coding);
/* The error that nonsense is: truncated if the payload is over. */
bool nonsense(const Coding *coding, const char *what);
/* Whether the payload was read exactly to its end (C 1.5). */
bool finish_coding(const Coding *coding);

MUST_CHECK bool make_bank(Arena *arena, BankPlan plan, Bank *bank);
