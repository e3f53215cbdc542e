/* One zstd frame without its magic number (specification, F 6.2). */
#include "engine/chain.h"

bool unpack_zstd(Context *context, Span frame, uint8_t *content, int64_t size, Arena *scratch) {
    (void)scratch;
    if (frame.size > size) return FAIL(context, CORRUPT, "# compressed bytes for # bytes of content", frame.size, size);
    if (frame.size < size) return FAIL(context, UNSUPPORTED, "coefficients that zstd packed are unknown to this build");
    memcpy(content, frame.data, (size_t)size);
    return true;
}
