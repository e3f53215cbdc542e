/* Memory of the C library: pieces of regions of huge pages, once a decoder asks for so much that this pays.
 *
 * A large piece is mapped by itself and goes back to the system when it is freed. A region would keep it. */
#include "bitstream/pool.h"

#if __STDC_HOSTED__
#include <stdlib.h>
#include <string.h>
#endif

#ifdef BSMDEC_POOL
#include <sys/mman.h>

enum { PAGE = 1 << 21, LEAST_PAGE = 1 << 12, UNIT = 1 << 15, UNITS = 1 << 11, REGION = UNITS * UNIT };
enum { ENOUGH = 1 << 22, LARGE = 1 << 22 };

/* The beginning of its own memory, which is much more than most decoders take: pages never written take none. */
struct Region {
    Region *next;
    uint8_t used[UNITS]; /* but for the first unit, which is this */
};

/* Of the decoder that was closed last, for the next one. */
static Region *spare;

static void lock(Pool *pool) {
    while (__atomic_test_and_set(&pool->locked, __ATOMIC_ACQUIRE)) {}
}

static void unlock(Pool *pool) { __atomic_clear(&pool->locked, __ATOMIC_RELEASE); }

/* The first that are free: they were written before, most likely. NULL where fewer are free in a row. */
static void *take_units(Region *region, size_t units) {
    for (size_t at = 1, run = 0; at < UNITS; at++) {
        run = region->used[at] ? 0 : run + 1;
        if (run < units) continue;
        size_t first = at + 1 - units;
        memset(region->used + first, 1, units);
        return (char *)region + first * UNIT;
    }
    return NULL;
}

static size_t whole_pages(size_t size) { return (size + LEAST_PAGE - 1) / LEAST_PAGE * LEAST_PAGE; }

/* Pages from the system, huge ones and small ones for the rest: malloc would keep the parts between aligned ones. */
static void *take_pages(size_t size) {
    size = whole_pages(size);
    char *memory = mmap(NULL, size + PAGE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return NULL;
    size_t before = -(uintptr_t)memory % PAGE;
    if (before > 0) munmap(memory, before);
    if (before < PAGE) munmap(memory + before + size, PAGE - before);
    madvise(memory + before, size, MADV_HUGEPAGE);
    return memory + before;
}

static void give_pages(void *memory, size_t size) { munmap(memory, whole_pages(size)); }

static void *take_of_regions(Pool *pool, size_t units) {
    for (Region *region = pool->regions; region != NULL; region = region->next) {
        void *memory = take_units(region, units);
        if (memory != NULL) return memory;
    }
    Region *region = __atomic_exchange_n(&spare, NULL, __ATOMIC_ACQUIRE);
    if (region == NULL) region = take_pages(REGION);
    if (region == NULL) return NULL;
    region->next = pool->regions;
    pool->regions = region;
    return take_units(region, units);
}

/* Whether memory was of a region. */
static bool give_to_regions(const Pool *pool, const void *memory, size_t units) {
    Region *region = pool->regions;
    while (region != NULL && (uintptr_t)memory - (uintptr_t)region >= REGION) region = region->next;
    if (region == NULL) return false;
    memset(region->used + ((uintptr_t)memory - (uintptr_t)region) / UNIT, 0, units);
    return true;
}

static void *take(void *host, size_t size) {
    Pool *pool = host;
    if (pool == NULL || size < UNIT || size > SIZE_MAX / 2) return malloc(size);
    if (size >= LARGE) return take_pages(size);
    lock(pool);
    bool enough = pool->taken >= ENOUGH;
    pool->taken += enough ? 0 : size;
    void *memory = enough ? take_of_regions(pool, (size + UNIT - 1) / UNIT) : NULL;
    unlock(pool);
    return memory != NULL ? memory : malloc(size);
}

static void give(void *host, void *memory, size_t size) {
    Pool *pool = host;
    if (pool != NULL && size >= UNIT && size < LARGE) {
        lock(pool);
        bool given = give_to_regions(pool, memory, (size + UNIT - 1) / UNIT);
        unlock(pool);
        if (given) return;
    }
    if (pool != NULL && size >= LARGE)
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
        if (pool->regions == NULL) {
            /* The next decoder writes these pages without a page fault. The system may take them back, and they are 0
             * then. */
            memset(region->used, 0, sizeof region->used);
            madvise(region, REGION, MADV_FREE);
            region = __atomic_exchange_n(&spare, region, __ATOMIC_ACQ_REL);
        }
        if (region != NULL) give_pages(region, REGION);
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
