/* Errors, memory and charges: what every part of a decoder asks for before it does anything. */
#include "bitstream/context.h"

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

/* Names may be long: the reason after them has to fit. */
static char *write_name(char *to, const char *end, const char *name) {
    enum { MOST_SHOWN = 60 };
    for (int i = 0; i < MOST_SHOWN && name[i] != 0 && to < end; i++) *to++ = name[i];
    return to;
}

void write_message(char *to, size_t capacity, Message message) {
    char *end = to + capacity - 1;
    const int64_t numbers[] = {message.a, message.b, message.c};
    int next = 0;
    for (const char *from = message.text; *from != 0 && to < end; from++) {
        if (*from == '#' && next < 3) to = write_number(to, end, numbers[next++]);
        else if (*from == '$' && message.name != NULL) to = write_name(to, end, message.name);
        else *to++ = *from;
    }
    *to = 0;
}

bool name_attribute(Context *context, const char *name) {
#ifdef BSMDEC_TERSE
    (void)context, (void)name;
#else
    char reason[sizeof context->error.message], *message = context->error.message;
    memcpy(reason, message, sizeof reason);
    write_message(message, sizeof reason, (Message){.text = "attribute '$': ", .name = name});
    size_t length = strlen(message), left = sizeof reason - 1 - length;
    memcpy(message + length, reason, left);
    message[length + left] = 0;
#endif
    return false;
}

#ifndef BSMDEC_TERSE
__attribute__((noinline)) /* copies where it is called would be a kilobyte of what pages load */
#endif
bool fail_with(Context *context, bsmdec_status status, Message message) {
    if (failed(context)) return false;
    bsmdec_error *error = &context->error;
#ifdef BSMDEC_TERSE
    (void)message;
#else
    write_message(error->message, sizeof error->message, message);
    error->limit = status == BSMDEC_LIMIT ? message.name : NULL;
    error->value = (double)message.a;
#endif
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
    if (!context->starved) context->error.status = BSMDEC_OK;
    return error;
}

/* Whether `count` elements of a size can be in memory at all. */
static bool is_possible(Context *context, int64_t count, size_t size) {
    const size_t most = SIZE_MAX / 4;
    if (failed(context)) return false;
    if (count >= 0 && (count == 0 || size <= most / (uint64_t)count)) return true;
    context->starved = true;
    return FAIL(context, LIMIT, "# elements do not fit in memory", count);
}

void *host_memory(Context *context, int64_t count, size_t size) {
    if (!is_possible(context, count, size)) return NULL;
    size_t bytes = (size_t)count * size;
    bool within = context->heap + (double)bytes <= context->limits.heap;
    void *memory = within ? context->host.allocate(context->host.host, bytes) : NULL;
    context->starved = memory == NULL;
    if (!within) FAIL(context, LIMIT, "heap: # bytes more are over the limit", (int64_t)bytes);
    else if (memory == NULL) FAIL(context, NO_MEMORY, "out of memory (# bytes)", (int64_t)bytes);
    else context->heap += (double)bytes;
    return memory;
}

void host_give(Context *context, void *memory, size_t size) {
    if (memory == NULL) return;
    context->heap -= (double)size;
    context->host.release(context->host.host, memory, size);
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

void *find_memory(Arena *arena, int64_t count, size_t size) {
    if (!is_possible(arena->context, count, size)) return NULL;
    size_t bytes = ((size_t)count * size + LINE) / LINE * LINE;
    Slab *slab = arena->top;
    if (slab == NULL || bytes > slab->size - slab->used) {
        size_t whole = bytes + sizeof(Slab) + LINE;
        if (whole < SLAB) whole = SLAB;
        slab = host_memory(arena->context, 1, whole);
        if (slab == NULL) return NULL;
        *slab = (Slab){arena->top, whole, 0};
        slab->used = sizeof *slab + (size_t)(-(uintptr_t)(slab + 1) & (LINE - 1)); /* memory begins on a line */
        arena->top = slab;
    }
    void *memory = (char *)slab + slab->used;
    slab->used += bytes;
    return memory;
}

void *find_zeros(Arena *arena, int64_t count, size_t size) {
    void *memory = find_memory(arena, count, size);
    if (memory != NULL) memset(memory, 0, (size_t)count * size);
    return memory;
}

bool within_limit(Context *context, const char *name, double value, double limit) {
    if (!(value > limit)) return true;
    return FAIL(context, LIMIT, "$ = # is over the limit of #", (int64_t)(value < 9e18 ? value : 9e18),
        (int64_t)(limit < 9e18 ? limit : 9e18), 0, name);
}

static double lesser(double a, double b) { return a < b ? a : b; }

static bool note(Context *context, double amount, double received) {
    Ledger *ledger = context->ledger;
    if (ledger == NULL) return true;
    if (ledger->count == MOST_COSTS) return FAIL(context, LIMIT, "more than # charges ahead", MOST_COSTS);
    ledger->cost[ledger->count++] = (Cost){amount, received};
    return true;
}

double granted_work(const Context *context) {
    const bsmdec_limits *limits = &context->limits;
    double vertices = (double)(context->spent.vertices + context->spent.shown);
    return lesser(limits->work + limits->work_per_vertex * vertices, limits->most_work);
}

double work_left(const Context *context) {
    const Spent *spent = &context->spent;
    return lesser(lesser(context->limits.most_work - spent->spent, granted_work(context) - spent->owed), 1e18);
}

/* Work to come, and the bytes that ask for it (M 14.3, M 14.9). */
bool charge(Context *context, double work, double received) {
    const bsmdec_limits *limits = &context->limits;
    Spent *spent = &context->spent;
    if (context->prepaid) return true;
    if (!note(context, work, received)) return false;
    double own = work - limits->work_per_byte * received;
    spent->spent += work;
    spent->owed += own > 0.0 ? own : 0.0;
    return within_limit(context, "most_work", spent->spent, limits->most_work)
        && within_limit(context, "work", spent->owed, granted_work(context));
}

static double granted_memory(const bsmdec_limits *limits, int64_t vertices, double received) {
    return lesser(limits->memory + limits->memory_per_vertex * (double)vertices + limits->memory_per_byte * received,
        limits->most_memory);
}

bool within_memory(Context *context, double memory, int64_t vertices, double received) {
    return within_limit(context, "memory", memory, granted_memory(&context->limits, vertices, received));
}

double memory_left(const Context *context) {
    const Spent *spent = &context->spent;
    return granted_memory(&context->limits, spent->vertices - spent->gone, spent->received) - spent->reserved;
}

/* Temporary memory, in addition to the reserved memory (M 14.8). */
bool fits_memory(Context *context, double memory) {
    const Spent *spent = &context->spent;
    return note(context, memory, -1)
        && within_memory(context, spent->reserved + memory, spent->vertices - spent->gone, spent->received);
}

bool charge_ledger(Context *context, const Ledger *ledger, int first, int end) {
    for (int i = first; i < end; i++) {
        Cost cost = ledger->cost[i];
        if (cost.received < 0 ? !fits_memory(context, cost.amount) : !charge(context, cost.amount, cost.received))
            return false;
    }
    return true;
}

/* Memory that is reserved to the end, and the bytes that pay for it. */
bool reserve(Context *context, double memory, double received) {
    context->spent.reserved += memory;
    context->spent.received += received;
    return fits_memory(context, 0.0);
}
