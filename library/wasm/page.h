/* What a page asks of a decoder beside bsmdec.h; one decoder in one memory. */
#pragma once

#include "library/bsmdec.h"

void *page_take(size_t size);
void page_give(void *memory, size_t size);
bsmdec_allocator page_host(void);
/* What coefficients start from (web/scripts/kernels.mjs). */
void make_priors(void);
