/* bsmdec: a decoder for BSM streams of triangle meshes and mesh sequences. The format is specified in spec/README.md.
 *
 * Push bytes as they arrive and poll for events. After an event, call the getters below; they copy into buffers you
 * own.
 *
 *     bsmdec *decoder = bsmdec_open(NULL);
 *     bsmdec_push(decoder, bytes, size);
 *     bsmdec_finish(decoder);
 *     bsmdec_event event;
 *     do bsmdec_next(decoder, &event);
 *     while (event.type != BSMDEC_END && event.type != BSMDEC_ERROR);
 *     if (event.type == BSMDEC_END) {
 *         double *positions = malloc(event.vertices * 3 * sizeof *positions);
 *         bsmdec_positions(decoder, positions, event.vertices * 3);
 *     }
 *     bsmdec_close(decoder);
 *
 * Threads: one thread at a time may use a decoder. Separate decoders are independent: they share nothing but
 * constant tables and, one after the other, memory.
 * Memory: all memory comes from the allocator in the options, and bsmdec_close releases it. Without an allocator, Linux
 * may keep up to 64 MB of a closed decoder for the next one, until anything needs them. The library copies the bytes
 * you push. Pointers that it returns point into the decoder. They are valid until bsmdec_close unless it says
 * otherwise.
 * Input: a stream may come from an untrusted source. Its memory and time are bounded by the limits in the options.
 * Nothing is printed, and no file is opened.
 */
#ifndef BSMDEC_H
#define BSMDEC_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Header version; bsmdec_version() returns the library version. */
#define BSMDEC_VERSION "1.0.0"

/* Windows: define BSMDEC_SHARED before you include this header to link the DLL, BSMDEC_EXPORT to build it. */
#ifndef BSMDEC_API
#if defined(_WIN32) && defined(BSMDEC_SHARED)
#define BSMDEC_API __declspec(dllimport)
#elif defined(_WIN32) && defined(BSMDEC_EXPORT)
#define BSMDEC_API __declspec(dllexport)
#elif defined(__GNUC__)
#define BSMDEC_API __attribute__((visibility("default")))
#else
#define BSMDEC_API
#endif
#endif

/* ---- Status and errors ---- */

/* Result of a call. The stream is at fault for all but BSMDEC_MISUSED and BSMDEC_NO_MEMORY (specification, F 1.1). */
typedef enum {
    BSMDEC_OK = 0,
    BSMDEC_MISUSED = 2,     /* this call is not possible now, or an argument is wrong; bsmdec_last_misuse says which */
    BSMDEC_FORMAT = 3,      /* not a BSM stream */
    BSMDEC_CORRUPT = 4,     /* contradicts the specification, itself, or a checksum */
    BSMDEC_UNSUPPORTED = 5, /* needs a version or an extension that this library does not have; or this
                             * library was compiled to arithmetic that gives other results */
    BSMDEC_LIMIT = 6,       /* needs more than the limits allow */
    BSMDEC_NUMERIC = 7,     /* a computation gave a number that is not finite */
    BSMDEC_NO_MEMORY = 8,   /* the allocator returned NULL */
    BSMDEC_TRUNCATED = 12   /* the stream ends too early */
} bsmdec_status;

/* Where a stream is wrong, and why. Unknown places are -1. */
typedef struct {
    bsmdec_status status;
    int64_t offset;    /* byte of the stream */
    int64_t frame;     /* section of the stream, counted from 0; no frame of a sequence */
    int64_t block;     /* block of the mesh */
    char message[160]; /* a sentence in English, ends with 0 */
    const char *limit; /* the member of bsmdec_limits that is too small, valid for ever; NULL: none, or not known */
    double value;      /* of it that the stream needs */
} bsmdec_error;

/* "1.0.0". The pointers of the next two functions are valid for ever. */
BSMDEC_API const char *bsmdec_version(void);

/* Name of a status, such as "corrupt". */
BSMDEC_API const char *bsmdec_status_name(bsmdec_status status);

/* ---- Options ----
 *
 * You fill the next three structures. The first field of each is its size in bytes, sizeof(the structure): a later
 * release may add fields at the end. A program compiled with an older header then gets the defaults of the new fields.
 * A program compiled with a newer header may use an older library if the fields that this library does not know are 0.
 * Any other size, 0 too, is a misuse: bsmdec_open returns a decoder whose every call fails with BSMDEC_MISUSED.
 */

