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
/* Read the packets that have come without decoding them: all checks that come before decoding. */
bsmdec_status decoder_skim(bsmdec *decoder);

#endif
