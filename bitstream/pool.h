/* Memory of the C library, of which Linux makes huge pages where much is asked for: few page faults, not many. */
#pragma once

#include "bitstream/kernel.h"
#include "library/bsmdec.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define BSMDEC_CHECKED
#endif
#endif
/* What checks memory has to see each piece by itself. */
#if __STDC_HOSTED__ && defined(__linux__) && !defined(__ANDROID__) && !defined(__STRICT_ANSI__) \
    && !defined(__SANITIZE_ADDRESS__) && !defined(BSMDEC_CHECKED)
#define BSMDEC_POOL
#endif

typedef struct Region Region;
typedef struct { /* all zero: empty */
    Region *regions;
    size_t taken; /* bytes so far that could have been of regions */
    bool locked;  /* threads of the host take turns */
} Pool;

/* malloc and free. */
bsmdec_allocator library_allocator(void);

#ifdef BSMDEC_POOL
/* The same with a pool, which must stay where it is; other allocators as they are. */
bsmdec_allocator with_pool(bsmdec_allocator host, Pool *pool);
/* Gives the memory of a pool back, and returns the allocator without it. */
bsmdec_allocator without_pool(bsmdec_allocator host);
#else
INLINE bsmdec_allocator with_pool(bsmdec_allocator host, Pool *pool) { return (void)pool, host; }
INLINE bsmdec_allocator without_pool(bsmdec_allocator host) { return host; }
#endif
