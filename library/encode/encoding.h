/* The encoder in C (encoder only): the interface of this room. */
#pragma once

#include "bitstream/container/container.h"
#include "bitstream/payloads/payloads.h"
#include "library/attribute.h"
#include "library/bsmenc.h"
#include "library/writing.h"

/* A given mesh as it is coded: one vertex at each position (encoder only). */

/* Kinds of errors that decoders do not have: those of bsmenc.h. */
#define BSMDEC_UNREACHABLE ((bsmdec_status)BSMENC_UNREACHABLE)
#define BSMDEC_FAULT ((bsmdec_status)BSMENC_FAULT)
#define BSMDEC_STOPPED ((bsmdec_status)BSMENC_STOPPED)

/* A number rounded to single precision. It is volatile because GCC 12, in loops over three numbers, makes vectors of
 * the conversions, and leaves them out. */
INLINE double in_single(double value) {
    volatile float single = (float)value;
    return single;
}

typedef struct {
    int64_t vertices, faces, frames;
    ConstDoubles2 positions; /* of all frames */
    const uint32_t *corners;
} GivenMesh;

/* Numbers are those of joined vertices, by their first appearance in faces that are kept. */
typedef struct {
    Ints index;   /* of each given vertex, -1: in no face that is kept */
    Ints first;   /* the first given vertex of each */
    Ints kept;    /* the given face of each that is kept */
    Ints2 faces;  /* those that are kept */
    int64_t merged, loose, collapsed; /* vertices that are at the place of another one, or in no face; faces left out */
} JoinedMesh;

/* The number of each row of `width` integers: that of an equal row before it, or the next. Returns how many there are,
 * -1 without memory. */
int64_t number_rows(const int64_t *rows, int64_t count, int width, Arena *scratch, Ints numbers);
/* Make one vertex of those with the number of one place, which becomes another where closed bodies share it. With
 * `keep`, faces without area stay. */
bool join_places(const GivenMesh *given, Ints place, bool keep, PayloadWriter *writer, JoinedMesh *joined);
/* The same of those at one position in all frames; -0.0 is there where 0.0 is, unless `exact`. */
bool join_mesh(const GivenMesh *given, bool exact, bool keep, PayloadWriter *writer, JoinedMesh *joined);

/* A joined mesh in the order of coding. */
typedef struct {
    const GivenMesh *given;
    const JoinedMesh *joined;
    bool keeps;            /* vertices in no face, with the order */
    Ints2 faces;           /* m x 3, coded */
    Ints vertex_order, face_order; /* the joined vertex and face of each */
    Bytes turns;           /* m: the corner of the joined face that is the first of the coded one */
    Corners corners;
    int swift;             /* how values of attributes are coded, as in the header */
    int repeats;           /* how faces that repeat a corner are coded; once they are, as in the header */
} CodedMesh;
/* Write CONNECTIVITY of a joined mesh of so many vertices, and put it in the order of coding. `merged`: the vertex of
 * each of its numbers, NULL: the number itself. */
bool order_faces(PayloadWriter *writer, const int32_t *merged, int64_t vertices, Payload *writing, CodedMesh *coded);

/* Which grid positions are coded on, and where on it they are (encoder only). */
INLINE bool is_finite(double value) { return value - value == 0.0; }

/* Positions on a grid: place k of an axis is at origin + k * step. */
typedef struct {
    double origin[3], step;
    int32_t largest[3];
    Ints2 places;
    bool exact; /* positions are those that are given, floats in the cells of their places */
} Rounded;

/* The numbers of values: rows of components. */
typedef struct {
    const void *values;
    int64_t rows;
    int components, kind;
} Table;

