/* What a stream says before anything else, and what it declares of attributes (specification, F 4, F 10, D 1). */
#pragma once

#include "bitstream/container/container.h"
#include "bitstream/container/maps.h"

/* How blocks are coded; only the paper's codec has other than the law's constants (F 10). */
typedef struct {
    int bits, coarser, exact, power, iterations, key_iterations, springs;
    double shift;
} Paper;

enum { LIGHT = 1, EXACT_FLOATS = 2 };

typedef struct {
    int64_t vertices, faces, blocks, block_size, coefficients, key_interval, attributes;
    double step, center[3], scale, smoothing;
    bool refined, on_grid, is_sequence;
    double refinement[2]; /* step and ratio */
    int32_t grid[3];
    double turn[3]; /* of the axes of a grid: a quaternion, less its 1 (V 18) */
    int64_t cells, points, corner[3]; /* of a lattice, 0 without */
    bool counted;                     /* there is a corner */
    int light, onorm;                 /* solutions before each Onorm in doubles, or 0 */
    int congruence; /* 35 more than the transforms of congruent parts, and 17 more with whole vertices; 0: without */
    int64_t frames, gop_frames, run, mesh_of; /* `again`: the run whose mesh this one has, or -1 */
    Paper paper;
    bool brief; /* the frame of the header is the whole stream, and ends with this (F 11) */
    Span connectivity, values, metadata;
    Record record; /* all fields by key, as they were stored */
} Header;

#ifndef BSMDEC_LONG /* whether a build knows no brief streams */
#define BSMDEC_LONG 0
#endif
INLINE bool is_brief(const Header *header) { return !BSMDEC_LONG && header->brief; }

/* How positions on a grid are coded. */
INLINE int method_of(const Header *header) { return BSMDEC_LIGHT ? LIGHT : header->light; }

/* Whether values of a grid are also foretold from congruent parts. */
INLINE bool is_congruent(const Header *header) { return !BSMDEC_LIGHT && header->congruence > 0; }

/* How many transforms a congruent grid has, and whether it asks for whole vertices (V 17.1, V 17.11). */
enum { LEAST_CONGRUENCE = 35 }; /* drafts had those below */
INLINE int transforms_of(const Header *header) { return (header->congruence - LEAST_CONGRUENCE) % 17; }
INLINE bool asks_whole(const Header *header) { return header->congruence >= LEAST_CONGRUENCE + 17; }

bool parse_header(Context *context, Span payload, Arena *scratch, Header *header);

extern INSIDE const Fields HEADER_FIELDS, DECLARATION_FIELDS;
/* The numbers of a header that the encoder in C writes. */
Record header_record(const Header *header);

/* Blocks of a chain (M 10.1). */
INLINE int64_t chain_length(const Header *header) {
    return header->key_interval > 0 ? header->key_interval : header->blocks;
}

enum { LEVELS, OCTAHEDRAL, BITS, RECOMPUTED };
enum { MOST_ATTRIBUTES = 256, MOST_WORDS = 8 };

/* By the kind of numbers: the least of integers; what a fraction of 1 is, the largest of integers. */
static const double LEAST_OF[] = {0, INT8_MIN, 0, INT16_MIN, 0, INT32_MIN};
static const double UNIT_OF[] = {UINT8_MAX, INT8_MAX, UINT16_MAX, INT16_MAX, UINT32_MAX, INT32_MAX, 1, 1};

/* An attribute, but for its values. */
typedef struct {
    char name[MOST_NAME + 1];
    int name_size, domain, origin, semantic, kind, components, coding, words;
    int64_t rows, seams_of;
    uint32_t largest[MOST_WORDS];
    double offset[MOST_WORDS], step[MOST_WORDS]; /* one of each for every word */
    bool leans, moves;
} Declaration;

bool parse_declaration(Context *context, Span payload, Arena *scratch, Declaration *declaration);
Record declaration_record(const Declaration *declaration);
/* Whether the user is given values by vertices. */
INLINE bool is_by_vertex(const Declaration *d) {
    return (d->domain == BSMDEC_VERTEX && d->origin == 0) || (d->domain == BSMDEC_CORNER && d->origin == 1);
}
