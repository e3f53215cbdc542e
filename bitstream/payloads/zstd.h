/* zstd, of which packed coefficients are (specification, F 6.2). */
#pragma once

#include "bitstream/container/wire.h"

/* Unpack exactly `size` bytes. */
bool unpack_zstd(Context *context, Span frame, uint8_t *content, int64_t size, Arena *scratch);
