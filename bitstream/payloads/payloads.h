/* What packets hold, both ways: the interface of this room. */
#pragma once

#include "bitstream/connectivity/connectivity.h"
#include "bitstream/container/container.h"
#include "bitstream/entropy/entropy.h"
#include "bitstream/fields/fields.h"
#include "bitstream/fields/twins.h"
#include "bitstream/payloads/written.h"

/* What entropy-coded payloads are read with (specification, C 1 to C 3): a coder, and banks in memory of a decoder. */

/* A payload that is read, or written. */
typedef struct {
    Context *context;
    RangeCoder coder;
} Coding;

bool begin_coding(Context *context, Span payload, Coding *coding);
/* Let a writer write so many bytes more; a reader has all bytes that it will have. */
#ifdef BSMDEC_WRITES
bool room_to_write(Coding *coding, int64_t bytes);
#else
INLINE bool room_to_write(Coding *coding, int64_t bytes) { return (void)coding, (void)bytes, true; }
#endif
/* The error that nonsense is: truncated if the payload is over. */
bool nonsense(const Coding *coding, const char *what);
/* Whether the payload was read exactly to its end (C 1.5), or written. */
bool finish_coding(Coding *coding);

MUST_CHECK bool make_bank(Arena *arena, BankPlan plan, Bank *bank);

/* Faces, and the part that each vertex is in (specification, C 4 to C 8, C 10). */

/* Known to a writer only; all 0 for a reader. */
typedef struct {
    int64_t repeated, lonely, surplus, dummies; /* the counts of C 4.3 */
    Guide guide;
    int32_t *vertex;       /* of each fan */
    Ints used;             /* room for the vertices of fans, then those of faces that repeat a corner */
    Ints order, number;    /* of each vertex: room for those in the order of coding, and the place of each there */
    Ints places, on_edge;  /* the faces that repeat a corner in the order of coding, and room for the same on an edge */
} Surface;

bool code_connectivity(Context *context, Span payload, const Header *header, const Surface *surface, Arena *arena,
    Arena *scratch, Ints2 *faces);
/* `offsets`, `neighbors`: of the graph of a mesh. */
bool code_partition(Context *context, Span payload, ConstInts offsets, ConstInts neighbors, int64_t parts,
    Arena *scratch, Ints labels);

/* How the user of a mesh numbers what was coded (specification, F 9). */
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
bool write_order(Context *context, const Arrangement *arrangement, Arena *scratch, struct Payload *writing);

/* What all fields of integers begin with: corners, orders, models (specification, V 1 to V 6). */

/* Corners of faces, their partners, and the rank of each vertex, which is its number until it is ordered (V 1). */
bool link_mesh(Context *context, ConstInts2 faces, int64_t vertices, Arena *arena, Arena *scratch, Corners *corners);
/* The same where vertices are parts of those of another mesh with the same faces. */
bool link_parts_of(Context *context, const Corners *whole, ConstInts2 faces, int64_t vertices, Arena *arena,
    Arena *scratch, Corners *corners);
/* The same without partners. */
bool gather_mesh(Context *context, ConstInts2 faces, int64_t vertices, Arena *arena, Corners *corners);
bool order_mesh(Corners *corners, Arena *arena, Arena *scratch, Ints *order);
/* Models and learners that have learned nothing (V 4.3, V 6.1). */
MUST_CHECK bool make_value_model(Arena *arena, ValueModel *model, bool of_twins);
MUST_CHECK bool make_learners(Arena *arena, int64_t count, Longs2 *learners);
/* What a kernel of values says of a payload: how many of `count` it has done. */
bool check_chunk_done(Coding *coding, int64_t done, int64_t count);

/* Positions on a grid (specification, V 7 to V 10, V 12, V 15 to V 17). */

/* Positions on a grid, and their models. */
typedef struct {
    Context *context;
    const Header *header;
    ConstInts2 faces;
    Corners corners;
    ValueModel model;
    Grid grid;
    Light light;
    Floats floats;
    Twins *twins;
    Ints2 transforms; /* as they are coded */
    Ints largest, order;
    Ints2 values;
    Doubles2 positions; /* in the unit of the mesh */
    int64_t coded;
    bool broken;
} GridField;

/* Numbers of floats in their order (V 16.1). */
INLINE int64_t number_of_float(double value) {
    float single = (float)value;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    return bits >> 31 ? (int64_t)INT32_MAX - (int64_t)bits : (int64_t)bits;
}

/* Begin, in full as another on the same faces, of which it has the corners; NULL: on its own. */
bool begin_grid(GridField *field, const GridField *like, Context *context, const Header *header, ConstInts2 faces,
    Arena *arena, Arena *scratch);
bool code_grid_values(GridField *field, int64_t first, int64_t count, Span payload);
bool place_floats(GridField *field, ConstInts vertices, Span payload, Arena *scratch);
bool decode_grid(GridField *field, int64_t first, int64_t count, Span payload, Arena *scratch);

/* zstd, of which packed coefficients are (specification, F 6.2). */

/* Unpack exactly `size` bytes. */
bool unpack_zstd(Context *context, Span frame, uint8_t *content, int64_t size, Arena *scratch);
