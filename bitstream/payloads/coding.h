/* What entropy-coded payloads are read with (specification, C 1 to C 3): a coder, and banks in memory of a decoder. */
#pragma once

#include "bitstream/entropy/entropy.h"
#include "bitstream/container/wire.h"
#include "bitstream/payloads/payloads.h"

/* A payload that is read, or written. */
typedef struct {
    Context *context;
    RangeCoder coder;
} Coding;

bool begin_coding(Context *context, Span payload, Coding *coding);
/* Let a writer write so many bytes more; a reader has all bytes that it will have. */
#ifdef BSMDEC_WRITES
bool room_to_write(Coding *coding, int64_t bytes);
#else
INLINE bool room_to_write(Coding *coding, int64_t bytes) { return (void)coding, (void)bytes, true; }
#endif
/* The error that nonsense is: truncated if the payload is over. */
bool nonsense(const Coding *coding, const char *what);
/* Whether the payload was read exactly to its end (C 1.5), or written. */
bool finish_coding(Coding *coding);

MUST_CHECK bool make_bank(Arena *arena, BankPlan plan, Bank *bank);
