/* Which values a component has taken already, a bit each (specification, V 8.7, A 2.5): a row of `words` words. */
#ifndef BSM_SEEN_H
#define BSM_SEEN_H

#include "bitstream/kernel.h"

INLINE void mark_seen(int64_t *seen, int32_t v) { seen[v >> 6] |= (int64_t)(UINT64_C(1) << (v & 63)); }

/* The value seen that is nearest to v, downwards if two are; v if none is near. */
int32_t nearest_seen(const int64_t *seen, int64_t words, int32_t v);

#endif
