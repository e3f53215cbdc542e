/* bsmdec: decodes BSM streams of triangle meshes and their sequences (the law: spec/README.md).
 *
 * A decoder takes bytes as they come and tells events in turn; what an event speaks of is asked for by the functions behind
 * it, into memory of the caller. Nothing is global, nothing is printed, no file is opened. One decoder is one thread's at a
 * time; different decoders have nothing in common.
 *
 *     bsmdec *decoder = bsmdec_open(NULL);
 *     bsmdec_push(decoder, bytes, size);
 *     bsmdec_finish(decoder);
 *     bsmdec_event event;
 *     do bsmdec_next(decoder, &event);
 *     while (event.type != BSMDEC_END && event.type != BSMDEC_ERROR && event.type != BSMDEC_NEED_DATA);
 *     if (event.type == BSMDEC_END) {
 *         double *positions = malloc(event.vertices * 3 * sizeof *positions);
 *         bsmdec_positions(decoder, positions, event.vertices * 3);
 *     }
 */
#ifndef BSMDEC_H
#define BSMDEC_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define BSMDEC_VERSION "1.0.0"

#ifndef BSMDEC_API
#if defined(_WIN32) && defined(BSMDEC_SHARED)
#define BSMDEC_API __declspec(dllimport)
#elif defined(__GNUC__)
#define BSMDEC_API __attribute__((visibility("default")))
#else
#define BSMDEC_API
#endif
#endif

/* What went wrong (specification, F 1.1), and two that are no stream's fault. */
typedef enum {
    BSMDEC_OK = 0,
    BSMDEC_MISUSED = 2, /* a call that makes no sense; nothing was touched */
    BSMDEC_FORMAT = 3,
    BSMDEC_CORRUPT = 4,
    BSMDEC_UNSUPPORTED = 5,
    BSMDEC_LIMIT = 6,
    BSMDEC_NUMERIC = 7,
    BSMDEC_NO_MEMORY = 8, /* the allocator of the host gave none */
    BSMDEC_TRUNCATED = 12
} bsmdec_status;

/* Where and why; numbers that are not known are -1. */
typedef struct {
    bsmdec_status status;
    int64_t offset, frame, block;
    char message[160];
} bsmdec_error;

/* Upper bounds (specification, M 14); `bsmdec_default_limits` has those that are usual. Work is in nanoseconds of a processor
 * core, estimated, memory in bytes; both are granted at once, and for each vertex and each byte that have come. */
typedef struct {
    double vertices, faces, blocks, block_size, coefficients, frames, gop_frames, frame_bytes, metadata_bytes;
    double attributes, attribute_values, sequence_bytes, field_bytes;
    double work, work_per_vertex, work_per_byte, most_work;
    double memory, memory_per_vertex, memory_per_byte, most_memory;
    double heap; /* what a decoder may have of its allocator at a time, whatever the stream is */
} bsmdec_limits;

/* `allocate` returns memory aligned as malloc's, or NULL; `release` is told the size that was asked for. */
typedef struct {
    void *(*allocate)(void *host, size_t size);
    void (*release)(void *host, void *memory, size_t size);
    void *host;
} bsmdec_allocator;

/* How to decode; zeros mean what is usual. */
typedef struct {
    const bsmdec_limits *limits;
    const bsmdec_allocator *allocator;
    int tolerant; /* go on behind damage, and tell of it (specification, F 8) */
    int64_t start; /* of a sequence: tell of no frame before this one, and decode no GOP that it does not need */
} bsmdec_options;

typedef enum {
    BSMDEC_NEED_DATA,     /* push more, or finish */
    BSMDEC_HEADER,        /* what the stream claims: vertices, faces */
    BSMDEC_METADATA,      /* `index` of them are known now */
    BSMDEC_CONNECTIVITY,  /* faces can be asked for; vertices and faces are real */
    BSMDEC_BLOCK,         /* block `index` was decoded, or so many vertices of a grid */
    BSMDEC_REFINEMENT,    /* more vertices were refined */
    BSMDEC_ATTRIBUTE,     /* attribute `index` can be asked for */
    BSMDEC_FRAME,         /* frame `index` of a sequence can be asked for */
    BSMDEC_LOSS,          /* of a tolerant decoder: something was lost, `bsmdec_last_loss` tells what */
    BSMDEC_END,           /* the mesh is whole: positions can be asked for; or all frames were told */
    BSMDEC_END_OF_STREAM, /* nothing follows */
    BSMDEC_ERROR          /* the first error, again and again; `bsmdec_last_error` tells */
} bsmdec_event_type;