/* Upper bounds (specification, M 14). Set them with bsmdec_default_limits, then change what you need. A stream that
 * needs more fails with BSMDEC_LIMIT before the memory is allocated or the time is spent. No limit may be negative or
 * NaN. */
typedef struct {
    size_t size; /* sizeof(bsmdec_limits) */
    /* Of the mesh: vertices, faces, blocks, vertices of a block, coefficients of a block. */
    double vertices, faces, blocks, block_size, coefficients;
    /* Of a sequence: frames, and frames of a group of pictures (GOP). Bytes of one section, and of all metadata. */
    double frames, gop_frames, frame_bytes, metadata_bytes;
    /* Number of attributes, and of numbers in all of them. Bytes to decode a GOP; a grid, refinement or attribute. */
    double attributes, attribute_values, sequence_bytes, field_bytes;
    /* Estimated CPU time in nanoseconds: at once, for each vertex, for each byte received, and the most of all. */
    double work, work_per_vertex, work_per_byte, most_work;
    /* Estimated memory in bytes: at once, for each vertex, for each byte received, and the most of all. */
    double memory, memory_per_vertex, memory_per_byte, most_memory;
    /* Bytes that the decoder may hold of its allocator at any time, its own structure included. */
    double heap;
} bsmdec_limits;

/* Your memory functions. `allocate` returns memory aligned as by malloc, or NULL. `release` gets the size that was
 * asked for. Both get `host`. They are called in the thread that calls the library. */
typedef struct {
    size_t size; /* sizeof(bsmdec_allocator) */
    void *(*allocate)(void *host, size_t size);
    void (*release)(void *host, void *memory, size_t size);
    void *host;
} bsmdec_allocator;

/* Where bsmdec_decode puts one thing into each vertex. `semantic` is BSMDEC_POSITION or a meaning of attributes, such
 * as BSMDEC_NORMAL. The field takes the first attribute with this meaning and, if `name` is not NULL, this name.
 * `kind` and `components` are those to write (see bsmdec_split_values), `offset` counts bytes from the start of the
 * vertex. */
typedef struct {
    int semantic;
    const char *name;
    int kind, components;
    size_t offset;
} bsmdec_field;

/* Threads of the host. `run` calls task(context, i) once for each i from 0 to `count` - 1, in any order and in any
 * threads, and returns when all calls have returned. `count` is at most `threads`, the number of calls that should run
 * at the same time; with 1 or less the decoder uses one thread. Only functions of bsmdec call `run`, in the thread that
 * called them. examples/threads.c has a `run` for POSIX threads.
 *
 * Events, errors and values are the same for any number of threads. The decoder decodes ahead of its events what was
 * pushed: push the whole stream, or large pieces of it, before you ask for events. The allocator must allow calls from
 * several threads at the same time, as malloc does. All threads together may hold as much memory as `limits.heap`
 * allows the decoder alone. */
typedef struct {
    size_t size; /* sizeof(bsmdec_parallel) */
    void (*run)(void *host, int count, void (*task)(void *context, int index), void *context);
    void *host;
    int64_t threads;
} bsmdec_parallel;

/* How to decode: `bsmdec_options options = BSMDEC_OPTIONS;`, then set what you need. 0 and NULL are the defaults. The
 * library copies everything that the options point to, the fields and their names included. */
typedef struct {
    size_t size;                       /* sizeof(bsmdec_options) */
    const bsmdec_limits *limits;       /* NULL: those of bsmdec_default_limits */
    const bsmdec_allocator *allocator; /* NULL: malloc and free */
    int tolerant;                      /* 1: report damage as BSMDEC_LOSS and go on (specification, F 8) */
    int64_t start;                     /* sequences: first frame to report, 0 if negative; earlier GOPs are skipped if
                                        * possible */
    const bsmdec_field *fields;        /* bsmdec_decode only: the layout of a vertex; NULL: everything, as floats */
    size_t field_count;                /* elements of `fields` */
    size_t stride;                     /* bytes from one vertex to the next; 0: as few as the fields need, aligned */
    size_t index_size;                 /* bytes of an index: 2, 4, or 0 for 2 if that suffices */
    const bsmdec_parallel *parallel;   /* NULL: one thread */
    int64_t layers;                    /* meshes with refinement: 1: stop after the blocks; skip refinement and
                                        * coded attributes */
} bsmdec_options;
#define BSMDEC_OPTIONS {sizeof(bsmdec_options), NULL, NULL, 0, 0, NULL, 0, 0, 0, NULL, 0}

