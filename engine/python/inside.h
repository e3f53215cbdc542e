/* What the binding for Python asks of a decoder beside bsmdec.h. */
#ifndef BSMDEC_PYTHON_H
#define BSMDEC_PYTHON_H

#include <stdbool.h>

#include "engine/bsmdec.h"
#include "engine/payloads.h"

/* Bytes read, work charged and vertices of all faces so far; then what limits on work and memory count: vertices that
 * are present and of frames shown, vertices in memory, bytes received, and bytes of memory that are kept. */
enum { STATE_NUMBERS = 7 };
void decoder_state(const bsmdec *decoder, double *state);
/* The header of the present run, as engine/header.h has it. */
enum { MOST_HEADER_NUMBERS = 48 };
void decoder_header(const bsmdec *decoder, double *numbers);
/* Read the next packet without decoding it, after all checks that come before decoding, and list it: type, offset and
 * length of its frame, bytes of its payload and of the data in it, index, count (also of coefficients or frames),
 * entries of metadata so far, version, whether a GOP begins anew, the checksum of positions or -1; of an attribute,
 * whose name is returned, domain, semantic, kind, components, rows, coding, whether it moves. Type -1: none. */
enum { SKIMMED_NUMBERS = 18 };
const char *decoder_skim(bsmdec *decoder, int64_t *numbers);

/* Faces, and values of each vertex, or of each row of an attribute; all arrays stay with the caller. */
typedef struct {
    const int32_t *faces, *values;
    int64_t faces_count, rows, columns;
} Written;

/* Begin a field: positions on a grid, of floats in its cells also `exact` ones; levels; values of an attribute on rows
 * at vertices, with their places on a grid or NULL. An error is that of the decoder, which does nothing else. */
bool write_grid(bsmdec *decoder, Written given, const int32_t *largest, int light, const double *origin, double step,
    const double *exact);
bool write_levels(bsmdec *decoder, Written given);
bool write_values(bsmdec *decoder, Written given, const uint8_t *declaration, int64_t size, int64_t vertices,
    const int32_t *at, const int32_t *places);
/* Write CONNECTIVITY of faces whose numbers are below `rows`, and say in which order vertices and faces are coded, and
 * which faces a decoder makes. `values` has the vertex of each number; NULL: the number itself. */
bool write_faces(bsmdec *decoder, Written given, int64_t vertices, Writing *writing, int32_t *order,
    int32_t *face_order, int32_t *faces);
/* Write the payloads of rows, or, without `writing`, read that of one kind of values. */
bool code_chunk(bsmdec *decoder, int64_t first, int64_t count, const uint8_t *payload, int64_t size, Writing *writing);
/* The rows in the order of coding, all of them (NULL: as they are numbered), and the first kind of values. */
const int32_t *order_of_field(const bsmdec *decoder);
const int32_t *values_of_field(const bsmdec *decoder);

#endif
