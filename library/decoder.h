/* What the functions of bsmdec.h have in common. */
#pragma once

#include "library/state.h"

/* Bytes of an index; a short one is below 65535, which restarts a strip in graphics APIs. */
enum { SHORT_INDEX = 2, LONG_INDEX = 4 };

/* Note why a call is refused; returns BSMDEC_MISUSED. */
bsmdec_status refuse(bsmdec *decoder, Message message);
#ifdef BSMDEC_TERSE
INLINE bsmdec_status refuse_tersely(const bsmdec *decoder) { return (void)decoder, BSMDEC_MISUSED; }
#define REFUSE(decoder, ...) refuse_tersely(decoder)
#else
#define REFUSE(decoder, ...) refuse(decoder, (Message){.text = __VA_ARGS__})
#endif

/* Copy the options of a caller over `options`, the defaults; false if their size is wrong. */
bool copy_options(const bsmdec_options *given, bsmdec_options *options);
/* Whether an array of a caller is there and has as many elements, or bytes, as it must. */
bool fits(bsmdec *decoder, const void *array, size_t count, int64_t expected);
/* Whether positions are available: BSMDEC_OK, the error of a decoder that has failed, or why is noted. */
bsmdec_status find_places(bsmdec *decoder);
/* Where vertex v of the user is; `loose` counts those in no face. */
const double *place_of(const bsmdec *decoder, int64_t v, int64_t *loose);
/* An attribute of which values may have come; NULL, and the reason is noted, if there is none. */
const Attribute *started_attribute(bsmdec *decoder, int index);
bsmdec_attribute shape_of(const bsmdec *decoder, const Attribute *attribute);
/* Describe one of the attributes if it is available; nothing is noted. */
bool find_shape(const bsmdec *decoder, int index, bsmdec_attribute *shape);
