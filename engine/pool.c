/* Memory of the C library: pieces of chunks of a huge page each, once a decoder asks for so much that this pays. */
#include "engine/pool.h"

#if __STDC_HOSTED__
#include <stdlib.h>
#endif

#ifdef BSMDEC_POOL
#include <sys/mman.h>

enum { CHUNK = 1 << 21, UNIT = CHUNK / 64, ENOUGH = 1 << 19 };

struct Chunk {
    Chunk *next;
    char *memory;
    uint64_t used; /* bit k: unit k is taken */
};

static void lock(Pool *pool) {
    while (__atomic_test_and_set(&pool->locked, __ATOMIC_ACQUIRE)) {}
}

static void unlock(Pool *pool) { __atomic_clear(&pool->locked, __ATOMIC_RELEASE); }

static uint64_t mask_of(size_t units) { return units < 64 ? (UINT64_C(1) << units) - 1 : UINT64_MAX; }

/* NULL where a chunk has no such room left. */
static void *take_units(Chunk *chunk, size_t units) {
    uint64_t mask = mask_of(units);
    for (size_t at = 0; at + units <= 64; at++)
        if ((chunk->used & mask << at) == 0) {
            chunk->used |= mask << at;
            return chunk->memory + at * UNIT;
        }
    return NULL;
}

/* Whole chunks from the system: malloc would keep the parts between aligned ones. Without huge pages, small ones do. */
static void *take_huge(size_t size) {
    char *memory = mmap(NULL, size + CHUNK, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return NULL;
    size_t before = -(uintptr_t)memory % CHUNK;
    if (before > 0) munmap(memory, before);
    if (before < CHUNK) munmap(memory + before + size, CHUNK - before);
    madvise(memory + before, size, MADV_HUGEPAGE);
    return memory + before;
}

static void give_huge(void *memory, size_t size) { munmap(memory, (size + CHUNK - 1) / CHUNK * CHUNK); }

static Chunk *add_chunk(Pool *pool) {
    Chunk *chunk = malloc(sizeof *chunk);
    char *memory = chunk != NULL ? take_huge(CHUNK) : NULL;
    if (memory == NULL) {
        free(chunk);
        return NULL;
    }
    *chunk = (Chunk){pool->chunks, memory, 0};
    return pool->chunks = chunk;
}

static void *take_of_chunks(Pool *pool, size_t units) {
    for (Chunk *chunk = pool->chunks; chunk != NULL; chunk = chunk->next) {
        void *memory = take_units(chunk, units);
        if (memory != NULL) return memory;
    }
    Chunk *chunk = add_chunk(pool);
    return chunk != NULL ? take_units(chunk, units) : NULL;
}

/* Whether memory was of a chunk. One empty chunk stays for what comes next. */
static bool give_to_chunks(Pool *pool, char *memory, size_t units) {
    Chunk **link = &pool->chunks;
    while (*link != NULL && (memory < (*link)->memory || memory >= (*link)->memory + CHUNK)) link = &(*link)->next;
    if (*link == NULL) return false;
    Chunk *chunk = *link;
    chunk->used &= ~(mask_of(units) << (memory - chunk->memory) / UNIT);
    bool others = false;
    for (const Chunk *other = pool->chunks; other != NULL; other = other->next)
        others |= other != chunk && other->used == 0;
    if (chunk->used != 0 || !others) return true;
    *link = chunk->next;
    give_huge(chunk->memory, CHUNK);
    free(chunk);
    return true;
}

static void *take(void *host, size_t size) {
    Pool *pool = host;
    if (pool == NULL || size < UNIT || size > SIZE_MAX / 2) return malloc(size);
    if (size > CHUNK) return take_huge((size + CHUNK - 1) / CHUNK * CHUNK);
    lock(pool);
    bool enough = pool->taken >= ENOUGH;
    pool->taken += enough ? 0 : size;
    void *memory = enough ? take_of_chunks(pool, (size + UNIT - 1) / UNIT) : NULL;
    unlock(pool);
    return memory != NULL ? memory : malloc(size);
}

static void give(void *host, void *memory, size_t size) {
    Pool *pool = host;
    if (pool != NULL && size >= UNIT && size <= CHUNK) {
        lock(pool);
        bool given = give_to_chunks(pool, memory, (size + UNIT - 1) / UNIT);
        unlock(pool);
        if (given) return;
    }
    if (pool != NULL && size > CHUNK)
        give_huge(memory, size);
    else
        free(memory);
}

bsmdec_allocator with_pool(bsmdec_allocator host, Pool *pool) {
    if (host.allocate == take) host.host = pool;
    return host;
}

bsmdec_allocator without_pool(bsmdec_allocator host) {
    Pool *pool = host.allocate == take ? host.host : NULL;
    while (pool != NULL && pool->chunks != NULL) {
        Chunk *chunk = pool->chunks;
        pool->chunks = chunk->next;
        give_huge(chunk->memory, CHUNK);
        free(chunk);
    }
    if (pool != NULL) host.host = NULL;
    return host;
}
#elif __STDC_HOSTED__
static void *take(void *host, size_t size) {
    (void)host;
    return malloc(size);
}

static void give(void *host, void *memory, size_t size) {
    (void)host;
    (void)size;
    free(memory);
}
#else /* there is no malloc: callers bring an allocator */
static void *take(void *host, size_t size) { return (void)host, (void)size, NULL; }
static void give(void *host, void *memory, size_t size) { (void)host, (void)memory, (void)size; }
#endif

bsmdec_allocator library_allocator(void) { return (bsmdec_allocator){sizeof(bsmdec_allocator), take, give, NULL}; }
