/* What all of a decoder shares: its host's memory, what it may still do, and the first thing wrong. */
#pragma once

#include <string.h>

#include "bitstream/kernel.h"
#include "library/bsmdec.h"

/* How much work and memory a stream has asked for (specification, M 14). */
typedef struct {
    double spent, owed, reserved, received;
    int64_t vertices, shown, gone;
} Spent;

/* A cost that was charged ahead of its turn: work, or memory for a while if `received` is below 0. */
typedef struct {
    double amount, received;
} Cost;
enum { MOST_COSTS = 20 };
typedef struct {
    Cost cost[MOST_COSTS];
    int begun, count; /* of the `count` costs, the first `begun` are those of beginning a chain */
} Ledger;

typedef struct {
    bsmdec_limits limits;
    bsmdec_allocator host;
    bsmdec_error error;
    double heap;  /* bytes that are held of the host */
    bool starved; /* the error is that memory ended, by the host or by the limit `heap`: nothing continues after that */
    bool prepaid; /* work that comes has been paid for */
    Spent spent;
    Ledger *ledger; /* where charges are noted as well, or NULL */
    struct Payload *writing; /* where payloads are written, or NULL: they are read */
} Context;

/* What an error says: `#` in the text is replaced by a number, `$` by a name. */
typedef struct {
    const char *text;
    int64_t a, b, c;
    const char *name;
} Message;

/* Write a message to `capacity` bytes, cut off if it is longer. */
void write_message(char *to, size_t capacity, Message message);
/* Note the first thing wrong; always false, so that who finds it can return it. */
bool fail_with(Context *context, bsmdec_status status, Message message);
#ifdef BSMDEC_TERSE /* kind and place alone */
#define FAIL(context, status, ...) fail_with(context, BSMDEC_##status, (Message){.text = ""})
#else
#define FAIL(context, status, ...) fail_with(context, BSMDEC_##status, (Message){.text = __VA_ARGS__})
#endif
INLINE bool failed(const Context *context) { return context->error.status != BSMDEC_OK; }
/* Begin the message of the error with the name of the attribute that it is about; always false. */
bool name_attribute(Context *context, const char *name);
/* Fill in the places that are not known yet. */
void locate(bsmdec_error *error, int64_t offset, int64_t frame, int64_t block);
/* Take the error away, to continue after it; a context without memory stays failed. */
bsmdec_error take_error(Context *context);

/* Memory in the order of a stack: `release_to` gives back all that came after a mark. */
typedef struct Slab Slab;
typedef struct {
    Context *context;
    Slab *top;
} Arena;
typedef struct {
    Slab *slab;
    size_t used;
} Mark;

INLINE Arena arena_of(Context *context) { return (Arena){context, NULL}; }
Mark mark_of(const Arena *arena);
void release_to(Arena *arena, Mark mark);
void release_all(Arena *arena);

/* Memory that was asked for is there, or the caller must not go on: every function that takes memory returns whether it
 * got it, and compilers warn where that is ignored. In WebAssembly a write through NULL is not even noticed. */
#if defined(__GNUC__)
#define MUST_CHECK __attribute__((warn_unused_result))
#else
#define MUST_CHECK
#endif
/* Memory for `count` things of a size; NULL, and the context has failed, if there is none. Use them in is_there or in
 * the macros below. */
void *find_memory(Arena *arena, int64_t count, size_t size);
void *find_zeros(Arena *arena, int64_t count, size_t size);
void *host_memory(Context *context, int64_t count, size_t size);
MUST_CHECK INLINE bool is_there(const void *memory) { return memory != NULL; }
/* Point at `count` things of an arena, which are 0 or not set, or of the host itself: false if there is no memory. */
#define TAKE(arena, count, pointer) is_there((pointer) = find_memory(arena, count, sizeof *(pointer)))
#define TAKE_ZEROS(arena, count, pointer) is_there((pointer) = find_zeros(arena, count, sizeof *(pointer)))
#define TAKE_OF_HOST(context, count, pointer) is_there((pointer) = host_memory(context, count, sizeof *(pointer)))
void host_give(Context *context, void *memory, size_t size);

/* The same for arrays of the kernels: of numbers that are not set, or are 0 (`zero_...`). */
#define ARENA_ARRAYS(Name, type, name)                                                                                 \
    MUST_CHECK INLINE bool take_##name(Arena *arena, int64_t size, Name *taken) {                                      \
        taken->size = size;                                                                                            \
        return TAKE(arena, size, taken->data);                                                                         \
    }                                                                                                                  \
    MUST_CHECK INLINE bool zero_##name(Arena *arena, int64_t size, Name *taken) {                                      \
        taken->size = size;                                                                                            \
        return TAKE_ZEROS(arena, size, taken->data);                                                                   \
    }                                                                                                                  \
    MUST_CHECK INLINE bool take_##name##2(Arena * arena, int64_t rows, int64_t columns, Name##2 * taken) {             \
        *taken = (Name##2){find_memory(arena, rows, (size_t)columns * sizeof(type)), rows, columns};                   \
        return is_there(taken->data);                                                                                  \
    }                                                                                                                  \
    MUST_CHECK INLINE bool zero_##name##2(Arena * arena, int64_t rows, int64_t columns, Name##2 * taken) {             \
        *taken = (Name##2){find_zeros(arena, rows, (size_t)columns * sizeof(type)), rows, columns};                    \
        return is_there(taken->data);                                                                                  \
    }                                                                                                                  \
    INLINE Const##Name const_##name(Name given) { return (Const##Name){given.data, given.size}; }                      \
    INLINE Const##Name##2 const_##name##2(Name##2 given) {                                                             \
        return (Const##Name##2){given.data, given.rows, given.columns};                                                \
    }

ARENA_ARRAYS(Bytes, uint8_t, bytes)
ARENA_ARRAYS(Ints, int32_t, ints)
ARENA_ARRAYS(Words, uint32_t, words)
ARENA_ARRAYS(Longs, int64_t, longs)
ARENA_ARRAYS(Singles, float, singles)
ARENA_ARRAYS(Doubles, double, doubles)
INLINE Doubles2 rows_from(Doubles2 all, int64_t first, int64_t count) {
    return (Doubles2){all.data + first * all.columns, count, all.columns};
}

/* Limits and charges: false where one is exceeded. */
bool within_limit(Context *context, const char *name, double value, double limit);
#define WITHIN(context, name, value) within_limit(context, #name, (double)(value), (context)->limits.name)
bool charge(Context *context, double work, double received);
/* The work that limits allow beside that of bytes. */
double granted_work(const Context *context);
bool reserve(Context *context, double memory, double received);
bool fits_memory(Context *context, double memory);
/* Make the charges of a ledger from number `first` up to `end`. */
bool charge_ledger(Context *context, const Ledger *ledger, int first, int end);
/* Bytes for which there is room. */
double memory_left(const Context *context);
double work_left(const Context *context);
bool within_memory(Context *context, double memory, int64_t vertices, double received);
