/* Attributes of a given mesh in the order of coding (encoder only; specification, D). */
#pragma once

#include "library/encode/quantizing.h"
#include "library/encode/writer.h"

/* A joined mesh in the order of coding. */
typedef struct {
    const GivenMesh *given;
    const JoinedMesh *joined;
    bool keeps;            /* the order, and vertices in no face */
    Ints2 faces;           /* m x 3, coded */
    Ints vertex_order, face_order; /* the joined vertex and face of each */
    Bytes turns;           /* m: the corner of the joined face that is the first of the coded one */
    Corners corners;
} CodedMesh;

/* An attribute on its way; `places`: rows on a grid, of an attribute that leans on them. */
typedef struct {
    Quantized quantized;   /* levels of the rows that are used */
    Ints rows;             /* of each corner, or face, in the order of coding: the row of these */
    Longs2 levels;         /* of the coded rows */
    Bytes seams;           /* of its own; empty: others', or none */
    int64_t joins;         /* the number of the attribute with its seams, -1: none */
    Ints2 faces;           /* the coded row of each corner */
    Ints vertices;         /* of each coded row, -1 for one of a loose vertex */
} Carried;

/* Carry attribute `index`; those before it are carried. */
bool carry_attribute(Writer *writer, const CodedMesh *coded, const bsmenc_attribute *given, int index, Carried *all);
/* Write the seams of its own of a carried attribute. */
bool write_seams(Writer *writer, const CodedMesh *coded, int index, const Carried *all, Writing *writing);
/* Write the ATTRIBUTE section of a carried attribute. */
bool declare_carried(Writer *writer, const CodedMesh *coded, int index, const Carried *all, StreamWriter *stream);
/* Write the payloads of VALUES, chunk by chunk, into a buffer, and where each ends; `places`: of vertices on a grid. */
enum { VALUES_CHUNK = 1 << 15 };
bool code_carried(Writer *writer, const CodedMesh *coded, const Carried *carried, const int32_t *places,
    Buffer *payloads, Longs ends);
/* The numbers that are coded of levels: large ones are in two pieces. */
bool take_pieces(Arena *arena, const Carried *carried, Ints2 *pieces);
/* Whether values are predicted from positions, should these be on a grid. */
bool can_lean(const Declaration *declaration);