/* The lowest and the highest number of each component; returns the largest extent. */
double range_of(const Table *table, double *low, double *high);
INLINE double box_of(ConstDoubles2 positions, double *low, double *high) {
    return range_of(&(Table){positions.data, positions.rows, 3, BSMDEC_FLOAT64}, low, high);
}
/* How far from 0 ranges reach. */
double reach_of(const double *low, const double *high, int count);
/* How far the next number of single or double precision is. */
double spacing_of(double value, bool narrow);

/* To `bits` along the longest side of the bounding box. */
bool round_to_bits(Context *context, ConstDoubles2 positions, int bits, Rounded *rounded);
/* To the points origin + k * cell. */
bool round_to_cells(Context *context, ConstDoubles2 positions, double cell, const double *origin, Rounded *rounded);
/* Floats, exactly; the rest of the doubles that hold them is 0. */
bool round_exactly(Context *context, ConstDoubles2 positions, Rounded *rounded);
/* The position that a decoder gives. */
INLINE double rounded_at(const Rounded *rounded, int64_t place, int axis) {
    double product = (double)rounded->places.data[3 * place + axis] * rounded->step;
    return product + rounded->origin[axis];
}

/* Values of attributes as whole numbers that keep a quality (encoder only; specification, A). */

/* Levels of values, row by row, `declaration.words` each; and the declaration, but for its place in the mesh. */
typedef struct {
    Declaration declaration;
    Longs2 levels;
    bsmenc_outcome outcome;
} Quantized;

/* Values, `rows` of them, of the kind, components, semantic and name of the declaration. */
bool quantize(Context *context, const void *values, int64_t rows, bsmenc_quality quality, double amount, Arena *arena,
    Quantized *quantized);
/* The direction of a vector; returns its length, and any direction if that is 0. */
double direction_of(const double *vector, double *unit);
/* The angle between a vector and a unit vector, in degrees. */
double degrees_between(const double *vector, const double *unit);

/* Packets to bytes: what bitstream/container/reader.c reads (specification, F 1 to F 5). */

/* Bytes that grow with what is put behind them; nothing is put where the context has failed. */
typedef struct {
    Context *context;
    uint8_t *data;
    int64_t size, capacity;
} Buffer;

void give_buffer(Buffer *buffer);
INLINE Span bytes_of(const Buffer *buffer) { return (Span){buffer->data, buffer->size}; }
void put_bytes(Buffer *buffer, Span bytes);
void put_varint(Buffer *buffer, int64_t value);
void put_little(Buffer *buffer, uint64_t value, int size);
/* The fields that a record has, but for those at their defaults. */
void put_record(Buffer *buffer, Fields fields, const Record *record);
/* A map of entries in the order of their names, at most MOST_ENTRIES. */
void put_metadata(Buffer *buffer, const bsmdec_metadata *const *entries, int count);

/* The payload of ORDER. */
void put_order(Buffer *buffer, const CodedMesh *coded, Arena *scratch);

/* A stream as far as it is written, and the payload of its next section. */
typedef struct {
    Buffer bytes, payload;
    Sums sums;
    uint32_t sum;
    int64_t sections;
} StreamWriter;

/* Begin a stream of a minor version. */
void start_stream(StreamWriter *writer, Context *context, int minor);
/* Write a section with the payload, which is empty then. */
void put_section(StreamWriter *writer, FrameType type);
/* Write END, with the checksum of decoded positions. */
void end_stream(StreamWriter *writer, uint32_t positions);
void give_stream(StreamWriter *writer);

/* Attributes of a given mesh in the order of coding (encoder only; specification, D). */

/* An attribute on its way; `places`: rows on a grid, of an attribute that leans on them. */
typedef struct {
    Quantized quantized;   /* levels of the rows that are used */
    Ints rows;             /* of each corner, or face, in the order of coding: the row of these */
    Longs2 levels;         /* of the coded rows */
    Bytes seams;           /* of its own; empty: others', or none */
    int64_t joins;         /* the number of the attribute with its seams, -1: none */
    Ints2 faces;           /* the coded row of each corner */
    Ints vertices;         /* of each coded row, -1 for one of a loose vertex */
    Doubles2 tangents;     /* values of the rows that are used, if they may be tangents */
    int turn_bits;
} Carried;

