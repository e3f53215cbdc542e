/* What all of a decoder shares: its host's memory, what it may still do, and the first thing wrong. */
#ifndef BSMDEC_CONTEXT_H
#define BSMDEC_CONTEXT_H

#include <string.h>

#include "bitstream/kernel.h"
#include "engine/bsmdec.h"

/* How much work and memory a stream has asked for (specification, M 14). */
typedef struct {
    double spent, owed, kept, received;
    int64_t vertices, shown, gone;
} Spent;

typedef struct {
    bsmdec_limits limits;
    bsmdec_allocator host;
    bsmdec_error error;
    double heap;  /* bytes that are held of the host */
    bool prepaid; /* work that comes has been paid for */
    Spent spent;
} Context;

/* What an error says: `#` in the text stands for a number. */
typedef struct {
    const char *text;
    int64_t a, b, c;
} Message;

/* Note the first thing wrong; always false, so that who finds it can return it. */
bool fail_with(Context *context, bsmdec_status status, Message message);
#ifdef BSMDEC_TERSE /* kind and place alone */
#define FAIL(context, status, ...) fail_with(context, BSMDEC_##status, (Message){.text = ""})
#else
#define FAIL(context, status, ...) fail_with(context, BSMDEC_##status, (Message){.text = __VA_ARGS__})
#endif
INLINE bool failed(const Context *context) { return context->error.status != BSMDEC_OK; }
/* Whether all is well. A decoder that leaves an array out for want of memory has failed, and says so here. */
INLINE bool fine(const Context *context) { return context->error.status == BSMDEC_OK; }
/* Fill in the places that are not known yet. */
void locate(bsmdec_error *error, int64_t offset, int64_t frame, int64_t block);
/* Take the error away, to go on behind it. */
bsmdec_error take_error(Context *context);

/* Memory in the order of a stack: `release_to` gives back all that came behind a mark. */
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
/* Memory for `count` things of a size; NULL, and the context has failed, if there is none. */
void *take_memory(Arena *arena, int64_t count, size_t size);
void *take_zeros(Arena *arena, int64_t count, size_t size);
/* Straight from the host. */
void *host_take(Context *context, size_t size);
void host_give(Context *context, void *memory, size_t size);

/* Arrays of the kernels, of numbers that are not set, or are 0 (`zero_...`). */
#define ARENA_ARRAYS(Name, type, name)                                                                                  \
    INLINE Name take_##name(Arena *arena, int64_t size) {                                                                \
        return (Name){take_memory(arena, size, sizeof(type)), size};                                                     \
    }                                                                                                                   \
    INLINE Name zero_##name(Arena *arena, int64_t size) { return (Name){take_zeros(arena, size, sizeof(type)), size}; } \
    INLINE Name##2 take_##name##2(Arena * arena, int64_t rows, int64_t columns) {                                        \
        return (Name##2){take_memory(arena, rows, (size_t)columns * sizeof(type)), rows, columns};                       \
    }                                                                                                                   \
    INLINE Name##2 zero_##name##2(Arena * arena, int64_t rows, int64_t columns) {                                        \
        return (Name##2){take_zeros(arena, rows, (size_t)columns * sizeof(type)), rows, columns};                        \
    }                                                                                                                   \
    INLINE Const##Name const_##name(Name given) { return (Const##Name){given.data, given.size}; }                        \
    INLINE Const##Name##2 const_##name##2(Name##2 given) { return (Const##Name##2){given.data, given.rows, given.columns}; }

ARENA_ARRAYS(Bytes, uint8_t, bytes)
ARENA_ARRAYS(Ints, int32_t, ints)
ARENA_ARRAYS(Words, uint32_t, words)
ARENA_ARRAYS(Longs, int64_t, longs)
ARENA_ARRAYS(Singles, float, singles)
ARENA_ARRAYS(Doubles, double, doubles)

/* Limits and charges: false where one is exceeded. */
bool within_limit(Context *context, const char *name, double value, double limit);
#define WITHIN(context, name, value) within_limit(context, #name, (double)(value), (context)->limits.name)
bool spend(Context *context, double work, double received);
bool keep(Context *context, double memory, double received);
bool afford(Context *context, double memory);
/* Bytes for which there is room. */
double memory_left(const Context *context);
bool affords_memory(Context *context, double memory, int64_t vertices, double received);

#endif