/* A decoder. */
typedef struct bsmdec bsmdec;

/* Fill `limits`, a structure of `size` bytes (sizeof *limits), with the defaults, and set its field `size`.
 * BSMDEC_MISUSED, and nothing is written, if `limits` is NULL, or the size is less than in release 1.0 or more than
 * 4096. */
BSMDEC_API bsmdec_status bsmdec_default_limits(bsmdec_limits *limits, size_t size);

/* ---- Decoder ---- */

/* Create a decoder. `options` may be NULL. Returns NULL only if memory is exhausted, or if `limits.heap` is less than a
 * decoder takes. If the options are wrong, every call fails with BSMDEC_MISUSED, and bsmdec_last_error says what is
 * wrong with them. */
BSMDEC_API bsmdec *bsmdec_open(const bsmdec_options *options);

/* Release a decoder and all its memory. `decoder` may be NULL. */
BSMDEC_API void bsmdec_close(bsmdec *decoder);

/* Append the next bytes of the stream, any number of them. The decoder copies them. Nothing is decoded yet. Returns the
 * status of the first error of the stream; BSMDEC_MISUSED after bsmdec_finish. */
BSMDEC_API bsmdec_status bsmdec_push(bsmdec *decoder, const void *bytes, size_t size);

/* Signal the end of input. Without this call a stream that was cut off is only waiting for data. */
BSMDEC_API bsmdec_status bsmdec_finish(bsmdec *decoder);

typedef enum {
    BSMDEC_NEED_DATA,     /* nothing to report: push more bytes, or call bsmdec_finish */
    BSMDEC_HEADER,        /* a header was read: `vertices`, `faces`, `frames` are the claims of the stream */
    BSMDEC_METADATA,      /* metadata entries 0 to `index` - 1 are available */
    BSMDEC_CONNECTIVITY,  /* faces are available; `vertices` and `faces` are now final for this mesh */
    BSMDEC_BLOCK,         /* block `index` was decoded; more positions are known */
    BSMDEC_REFINEMENT,    /* more vertices were refined, `index` of them so far */
    BSMDEC_ATTRIBUTE,     /* attribute `index` is available */
    BSMDEC_FRAME,         /* frame `index` of a sequence is the current one: ask for its positions now */
    BSMDEC_LOSS,          /* tolerant decoders: data was lost (bsmdec_last_loss); in sequences, frames `index` to
                           * `index` + `count` - 1; `count` may be 0 */
    BSMDEC_END,           /* a mesh: all positions are available. A sequence: all frames were reported */
    BSMDEC_END_OF_STREAM, /* nothing follows; reported again and again */
    BSMDEC_ERROR,         /* the stream cannot be decoded, see bsmdec_last_error; reported again and again */
    BSMDEC_VALUES         /* some values of attribute `index` arrived, see bsmdec_read_values; ATTRIBUTE comes last */
} bsmdec_event_type;

typedef struct {
    bsmdec_event_type type;
    int64_t index, count;
    int64_t vertices, faces; /* of the current mesh; 0 before BSMDEC_HEADER */
    int64_t frames;          /* of the whole sequence; 0 for meshes, and if the encoder did not know their number */
} bsmdec_event;

/* Decode until there is something to report, and write that to `event`. Returns the status of the error for
 * BSMDEC_ERROR, otherwise BSMDEC_OK. Ignore types of events that you do not know; a later release may add some.
 *
 * A mesh reports HEADER, METADATA (if there are any), CONNECTIVITY, BLOCK (many), REFINEMENT, ATTRIBUTE (one for
 * each), END. A sequence reports HEADER, CONNECTIVITY, BLOCK, ATTRIBUTE as a mesh does, then FRAME (one for each),
 * END. A sequence whose faces change has several runs: for each a HEADER, a CONNECTIVITY and what follows. The faces
 * and attributes that were available before such a HEADER are not available any more. */
BSMDEC_API bsmdec_status bsmdec_next(bsmdec *decoder, bsmdec_event *event);

/* ---- Getters ----
 *
 * Each fills an array that you own of exactly `count` elements, or of exactly `size` bytes. It returns BSMDEC_MISUSED
 * and writes nothing if the count is wrong or the data is not available; bsmdec_last_misuse says which. Another status
 * is the decoder's error: memory ran out during the call, and the decoder does not go on; or, of positions, an
 * earlier error, after which they are not available.
 */

