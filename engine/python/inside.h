/* What the binding for Python asks of a decoder beside bsmdec.h. */
#ifndef BSMDEC_PYTHON_H
#define BSMDEC_PYTHON_H

#include "engine/bsmdec.h"

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

#endif
