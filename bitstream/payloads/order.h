/* How the user of a mesh numbers what was coded (specification, F 9). */
#pragma once

#include "bitstream/container/header.h"

typedef struct {
    int64_t size;      /* vertices that the user has */
    ConstInts2 faces;
    ConstInts source;  /* what each of the user's vertices was coded as, -1 for none; empty: what has its number */
    ConstInts corners; /* the coded corner that each of the user's is; empty: the same */
    bool is_split;     /* vertices that were coded as one are several of the user's, or in no face */
    ConstDoubles2 loose; /* positions of those in no face, in their order */
} Numbering;

bool decode_order(Context *context, Span data, ConstInts2 faces, const Header *header, Arena *arena, Arena *scratch,
    Numbering *numbering);

/* A mesh in the order that it was given and as it is coded, for writers. */
typedef struct {
    ConstInts2 faces, coded;          /* of joined vertices; as CONNECTIVITY has them */
    ConstInts vertices, face_places;  /* the joined vertex and face of each coded one */
    ConstInts source;                 /* the joined vertex of each given one, -1: it is in no face */
    ConstInts2 corners;               /* given faces, of given vertices */
    int64_t copies, loose;
} Arrangement;
/* Write the coded part of ORDER. */
bool write_order(Context *context, const Arrangement *arrangement, Arena *scratch, struct Writing *writing);