/* Carry attribute `index`; those before it are carried. */
bool carry_attribute(
    PayloadWriter *writer, const CodedMesh *coded, const bsmenc_attribute *given, int index, Carried *all);
/* Write the seams of its own of a carried attribute. */
bool write_seams(PayloadWriter *writer, const CodedMesh *coded, int index, const Carried *all, Payload *writing);
/* Write the ATTRIBUTE section of a carried attribute. */
bool declare_carried(
    PayloadWriter *writer, const CodedMesh *coded, int index, const Carried *all, StreamWriter *stream);
/* Write the payloads of VALUES, chunk by chunk, into a buffer, and where each ends; `places`: of vertices on a grid. */
enum { VALUES_CHUNK = 1 << 15 };
bool code_carried(PayloadWriter *writer, const CodedMesh *coded, const Carried *carried, const int32_t *places,
    Buffer *payloads, Longs ends);
/* The numbers that are coded of levels: large ones are in two pieces. */
bool take_pieces(Arena *arena, const Carried *carried, Ints2 *pieces);
/* Whether values have the form of tangents: a direction, and 1 or -1 for the hand. */
bool may_turn(const Table *table, int semantic, bsmenc_quality quality, double amount);
/* Tangents of the rows of corners, with the decoded normals of theirs, and the size of the diamond of their turns. */
typedef struct {
    TangentPlaces places;
    const double *normals, *tangents;
    const int32_t *rows;
    int64_t size;
} GivenTangents;
/* The words of tangents, their decoded values, and the largest error in degrees. */
bool turn_tangents(Arena *scratch, const GivenTangents *given, Longs2 words, double *values, double *error);
bool is_turn_near(double error, int64_t size);
/* Declare words of tangents that are turned from the numbered attributes. */
void declare_turns(Declaration *d, int normals, int coordinates, int64_t size, const Longs2 *words);
/* Make turns of a carried attribute, should it be tangents that are near enough then; `at`: vertices on a grid. */
bool turn_carried(PayloadWriter *writer, const CodedMesh *coded, const int32_t *at, int index, Carried *all);
/* Whether values are predicted from positions, should these be on a grid. */
bool can_lean(const Declaration *declaration);

/* Frames that share their faces, as a sequence (encoder only; specification, S). */

/* Consecutive payloads of sections, and where each ends: blocks of the first frame, then GOPs. */
typedef struct {
    Header header;
    Buffer bytes;
    Longs ends;
    uint32_t sum;    /* of decoded positions */
    double farthest; /* the largest error of a coordinate */
} CodedMotion;

/* Code frames so that no coordinate is off by more than `bound`. Their vertices and `faces` are in the order of
 * coding. */
bool code_motion(PayloadWriter *writer, ConstInts2 faces, ConstDoubles2 frames, double bound, CodedMotion *motion);
void give_motion(CodedMotion *motion);

/* What is given to the encoder, and whether its streams keep what they promise. */
typedef struct {
    bsmenc_stream stream; /* the user's, first */
    bsmdec_allocator host;
    PayloadWriter writer;
    const bsmenc_mesh *mesh;
    bsmenc_options options;
    GivenMesh given;
    JoinedMesh joined;
    CodedMesh coded;
    Rounded rounded;
    CodedMotion motion;   /* of a sequence */
    Doubles2 positions;   /* that a decoder has of the coded vertices */
    bsmenc_attribute *attributes; /* those that are carried, with their qualities */
    Carried *carried;
    int carried_count;
    StreamWriter out;
} Encoder;

/* Check what the user has given, and copy what is needed of it. */
bool check_mesh(Encoder *encoder);
/* Decode the stream with bsmdec and compare it with what was given. */
bool prove_stream(Encoder *encoder);
