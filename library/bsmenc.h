/* bsmenc: an encoder of triangle meshes to BSM streams, with positions on a grid or exact, and of frames that share
 * their faces. bsmdec.h reads them.
 *
 *     bsmenc_mesh mesh = {sizeof mesh, vertices, faces, NULL, positions, corners};
 *     bsmenc_stream *stream;
 *     if (bsmenc_encode(&mesh, NULL, &stream) == BSMENC_OK)
 *         fwrite(stream->bytes, 1, stream->size, file);
 *     else
 *         fprintf(stderr, "%s\n", stream->message);
 *     bsmenc_release(stream);
 *
 * Promise: each call decodes the stream with bsmdec before it returns it, and compares faces, positions, attributes and
 * metadata with the mesh that you gave. A stream that does not keep what the options ask for is never returned.
 * Threads: calls are independent: they share nothing but constant tables.
 * Memory: all memory comes from the allocator in the options, and bsmenc_release gives it back. Your arrays are only
 * read, during the call.
 * Input: numbers and indices are checked. Nothing is printed, and no file is opened.
 * Version 0: functions and structures may change with a minor release until 1.0. The streams are those of format 1.0.
 */
#ifndef BSMENC_H
#define BSMENC_H

#include "bsmdec.h"

#ifdef __cplusplus
extern "C" {
#endif

#define BSMENC_VERSION "0.1.0"

/* Result of a call. */
typedef enum {
    BSMENC_OK = 0,
    BSMENC_MISUSED = 2,      /* an option or a part of the mesh is wrong; the message says which */
    BSMENC_UNSUPPORTED = 5,  /* this library was compiled to arithmetic that gives other results */
    BSMENC_LIMIT = 6,        /* a decoder with these limits would refuse the stream */
    BSMENC_NUMERIC = 7,      /* a computation gave a number that is not finite */
    BSMENC_NO_MEMORY = 8,    /* the allocator returned NULL */
    BSMENC_UNREACHABLE = 10, /* the mesh cannot be kept as the options ask */
    BSMENC_FAULT = 11,       /* the decoded stream differs from the mesh: a fault of this library, please report it */
    BSMENC_STOPPED = 13      /* `progress` asked for that */
} bsmenc_status;

/* Quality of an attribute. Integers and labels are exact by default; of floats, normals have 12 bits, colors 16,
 * texture coordinates 14 and others 20. */
typedef enum {
    BSMENC_DEFAULT,
    BSMENC_EXACT,     /* every bit */
    BSMENC_BITS,      /* `amount` bits of each number, 1 to 32; of normals on an octahedron, 2 to 16 */
    BSMENC_BOUND,     /* largest error of a number */
    BSMENC_SHARE,     /* the same, in percent of the attribute's range */
    BSMENC_ANGLE,     /* largest error of a normal, in degrees */
    BSMENC_RECOMPUTE, /* normals: the decoder computes them from the faces, weighted by area */
    BSMENC_OMIT
} bsmenc_quality;

/* Values of vertices, corners or faces; domain, semantic and kind are constants of bsmdec.h. */
typedef struct {
    const char *name;         /* UTF-8, 1 to 255 bytes */
    int domain, semantic, kind;
    int components;           /* numbers of a value, 1 to 4 */
    int64_t rows;             /* values: as many as vertices or faces; of corners any number */
    const void *values;       /* row by row; floats must be finite */
    const uint32_t *indices;  /* corners only: the row of each corner, 3 for each face; NULL: corner i has row i */
    int quality;              /* a bsmenc_quality */
    double amount;
} bsmenc_attribute;

/* What to encode. The first field is sizeof(bsmenc_mesh): a later release may add fields at the end. */
typedef struct {
    size_t size;
    int64_t vertices, faces;
    const double *positions;       /* x, y, z of each vertex, or NULL: */
    const float *positions_single; /* the same in single precision */
    const uint32_t *corners;       /* vertices of all faces, 3 for each, counted from 0 */
    const bsmenc_attribute *attributes;
    size_t attribute_count;
    const bsmdec_metadata *metadata; /* names must be different, and at most 255 bytes long */
    size_t metadata_count;
    /* 0: one mesh. Otherwise a sequence: all positions of the first frame are followed by those of the next one, and so
     * on. No coordinate of a frame is farther off than on a grid of the options' bits, or cells. Attributes stay. */
    int64_t frames;
} bsmenc_mesh;

/* What positions become. */
typedef enum {
    BSMENC_GRID,    /* rounded to a grid of `bits` along the longest side of the bounding box */
    BSMENC_CELLS,   /* rounded to `origin` + k * `cell`, k whole numbers: parts that are encoded apart fit together */
    BSMENC_LOSSLESS /* kept in single precision, to the bit, and so are attributes of default quality */
} bsmenc_positions;

/* How to encode: `bsmenc_options options = BSMENC_OPTIONS;`, then set what you need. 0 and NULL are the defaults. */
typedef struct {
    size_t size; /* sizeof(bsmenc_options) */
    int positions;
    int bits;    /* BSMENC_GRID: 1 to 20; 0: 14 */
    double cell, origin[3];
    int keep_order; /* 1: keep the order of vertices and faces, copies of vertices, and vertices in no face. 0: make one
                     * vertex of those at one position, and leave out vertices in no face, and faces that lose their
                     * area */
    int quick;      /* 1: grids that are quick to decode, and some more bytes */
    const bsmdec_limits *limits;       /* of the decoder that the stream is for; NULL: the defaults */
    const bsmdec_allocator *allocator; /* NULL: malloc and free */
    /* Called now and then with the finished part of the work, from 0 to 1. If it returns other than 0, the call ends
     * with BSMENC_STOPPED. May be NULL. */
    int (*progress)(void *host, double part);
    void *host;
} bsmenc_options;
#define BSMENC_OPTIONS {sizeof(bsmenc_options), BSMENC_GRID, 0, 0.0, {0.0, 0.0, 0.0}, 0, 0, NULL, NULL, NULL, NULL}

/* What became of an attribute. */
typedef struct {
    int index;      /* of the attribute in the stream; -1: left out */
    double error;   /* largest error of a number; of normals that were rounded, in degrees */
    double step;    /* of integers in steps; 0 for others */
    int bits;       /* of each number of a normal that was rounded, 0 for others */
    int recomputed; /* 1: the decoder computes the normals */
    int64_t zeros;  /* normals without a length */
    int scaled;     /* 1: normals had other lengths than 1 and have not */
} bsmenc_outcome;

/* A stream, and what became of the mesh. Everything belongs to the stream until bsmenc_release. After an error only
 * `status` and `message` are set. */
typedef struct {
    bsmenc_status status;
    const char *message; /* a sentence in English; "" if nothing is wrong */
    const uint8_t *bytes;
    size_t size;
    int64_t vertices, faces;     /* that the decoder has */
    const int32_t *vertex_order; /* of each of the decoder's vertices: your vertex, or the first one at its place */
    const int32_t *face_order;   /* of each of the decoder's faces: your face */
    int64_t merged;    /* vertices that became one with another at their position */
    int64_t loose;     /* vertices in no face that were left out */
    int64_t collapsed; /* faces that were left out because all of their corners were not at different positions */
    int64_t moved;     /* BSMENC_LOSSLESS: coordinates that single precision has moved, */
    double error;      /* and by how much at most; otherwise the largest error of a coordinate */
    const bsmenc_outcome *outcomes; /* of each of the mesh's attributes */
} bsmenc_stream;

/* "0.1.0". Valid for ever. */
BSMDEC_API const char *bsmenc_version(void);

/* Encode a mesh. `options` may be NULL. Returns the status, and sets `stream` in any case, also after an error: release
 * it. It is NULL only if there is no memory for the structure itself. */
BSMDEC_API bsmenc_status bsmenc_encode(
    const bsmenc_mesh *mesh, const bsmenc_options *options, bsmenc_stream **stream);

/* Release a stream with all its memory. `stream` may be NULL. */
BSMDEC_API void bsmenc_release(bsmenc_stream *stream);

#ifdef __cplusplus
}
#endif

#endif