/* Vertices of all faces: 3 for each face, counted from 0. Available from CONNECTIVITY on. */
BSMDEC_API bsmdec_status bsmdec_faces(bsmdec *decoder, uint32_t *corners, size_t count);

/* x, y, z of all vertices, in the unit of the mesh, as double or as float. Of a sequence, from the first FRAME on:
 * those of the current frame. Of a mesh, from the first BLOCK on: before END the coordinates of unknown vertices are
 * NaN, and those of others may still change. */
BSMDEC_API bsmdec_status bsmdec_positions(bsmdec *decoder, double *coordinates, size_t count);
BSMDEC_API bsmdec_status bsmdec_positions_single(bsmdec *decoder, float *coordinates, size_t count);

/* ---- Attributes ---- */

/* The owner of a value: a vertex; a corner, that is a vertex in one face; or a face. */
enum { BSMDEC_VERTEX, BSMDEC_CORNER, BSMDEC_FACE };
/* The meaning of the values. */
enum { BSMDEC_GENERIC, BSMDEC_COLOR, BSMDEC_NORMAL, BSMDEC_TEXCOORD };
/* Type of the numbers. */
enum {
    BSMDEC_UINT8, BSMDEC_INT8, BSMDEC_UINT16, BSMDEC_INT16, BSMDEC_UINT32, BSMDEC_INT32, BSMDEC_FLOAT32, BSMDEC_FLOAT64
};

/* Bytes of a number of a kind, such as 4 for BSMDEC_FLOAT32; 0 for an unknown kind. */
BSMDEC_API size_t bsmdec_kind_size(int kind);

typedef struct {
    const char *name; /* UTF-8, ends with 0; valid until the next HEADER */
    int domain, semantic, kind; /* constants from the three enumerations above */
    int components;   /* numbers of a value, such as 2 for texture coordinates */
    int64_t rows;     /* values. For corners see `indices` */
    int64_t indices;  /* corners: 3 for each face; bsmdec_attribute_indices gives the row of each corner. Otherwise 0 */
    int moves;        /* 1 if the values change from frame to frame; the getters give those of the current frame */
} bsmdec_attribute;

/* Attributes of the mesh, also of those that are not available yet. */
BSMDEC_API int bsmdec_attribute_count(const bsmdec *decoder);

/* Describe attribute `index`. Available from its ATTRIBUTE event on. */
BSMDEC_API bsmdec_status bsmdec_attribute_at(bsmdec *decoder, int index, bsmdec_attribute *attribute);

/* The values, row by row. `size` is in bytes: rows * components * size of the kind. */
BSMDEC_API bsmdec_status bsmdec_attribute_values(bsmdec *decoder, int index, void *values, size_t size);

/* Corners only: the row of each corner, in the order of bsmdec_faces. `count` is the field `indices`. */
BSMDEC_API bsmdec_status bsmdec_attribute_indices(bsmdec *decoder, int index, uint32_t *indices, size_t count);

/* ---- Metadata ----
 *
 * Entries that the author of the stream chose. Names are free; these are known (spec/registry.md):
 *
 *     name                     type            what
 *     unit                     text            of the positions: "mm", "m", "in", ...
 *     up                       text            the axis that points up: "y" or "z"
 *     frame_rate               number, whole   frames per second of a sequence
 *     name                     text            of the mesh
 *     material.N.name          text            name of material N; material.N.Kd, material.N.baseColorFactor and others
 *                                              hold its parameters in the words of MTL or glTF
 *     material.names           text            names of all materials, one a line, if there are more than 16
 *     image.N.name, .data      text, bytes     file name and content of image N; material.N.map_Kd or
 *                                              material.N.baseColorTexture is its number
 *     group.N.name             text            name of group N; likewise object.N.name, part.N.name, and group.names
 *
 * The number of a face's material, group, object or part is the value of the attribute "material", "group", "object" or
 * "part", of domain BSMDEC_FACE.
 */
enum { BSMDEC_WHOLE = 1, BSMDEC_NUMBER, BSMDEC_TEXT, BSMDEC_BYTES };

