/* Memory of the C library: pieces of regions of huge pages, once a decoder asks for so much that this pays. */
#include "bitstream/pool.h"

#if __STDC_HOSTED__
#include <stdlib.h>
#include <string.h>
#endif

#ifdef BSMDEC_POOL
#include <sys/mman.h>

enum { PAGE = 1 << 21, UNIT = 1 << 15, UNITS = 1 << 11, ENOUGH = 1 << 22 };

/* Much more than most decoders take: pages of it that are never written take no memory. */
struct Region {
    Region *next;
    char *memory;
    uint8_t used[UNITS];
};

static void lock(Pool *pool) {
    while (__atomic_test_and_set(&pool->locked, __ATOMIC_ACQUIRE)) {}
}

static void unlock(Pool *pool) { __atomic_clear(&pool->locked, __ATOMIC_RELEASE); }

/* The first that are free: they were written before, most likely. NULL where fewer are free in a row. */
static void *take_units(Region *region, size_t units) {
    for (size_t at = 0, run = 0; at < UNITS; at++) {
        run = region->used[at] ? 0 : run + 1;
        if (run < units) continue;
        size_t first = at + 1 - units;
        memset(region->used + first, 1, units);
        return region->memory + first * UNIT;
    }
    return NULL;
}

/* Whole pages from the system: malloc would keep the parts between aligned ones. Without huge pages, small ones do. */
static void *take_pages(size_t size) {
    size = (size + PAGE - 1) / PAGE * PAGE;
    char *memory = mmap(NULL, size + PAGE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return NULL;
    size_t before = -(uintptr_t)memory % PAGE;
    if (before > 0) munmap(memory, before);
    if (before < PAGE) munmap(memory + before + size, PAGE - before);
    madvise(memory + before, size, MADV_HUGEPAGE);
    return memory + before;
}

static void give_pages(void *memory, size_t size) { munmap(memory, (size + PAGE - 1) / PAGE * PAGE); }

static Region *add_region(Pool *pool) {
    Region *region = calloc(1, sizeof *region);
    if (region == NULL) return NULL;
    region->memory = take_pages((size_t)UNITS * UNIT);
    if (region->memory == NULL) {
        free(region);
        return NULL;
    }
    region->next = pool->regions;
    return pool->regions = region;
}

static void *take_of_regions(Pool *pool, size_t units) {
    for (Region *region = pool->regions; region != NULL; region = region->next) {
        void *memory = take_units(region, units);
        if (memory != NULL) return memory;
    }
    Region *region = add_region(pool);
    return region != NULL ? take_units(region, units) : NULL;
}

/* Whether memory was of a region. */
static bool give_to_regions(const Pool *pool, const char *memory, size_t units) {
    const size_t whole = (size_t)UNITS * UNIT;
    Region *region = pool->regions;
    while (region != NULL && (memory < region->memory || memory >= region->memory + whole)) region = region->next;
    if (region == NULL) return false;
    memset(region->used + (memory - region->memory) / UNIT, 0, units);
    return true;
}

static void *take(void *host, size_t size) {
    Pool *pool = host;
    if (pool == NULL || size < UNIT || size > SIZE_MAX / 2) return malloc(size);
    if (size > (size_t)UNITS * UNIT) return take_pages(size);
    lock(pool);
    bool enough = pool->taken >= ENOUGH;
    pool->taken += enough ? 0 : size;
    void *memory = enough ? take_of_regions(pool, (size + UNIT - 1) / UNIT) : NULL;
    unlock(pool);
    return memory != NULL ? memory : malloc(size);
}

static void give(void *host, void *memory, size_t size) {
    Pool *pool = host;
    if (pool != NULL && size >= UNIT && size <= (size_t)UNITS * UNIT) {
        lock(pool);
        bool given = give_to_regions(pool, memory, (size + UNIT - 1) / UNIT);
        unlock(pool);
        if (given) return;
    }
    if (pool != NULL && size > (size_t)UNITS * UNIT)
        give_pages(memory, size);
    else
        free(memory);
}

bsmdec_allocator with_pool(bsmdec_allocator host, Pool *pool) {
    if (host.allocate == take) host.host = pool;
    return host;
}

bsmdec_allocator without_pool(bsmdec_allocator host) {
    Pool *pool = host.allocate == take ? host.host : NULL;
    while (pool != NULL && pool->regions != NULL) {
        Region *region = pool->regions;
        pool->regions = region->next;
        give_pages(region->memory, (size_t)UNITS * UNIT);
        free(region);
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
