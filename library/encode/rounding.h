/* Which grid positions are coded on, and where on it they are (encoder only). */
#pragma once

#include "library/encode/joining.h"

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