typedef struct {
    const char *name;  /* UTF-8, ends with 0 */
    int type;          /* says which of the next fields holds the value */
    int64_t whole;     /* BSMDEC_WHOLE */
    double number;     /* BSMDEC_NUMBER */
    const void *bytes; /* BSMDEC_TEXT: UTF-8, ends with 0. BSMDEC_BYTES */
    size_t size;       /* bytes of `bytes`, without the 0 */
} bsmdec_metadata;

/* Entry `index`. METADATA events say how many there are so far. The pointers are valid until bsmdec_close. */
BSMDEC_API bsmdec_status bsmdec_metadata_at(bsmdec *decoder, int64_t index, bsmdec_metadata *entry);

/* The entry of this name (UTF-8). BSMDEC_MISUSED if there is none so far. */
BSMDEC_API bsmdec_status bsmdec_metadata_find(bsmdec *decoder, const char *name, bsmdec_metadata *entry);

/* ---- Vertices for graphics ----
 *
 * Graphics APIs use one index for a whole vertex. bsmdec_split makes such vertices: first the vertices of the mesh, in
 * their order, then a copy for each further combination of corner values. Write them into buffers of your own, such as
 * mapped graphics memory. Write the values again for each FRAME, or for each BLOCK.
 *
 *     int64_t vertices;
 *     bsmdec_split(decoder, NULL, BSMDEC_ALL, &vertices);
 *     bsmdec_split_indices(decoder, 4, indices, 3 * faces);
 *     bsmdec_split_values(decoder, BSMDEC_POSITION, BSMDEC_FLOAT32, 3, stride, buffer, size);
 *     bsmdec_split_values(decoder, normals, BSMDEC_INT8, 3, stride, buffer + 12, size - 12);
 */

/* In the place of an attribute: positions; no attribute; all attributes. */
enum { BSMDEC_POSITION = -1, BSMDEC_ABSENT = -2, BSMDEC_ALL = -1 };

/* Split the vertices of the mesh where `count` attributes of vertices or corners differ, and write their number to
 * `vertices`. BSMDEC_ALL as `count` means all available ones. Available from CONNECTIVITY on, with attributes
 * from their ATTRIBUTE on. It holds until the next call, or until the next HEADER. */
BSMDEC_API bsmdec_status bsmdec_split(bsmdec *decoder, const int *attributes, int count, int64_t *vertices);

/* The split vertices of all faces: `count` indices, 3 for each face, of `index_size` bytes, 2 or 4. With 2 there can be
 * 65,535 vertices. */
BSMDEC_API bsmdec_status bsmdec_split_indices(bsmdec *decoder, size_t index_size, void *indices, size_t count);

/* Write the values of an attribute, or the positions, of all split vertices. `to` is where those of the first go,
 * `stride` the bytes from one vertex to the next, `size` the bytes behind `to` that may be written to. `to` and
 * `stride` must be multiples of the size of the kind.
 *
 * Numbers are converted to `kind`. For colors and normals, integers are fractions of the largest integer of their
 * kind: a color of 255 (BSMDEC_UINT8) is 1.0 (BSMDEC_FLOAT32), a normal of -1.0 is -127 (BSMDEC_INT8). Other numbers
 * can only be converted to floats. If `components` are fewer than those of the attribute, the rest is left out; if
 * more, the fourth is 1 and others are 0. Vertices that are in no face have no corner values; they get 0 as well. */
BSMDEC_API bsmdec_status bsmdec_split_values(
    bsmdec *decoder, int attribute, int kind, int components, size_t stride, void *to, size_t size);

/* ---- A stream in one call ----
 *
 *     bsmdec_mesh *mesh;
 *     if (bsmdec_decode(bytes, size, NULL, &mesh) == BSMDEC_OK)
 *         upload(mesh->vertex_data, mesh->vertex_bytes, mesh->index_data, 3 * mesh->faces * mesh->index_size);
 *     else
 *         fprintf(stderr, "%s\n", mesh->error->message);
 *     bsmdec_release(mesh);
 */

/* The result of bsmdec_decode. Everything belongs to the mesh; buffers stay where they are until
 * bsmdec_advance or bsmdec_release. After an error, only `error` is set. */
