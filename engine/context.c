/* Errors, memory and charges: what every part of a decoder asks for before it does anything. */
#include "engine/context.h"

#include <stdlib.h>

/* Behind it lies its memory. */
struct Slab {
    Slab *below;
    size_t size, used;
};

enum { SLAB = 1 << 16, LINE = 64 };

static char *write_number(char *to, char *end, int64_t number) {
    char digits[20];
    int count = 0;
    uint64_t left = number < 0 ? 0 - (uint64_t)number : (uint64_t)number;
    do digits[count++] = (char)('0' + left % 10);
    while ((left /= 10) > 0);
    if (number < 0 && to < end) *to++ = '-';
    while (count > 0 && to < end) *to++ = digits[--count];
    return to;
}

bool fail_with(Context *context, bsmdec_status status, Message message) {
    if (failed(context)) return false;
    bsmdec_error *error = &context->error;
    char *to = error->message, *end = to + sizeof error->message - 1;
    const int64_t numbers[] = {message.a, message.b, message.c};
    int next = 0;
    for (const char *from = message.text; *from != 0 && to < end; from++) {
        if (*from == '#' && next < 3) to = write_number(to, end, numbers[next++]);
        else *to++ = *from;
    }
    *to = 0;
    error->status = status;
    error->offset = error->frame = error->block = -1;
    return false;
}

void locate(bsmdec_error *error, int64_t offset, int64_t frame, int64_t block) {
    if (error->offset < 0) error->offset = offset;
    if (error->frame < 0) error->frame = frame;
    if (error->block < 0) error->block = block;
}

bsmdec_error take_error(Context *context) {
    bsmdec_error error = context->error;
    context->error.status = BSMDEC_OK;
    return error;
}

void *host_take(Context *context, size_t size) {
    if (failed(context)) return NULL;
    if (context->heap + (double)size > context->limits.heap) {
        FAIL(context, LIMIT, "heap: # bytes more are over the limit", (int64_t)size);
        return NULL;
    }
    void *memory = context->host.allocate(context->host.host, size);
    if (memory == NULL) FAIL(context, NO_MEMORY, "the host has no # bytes of memory", (int64_t)size);
    else context->heap += (double)size;
    return memory;
}

void host_give(Context *context, void *memory, size_t size) {
    if (memory == NULL) return;
    context->heap -= (double)size;
    context->host.release(context->host.host, memory, size);
}

/* Where memory begins behind a slab's own numbers. */
static size_t first_of(const Slab *slab) {
    uintptr_t start = (uintptr_t)(slab + 1);
    return sizeof *slab + (size_t)(-start & (LINE - 1));
}

static void drop_slab(Arena *arena) {
    Slab *slab = arena->top;
    arena->top = slab->below;
    host_give(arena->context, slab, slab->size);
}

Mark mark_of(const Arena *arena) { return (Mark){arena->top, arena->top != NULL ? arena->top->used : 0}; }

void release_to(Arena *arena, Mark mark) {
    while (arena->top != mark.slab) drop_slab(arena);
    if (arena->top != NULL) arena->top->used = mark.used;
}

void release_all(Arena *arena) { release_to(arena, (Mark){NULL, 0}); }

void *take_memory(Arena *arena, int64_t count, size_t size) {
    const size_t most = SIZE_MAX / 4;
    if (failed(arena->context)) return NULL;
    if (count < 0 || (count > 0 && size > most / (uint64_t)count)) {
        FAIL(arena->context, LIMIT, "# things are more than memory can hold", count);
        return NULL;
    }
    size_t bytes = ((size_t)count * size + LINE) / LINE * LINE;
    Slab *slab = arena->top;
    if (slab == NULL || bytes > slab->size - slab->used) {
        size_t whole = bytes + sizeof(Slab) + LINE;
        if (whole < SLAB) whole = SLAB;
        slab = host_take(arena->context, whole);
        if (slab == NULL) return NULL;
        *slab = (Slab){arena->top, whole, 0};
        slab->used = first_of(slab);
        arena->top = slab;
    }
    void *memory = (char *)slab + slab->used;
    slab->used += bytes;
    return memory;
}

void *take_zeros(Arena *arena, int64_t count, size_t size) {
    void *memory = take_memory(arena, count, size);
    if (memory != NULL) memset(memory, 0, (size_t)count * size);
    return memory;
}

bool within_limit(Context *context, const char *name, double value, double limit) {
    if (!(value > limit)) return true;
    char text[64] = "";
    size_t length = strlen(name);
    memcpy(text, name, length < 24 ? length : 24);
    strcat(text, " = # is over the limit of #");
    return FAIL(context, LIMIT, text, (int64_t)(value < 9e18 ? value : 9e18), (int64_t)(limit < 9e18 ? limit : 9e18));
}

static double lesser(double a, double b) { return a < b ? a : b; }

/* Work to come, and the bytes that ask for it (M 14.3, M 14.9). */
bool spend(Context *context, double work, double received) {
    const bsmdec_limits *limits = &context->limits;
    Spent *spent = &context->spent;
    if (context->prepaid) return true;
    double own = work - limits->work_per_byte * received;
    spent->spent += work;
    spent->owed += own > 0.0 ? own : 0.0;
    double granted = limits->work + limits->work_per_vertex * (double)(spent->vertices + spent->shown);
    return within_limit(context, "work", spent->spent, limits->most_work)
        && within_limit(context, "work", spent->owed, lesser(granted, limits->most_work));
}

static double granted_memory(const bsmdec_limits *limits, int64_t vertices, double received) {
    return lesser(limits->memory + limits->memory_per_vertex * (double)vertices + limits->memory_per_byte * received, limits->most_memory);
}

bool affords_memory(Context *context, double memory, int64_t vertices, double received) {
    return within_limit(context, "memory", memory, granted_memory(&context->limits, vertices, received));
}

double memory_left(const Context *context) {
    const Spent *spent = &context->spent;
    return granted_memory(&context->limits, spent->vertices - spent->gone, spent->received) - spent->kept;
}

/* Memory for a while, beside what is kept (M 14.8). */
bool afford(Context *context, double memory) {
    const Spent *spent = &context->spent;
    return affords_memory(context, spent->kept + memory, spent->vertices - spent->gone, spent->received);
}

/* Memory that is kept to the end, and bytes that stand for it. */
bool keep(Context *context, double memory, double received) {
    context->spent.kept += memory;
    context->spent.received += received;
    return afford(context, 0.0);
}