typedef struct {
    bsmdec_event_type type;
    int64_t index;
    int64_t count;           /* of a LOSS: so many frames from `index` on; 0 if it is of none */
    int64_t vertices, faces; /* as the user has them; 0 until they are known */
} bsmdec_event;

enum { BSMDEC_VERTEX, BSMDEC_CORNER, BSMDEC_FACE };                         /* what has a value */
enum { BSMDEC_GENERIC, BSMDEC_COLOR, BSMDEC_NORMAL, BSMDEC_TEXCOORD };      /* what values mean */
enum { BSMDEC_UINT8, BSMDEC_INT8, BSMDEC_UINT16, BSMDEC_INT16, BSMDEC_UINT32, BSMDEC_INT32, BSMDEC_FLOAT32, BSMDEC_FLOAT64 };

typedef struct {
    const char *name; /* UTF-8, ends with 0 */
    int domain, semantic, kind, components;
    int64_t rows;     /* values; of corners, `indices` say which one each has */
    int64_t indices;  /* 3 faces for corners, 0 for others */
    int moves;        /* whether frames have values of their own: those of the frame told last, before it of the first */
} bsmdec_attribute;

/* What the author says of a mesh, one entry: a whole number, a number, UTF-8 (ends with 0) or bytes. */
enum { BSMDEC_WHOLE = 1, BSMDEC_NUMBER, BSMDEC_TEXT, BSMDEC_BYTES };
typedef struct {
    const char *name;
    int type;
    int64_t whole;
    double number;
    const void *bytes;
    size_t size;
} bsmdec_metadata;

typedef struct bsmdec bsmdec;

BSMDEC_API void bsmdec_default_limits(bsmdec_limits *limits);

/* A decoder, or NULL without memory; `options` may be NULL. */
BSMDEC_API bsmdec *bsmdec_open(const bsmdec_options *options);
BSMDEC_API void bsmdec_close(bsmdec *decoder);

/* More bytes of the stream, as many as there are; they are copied. */
BSMDEC_API bsmdec_status bsmdec_push(bsmdec *decoder, const void *bytes, size_t size);
/* No more bytes will come. */
BSMDEC_API bsmdec_status bsmdec_finish(bsmdec *decoder);
/* The next event; the status of the stream's error if it is BSMDEC_ERROR. */
BSMDEC_API bsmdec_status bsmdec_next(bsmdec *decoder, bsmdec_event *event);

/* Each fills an array of the caller of exactly so many numbers, and is BSMDEC_MISUSED, with nothing written, where the size is
 * another or what is asked for is not there. Positions are those of the frame told last, or of the mesh; before its END as far
 * as they are known then, and not a number (NaN) where nothing is. */
BSMDEC_API bsmdec_status bsmdec_faces(bsmdec *decoder, uint32_t *corners, size_t count);
BSMDEC_API bsmdec_status bsmdec_positions(bsmdec *decoder, double *coordinates, size_t count);
BSMDEC_API bsmdec_status bsmdec_positions_single(bsmdec *decoder, float *coordinates, size_t count);

/* Entry `index` of those that have come; its text lives as long as the decoder. */
BSMDEC_API bsmdec_status bsmdec_metadata_at(const bsmdec *decoder, int64_t index, bsmdec_metadata *entry);

BSMDEC_API int bsmdec_attribute_count(const bsmdec *decoder);
BSMDEC_API bsmdec_status bsmdec_attribute_at(const bsmdec *decoder, int index, bsmdec_attribute *attribute);
/* `size` in bytes: rows times components times those of the kind. */
BSMDEC_API bsmdec_status bsmdec_attribute_values(bsmdec *decoder, int index, void *values, size_t size);
BSMDEC_API bsmdec_status bsmdec_attribute_indices(bsmdec *decoder, int index, uint32_t *indices, size_t count);

/* The first error, BSMDEC_OK if there is none; the loss that was told last. They live as long as the decoder. */
BSMDEC_API const bsmdec_error *bsmdec_last_error(const bsmdec *decoder);
BSMDEC_API const bsmdec_error *bsmdec_last_loss(const bsmdec *decoder);

#ifdef __cplusplus
}
#endif

#endif
