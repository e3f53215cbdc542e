/* Payloads written by the functions that read them: faces, and fields of integers on them. */
#pragma once

#include "library/attribute.h"
#include "bitstream/payloads/payloads.h"
#include "codec/signal/decoding.h"
#include "bitstream/payloads/written.h"
#include "bitstream/pool.h"

/* What a writer works with: its memory, and the first thing wrong. It must not be moved. */
typedef struct PayloadWriter {
    Context context;
    Pool pool;
    Arena arena, scratch;
} PayloadWriter;
void open_writer(PayloadWriter *writer, bsmdec_allocator host);
void close_writer(PayloadWriter *writer);
/* Room for payloads, which grows with them. */
MUST_CHECK bool begin_payloads(Context *context, int64_t capacity, Payload *writing);
void end_payloads(Context *context, Payload *writing);

/* How faces that repeat a corner are coded, as in the header (specification, C 8, C 13). A brief stream, whose header
 * cannot declare edges, takes less than LEAST_GAIN bytes less than others. Each face on an edge may take TURN_BITS more
 * in ORDER, because it begins with another corner. */
enum { AS_CORNERS, ON_EDGES, WHERE_SMALLER, LEAST_GAIN = 64, TURN_BITS = 2 };

/* Write CONNECTIVITY of faces whose numbers are below `rows`, and say in which order vertices and faces are coded, and
 * which faces a decoder makes, and which corner of its own each of them begins with. `values` has the vertex of each
 * number; NULL: the number itself. `repeats` becomes what the header declares. */
bool write_faces(PayloadWriter *writer, Source given, int64_t vertices, int *repeats, Payload *writing,
    int32_t *order, int32_t *face_order, int32_t *faces, uint8_t *starts);

/* A field whose chunks are written, or read, one after the other. It must not be moved. */
typedef struct {
    Context *context;
    Arena arena, scratch;
    Header header;
    Ints2 faces;
    enum { ON_GRID, OF_LEVELS, OF_VALUES } kind;
    GridField grid;
    Layer layer;
    Attributes attributes;
    Attribute attribute;
} CodedField;

/* Begin a field: positions on a grid, of floats in its cells also `exact` ones; levels; values of an attribute on rows
 * at vertices, with their places on a grid or NULL, coded by the header's `swift`. A grid has the header's
 * `congruence`, and rows of so many `transforms` (specification, V 17.2). */
bool begin_positions(CodedField *field, const GridField *like, Context *context, Source given,
    const int32_t *largest, int light, const double *origin, double step, const double *exact,
    const int32_t *transforms, int congruence);
bool begin_refinement(CodedField *field, Context *context, Source given);
bool begin_attribute(CodedField *field, Context *context, Source given, const Declaration *declaration,
    int64_t vertices, const int32_t *at, const int32_t *places, int swift);
void end_field(CodedField *field);
/* Room that the payloads of so many rows can take. */
int64_t room_of_chunk(const CodedField *field, int64_t count);
/* Write the payloads of rows, or, without `writing`, read that of one kind of values. */
bool code_chunk(CodedField *field, int64_t first, int64_t count, Span payload, Payload *writing);
