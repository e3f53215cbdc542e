/* What a page asks of the encoder: one mesh or sequence, part by part. Arrays are in memory of `page_take`. */
#include "library/bsmenc.h"
#include "library/wasm/page.h"

#ifdef BSMDEC_WRITES

enum { MOST = 256 };
/* Of the page: receives the finished part of the work; other than 0 ends it. */
__attribute__((import_module("page"), import_name("progress"))) extern int page_progress(double part);

static bsmenc_mesh mesh;
static bsmenc_attribute attributes[MOST];
static bsmdec_metadata entries[MOST];
static bsmenc_stream *stream;

static int tell(void *host, double part) {
    (void)host;
    return page_progress(part);
}

void encode_begin(int vertices, int faces, const double *positions, const float *single, const uint32_t *corners,
    int frames) {
    mesh = (bsmenc_mesh){sizeof mesh, vertices, faces, positions, single, corners, attributes, 0, entries, 0, frames};
}

/* An attribute of which the page says the numbers in this order; false if there are too many. */
int encode_attribute(const char *name, int domain, int semantic, int kind, int components, int rows,
    const void *values, const uint32_t *indices, int quality, double amount) {
    if (mesh.attribute_count == MOST) return 0;
    attributes[mesh.attribute_count++] = (bsmenc_attribute){name, domain, semantic, kind, components, rows, values,
        indices, quality, amount};
    return 1;
}

int encode_metadata(const char *name, int type, double number, const void *bytes, int size) {
    if (mesh.metadata_count == MOST) return 0;
    int64_t whole = type == BSMDEC_WHOLE ? (int64_t)number : 0;
    entries[mesh.metadata_count++] = (bsmdec_metadata){name, type, whole, number, bytes, (size_t)size};
    return 1;
}

int encode_run(int positions, int bits, double cell, double x, double y, double z, int keep_order, int quick) {
    bsmdec_allocator host = page_host();
    bsmenc_options options = {sizeof options, positions, bits, cell, {x, y, z}, keep_order, quick, NULL, &host, tell,
        NULL};
    return bsmenc_encode(&mesh, &options, &stream);
}

/* Of the last run: the error; the stream, and its length. */
const char *encode_message(void) { return stream == NULL ? "out of memory" : stream->message; }
const uint8_t *encode_bytes(void) { return stream->bytes; }
int encode_size(void) { return (int)stream->size; }

#endif
