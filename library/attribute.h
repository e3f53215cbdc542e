/* An attribute of a mesh: its values, and how the user is given them (specification, D, A). */
#pragma once

#include "bitstream/attributes/attributes.h"
#include "bitstream/container/container.h"
#include "bitstream/payloads/payloads.h"

/* Corners that share a value, where attributes have seams: the seams, the value of each corner, and how many values
 * there are. */
typedef struct {
    Bytes seams;
    Ints2 faces;
    int64_t count;
} Joins;

/* One of the groups of at most four pieces that an attribute's words are coded in (D 3.3). */
enum { MOST_GROUPS = 4, MOST_PIECES = 2 * MOST_WORDS };
typedef struct {
    Corners corners;
    ValueModel model;
    Values values;         /* of vertices or corners */
    Swift swift;           /* the same, where the header has `swift` */
    FaceValues face_values;
    Ints order;            /* empty: rows come as they are numbered */
    Ints2 pieces;
    int columns;
} Group;

/* What tangents are turned from (A 9.9): for each row the sum of the gradients around it, how many more of its faces
 * are turned like their texture than against it, and the row of its normal, -1 for none. */
typedef struct {
    Doubles2 gradients;
    Ints turns, normals;
} TangentPlan;

typedef struct Attribute {
    Declaration declaration;
    const Joins *joins;    /* of corners, NULL for others */
    bool own_joins, whole;
    int64_t rows;          /* values, also of one that is recomputed */
    ConstInts2 faces;      /* the row of each coded corner */
    Ints vertices;         /* the vertex of each row, -1 for loose ones; none for faces */
    void *values;          /* rows times components, of the kind */
    void *moved;           /* the same in the frame reported last, if it moves; NULL: in the first one */
    bool is_base;          /* of tangents, with its words */
    Ints2 words;           /* of a base of tangents that is on a texture */
    TangentPlan tangents;
    const struct Attribute *normals; /* of tangents */
    double coding;         /* bytes that are kept while values come */
    int64_t coded;
    bool begun;
    int groups;
    Group group[MOST_GROUPS];
} Attribute;

/* Zeros for the values of all rows. */
MUST_CHECK bool take_values(Arena *arena, const Attribute *attribute, void **values);
/* Normals that follow from positions (D 4.4). */
bool recompute(Attribute *attribute, ConstDoubles2 positions, Arena *scratch);

/* First values less those of vertex 0; the values of a frame, given its change from the first (S 10). */
void relative_values(const Attribute *attribute, Doubles2 beyond);
bool move_values(Context *context, Attribute *attribute, ConstDoubles2 change, void *moved);

/* Where tangents are: the rows of each corner, the vertex of each row, and the place of each vertex on a grid. */
typedef struct {
    ConstInts2 faces, normals, coordinates; /* the rows of corners: of tangents, of their normals, on their texture */
    const int32_t *vertices;
    ConstInts2 places, words; /* words: of coordinates */
    int64_t rows;
} TangentPlaces;
MUST_CHECK bool plan_tangents(Arena *arena, const TangentPlaces *places, TangentPlan *plan);
/* Directions at right angles to a normal and to each other, the first along the texture; and 1 or -1 for the hand. */
typedef struct {
    double along[3], aside[3], hand;
} TangentAxes;
TangentAxes tangent_axes(const TangentPlan *plan, int64_t row, const double *normal);
/* The tangent of words, on a diamond of a size (A 9.10). */
void turn_axes(const TangentAxes *axes, const int64_t *word, int64_t size, double *tangent);

/* Values of rows from their pieces (D 3.2, D 4). */
/* Store the value of a row of levels. */
void restore(const Declaration *d, const int64_t *word, int64_t row, void *values);
bool restore_values(Context *context, Attribute *attribute, int64_t first, int64_t count);
INLINE size_t kind_size(int kind) {
    static const size_t SIZES[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return SIZES[kind];
}

INLINE bool is_kind(int kind) { return kind >= BSMDEC_UINT8 && kind <= BSMDEC_FLOAT64; }
/* The direction of a place on the unfolded octahedron, 0 to twice `size` on each axis (D 4.2). */
void unfold_direction(const int64_t *word, int64_t size, double *direction);
/* One number of values of a kind. */
double load_number(const void *values, int64_t place, int kind);
void store_number(void *values, int64_t place, int kind, double number);

/* How the user is given an attribute (D 4.5). */
typedef struct {
    int domain;
    int64_t rows;
} Given;
Given given_shape(const Attribute *attribute, const Numbering *numbering);
/* The row that each of the user's values is. */
bool given_rows(const Attribute *attribute, const Numbering *numbering, Arena *scratch, Longs rows);
/* The row of each of the user's corners. */
int32_t row_of_corner(const Attribute *attribute, const Numbering *numbering, int64_t corner);

/* The attributes of a mesh: declarations, seams, and rows (specification, D 1 to D 3). */

/* Those of one mesh, by number; NULL for those that were not declared. */
typedef struct {
    Context *context;
    const Header *header;
    ConstInts2 faces;
    Arena *arena;
    Arena coding;          /* what the attribute takes whose values come */
    Attribute *list[MOST_ATTRIBUTES];
    int count;
    bool has_corners, begun;
    Corners corners;
    double numbers;
    Arena recent;
    const Attribute *latest; /* whose values came last, and marks of their rows; no marks: of all */
    Bytes fresh;
} Attributes;

void begin_attributes(Attributes *attributes, Context *context, const Header *header, ConstInts2 faces, Arena *arena);
void end_attributes(Attributes *attributes);
bool declare_attribute(Attributes *attributes, int64_t index, const Declaration *declaration, Span seams,
    Arena *scratch);
/* Whether an attribute has as many rows as it must (D 1.2), if it is there. */
bool check_rows(const Attributes *attributes, int64_t index, const Numbering *numbering);
/* What is needed before values come, or where none do. */
bool begin_values(Attributes *attributes, const Numbering *numbering);
/* `places`: values of a grid, if all of them are there, otherwise none. */
bool start_attribute(Attributes *attributes, Attribute *attribute, ConstInts2 places, Arena *scratch);
bool code_group(Context *context, const Attribute *attribute, Group *group, Span payload, int64_t first, int64_t count);
bool decode_values(Attributes *attributes, const Packet *packet, ConstInts2 places, Arena *scratch);
