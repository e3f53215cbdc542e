/* Values of attributes as whole numbers that keep a quality (encoder only; specification, A). */
#pragma once

#include "library/attribute.h"
#include "library/encode/joining.h"

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