typedef struct {
    const bsmdec_error *error;
    bsmdec *decoder;          /* for metadata, attributes of faces, losses; do not call bsmdec_next or bsmdec_split */
    int64_t vertices, faces;  /* as in the buffers: vertices are split */
    int64_t frame, frames;    /* sequences: number of the frame in the buffers, -1 after the last; see bsmdec_event */
    int64_t losses;           /* tolerant decoding: LOSS events so far. Unknown positions are NaN */
    void *vertex_data;        /* `vertices` times `stride` bytes */
    size_t vertex_bytes, stride;
    void *index_data;         /* 3 indices of `index_size` bytes for each face */
    size_t index_size;
    const bsmdec_field *fields; /* the layout of a vertex: your fields; by default positions and all attributes */
    const int *attributes;      /* of each field: the attribute; BSMDEC_POSITION; or BSMDEC_ABSENT, its bytes are 0 */
    size_t field_count;
} bsmdec_mesh;

/* Decode a whole mesh, or a sequence up to its first frame. `options` may be NULL. Returns the status, and sets `mesh`
 * in any case, also after an error: release it with bsmdec_release. BSMDEC_MISUSED if the options or fields are wrong;
 * mesh->error names the fault. */
BSMDEC_API bsmdec_status bsmdec_decode(
    const void *bytes, size_t size, const bsmdec_options *options, bsmdec_mesh **mesh);

/* Decode the next frame of a sequence into the buffers. The buffers are new if `faces` or `vertices` change. After
 * the last frame mesh->frame is -1, and the buffers keep that frame. */
BSMDEC_API bsmdec_status bsmdec_advance(bsmdec_mesh *mesh);

/* Release a mesh with all its memory. `mesh` may be NULL. */
BSMDEC_API void bsmdec_release(bsmdec_mesh *mesh);

/* ---- Updates ----
 *
 * For drawing a mesh while it arrives. Each function fills a structure with arrays that the decoder owns; they are
 * valid until the next of these calls or the next event. Vertices are numbered as in bsmdec_faces. A status that is
 * neither BSMDEC_OK nor BSMDEC_MISUSED is that of the decoder's error.
 */

/* Vertices that have moved, and where they are now. */
typedef struct {
    int64_t count;
    const int32_t *vertices;
    const double *positions; /* 3 for each vertex, in the unit of the mesh */
    const uint8_t *final;    /* 1: no later block moves the vertex; refinement may */
} bsmdec_changes;

/* What BLOCK and REFINEMENT events have changed since the previous call. Available from CONNECTIVITY on. Not for
 * frames of a sequence: a frame moves every vertex. Calls do not count as work of the stream. After they took as much
 * work as the limits allow, `final` is set only after the last block. */
BSMDEC_API bsmdec_status bsmdec_read_changes(bsmdec *decoder, bsmdec_changes *changes);

/* The vertices that no face uses; they do not change. Available from CONNECTIVITY on. */
BSMDEC_API bsmdec_status bsmdec_read_loose(bsmdec *decoder, bsmdec_changes *changes);

/* What damage has cost a mesh. Both lists ascend. */
typedef struct {
    int64_t missing_count;
    const int32_t *missing; /* vertices without a position */
    int64_t degraded_count;
    const int32_t *degraded; /* vertices that are less exact than they were encoded */
} bsmdec_losses;

/* Tolerant decoders, at END. Nothing is listed for sequences. */
BSMDEC_API bsmdec_status bsmdec_read_losses(bsmdec *decoder, bsmdec_losses *losses);

/* The part of an attribute that the last VALUES or ATTRIBUTE event brought. */
typedef struct {
    bsmdec_attribute attribute;
    int64_t count;
    const int32_t *rows; /* which of the attribute's rows; none of an attribute that is computed from positions */
    const void *values;  /* `count` times `components` numbers of the attribute's kind */
} bsmdec_values;
BSMDEC_API bsmdec_status bsmdec_read_values(bsmdec *decoder, int index, bsmdec_values *values);

/* ---- What went wrong ---- */

/* The first error of the stream; its status is BSMDEC_OK if there is none. Valid until bsmdec_close. */
BSMDEC_API const bsmdec_error *bsmdec_last_error(const bsmdec *decoder);

/* The loss of the last LOSS event of a tolerant decoder. Valid until bsmdec_close. */
BSMDEC_API const bsmdec_error *bsmdec_last_loss(const bsmdec *decoder);

/* Why the last call that returned BSMDEC_MISUSED did so, such as "faces are known after CONNECTIVITY"; "" if none did.
 * The text changes with the next such call. */
BSMDEC_API const char *bsmdec_last_misuse(const bsmdec *decoder);

#ifdef __cplusplus
}
#endif

#endif
