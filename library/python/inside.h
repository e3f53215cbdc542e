/* What the binding for Python asks of a decoder beside bsmdec.h. */
#pragma once

#include <stdbool.h>

#include "library/bsmenc.h"
#include "library/python/chaining.h"
#include "bitstream/payloads/written.h"

/* Bytes read, work charged and vertices of all faces so far; then what limits on work and memory count: vertices that
 * are present and of frames shown, vertices in memory, bytes received, and bytes of memory that are kept. */
typedef struct {
    int64_t offset, vertices, shown, present;
    double work, received, memory;
} DecoderState;
DecoderState decoder_state(const bsmdec *decoder);
/* The numbers of a field of the header of the present run, and how many there are. */
enum { MOST_FIELD_KEY = 30 };
int decoder_field(const bsmdec *decoder, int key, const double **numbers);
/* What a packet says before it is decoded; `positions` is their checksum or -1. What follows is of an attribute. */
typedef struct {
    int64_t type, offset, length; /* of its frame */
    int64_t payload, data, index; /* bytes, and of these bytes of data */
    int64_t count;                /* also of coefficients or frames */
    int64_t entries;              /* of metadata so far */
    int64_t version, positions;
    bool begins; /* whether a GOP begins anew */
    int domain, semantic, kind, components, coding;
    int64_t rows;
    bool moves;
    char name[256]; /* more than any name takes */
} SkimmedPacket;
/* Read the next packet without decoding it, after all checks that come before decoding; false: there is none yet. */
bool decoder_skim(bsmdec *decoder, SkimmedPacket *packet);

/* What an encoder writes payloads with (library/writing.h): faces, or the chunks of one field. */
typedef struct Encoding Encoding;
Encoding *open_encoding(void);
void close_encoding(Encoding *encoding);
/* What steps through blocks (see chaining.h); NULL without memory. */
CodedChain *encoding_chain(Encoding *encoding);
const bsmdec_error *encoding_error(const Encoding *encoding);
/* The payloads of the last call that wrote some. */
const Payload *encoding_payloads(const Encoding *encoding);
/* Where payloads are written next, in the place of these; NULL without memory. */
Payload *encoding_anew(Encoding *encoding);
/* Join the vertices of a given mesh at one place (library/encode/encoding.h): the joined vertex of each (-1: in no face
 * that is kept), the first given vertex and the given face of each joined one; how many are merged, or in no face. With
 * `keeps`, those in no face come back. Faces must outlive this. */
typedef struct {
    ConstInts index, first, kept;
    int64_t merged, loose;
} JoinedArrays;
bool encode_joined(Encoding *encoding, ConstInts2 faces, ConstInts places, bool keep, bool keeps,
    JoinedArrays *arrays);
/* Write its faces: the joined vertex and face of each coded one, coded faces, and the corner of each joined face that
 * is the first. If `merged` has numbers, they are the vertices of joined ones. Then write ORDER, of given positions. */
typedef struct {
    ConstInts vertices, face_order;
    ConstInts2 faces;
    ConstBytes turns;
    int repeats;
} CodedArrays;
/* Code faces, those that repeat a corner as `repeats` says (library/writing.h). */
bool encode_faces(Encoding *encoding, ConstInts merged, int repeats, CodedArrays *arrays);
bool encode_order(Encoding *encoding, ConstDoubles2 positions);
/* The outcome of an attribute in such a place (library/encode/encoding.h), and arrays of the encoding: coded numbers,
 * the coded value of each corner (NULL: its vertex), the vertex of each. */
typedef struct {
    bsmenc_outcome outcome;
    const int32_t *pieces, *faces, *vertices;
    int64_t rows, columns, vertices_count;
    bool leans; /* it may be predicted from positions */
    ConstDoubles2 tangents; /* rows that are used, of what may be tangents, with the row of each corner */
    ConstInts tangent_rows;
} CarriedOutcome;
/* Carry an attribute, the first or the next one; its seams are the payload. Then write the decoded values. */
bool encode_carried(Encoding *encoding, const bsmenc_attribute *given, bool first, CarriedOutcome *whole);
void carried_values(const Encoding *encoding, void *values);
/* Tangents as turns (library/encode/encoding.h), on a diamond of a size: `words` of rows, decoded `values`, the largest
 * error in degrees, and whether that is near enough. */
typedef struct {
    ConstInts2 faces, normal_faces, coordinate_faces, places, coordinates;
    ConstInts vertices, rows;
    ConstDoubles2 normals, tangents;
    int64_t size;
} TangentArrays;
bool encode_turns(Encoding *encoding, const TangentArrays *arrays, int32_t *words, double *values, double *error,
    bool *near);
/* The numbers of a field of its declaration, and how many there are. */
int carried_field(const Encoding *encoding, int key, const double **numbers);
/* With `congruence` of the header, its rows of `transforms` (V 17.2), and corners of an encoding like it, or NULL. */
bool encode_positions(Encoding *encoding, const Encoding *like, Source given, const int32_t *largest, int light,
    const double *origin, double step, const double *exact, const int32_t *transforms, int congruence);
/* Let vertices of a grid go to images (bitstream/fields/placing.c). The rows stay as they are until all are coded. */
bool encode_going(Encoding *encoding, const double *wanted);
/* Mend places on a grid of the same faces. */
bool encode_mended(Encoding *encoding, Ints2 places, const int32_t *largest, const double *wanted);
bool encode_levels(Encoding *encoding, Source given);
bool encode_attribute(Encoding *encoding, Source given, const uint8_t *declaration, int64_t size, int64_t vertices,
    const int32_t *at, const int32_t *places, int swift);
/* Write the payloads of rows, or read that of one kind of values. */
bool encode_chunk(Encoding *encoding, int64_t first, int64_t count);
bool decode_field_chunk(Encoding *encoding, int64_t first, int64_t count, const uint8_t *payload, int64_t size);
/* Round positions to a grid (library/encode/encoding.h). If `bits` is 0, the grid has cells of this size from this
 * origin; if `cell` is 0 as well, it is the grid for exact floats. `grid` gets the origin, the step and the largest
 * place of each axis. */
bool encode_rounded(Encoding *encoding, const double *positions, int64_t rows, int bits, double cell,
    const double *origin, double *grid, int32_t *places);
/* The rows in the order of coding (NULL: as they are numbered), and the first kind of values. */
const int32_t *encoding_order(const Encoding *encoding);
const int32_t *encoding_values(const Encoding *encoding);
