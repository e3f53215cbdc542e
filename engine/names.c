/* Names and sizes for callers. */
#include "engine/attributes.h"

const char *bsmdec_version(void) { return BSMDEC_VERSION; }

const char *bsmdec_status_name(bsmdec_status status) {
    switch (status) {
        case BSMDEC_OK: return "ok";
        case BSMDEC_MISUSED: return "misused";
        case BSMDEC_FORMAT: return "format";
        case BSMDEC_CORRUPT: return "corrupt";
        case BSMDEC_UNSUPPORTED: return "unsupported";
        case BSMDEC_LIMIT: return "limit";
        case BSMDEC_NUMERIC: return "numeric";
        case BSMDEC_NO_MEMORY: return "no memory";
        case BSMDEC_TRUNCATED: return "truncated";
        default: return "unknown";
    }
}

size_t bsmdec_kind_size(int kind) { return is_kind(kind) ? kind_size(kind) : 0; }
