/* The attributes of a mesh: declarations, seams, and rows (specification, D 1 to D 3). */
#pragma once

#include "library/attribute.h"
#include "bitstream/container/container.h"

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
bool begin_values(Attributes *attributes, const Numbering *numbering, Arena *scratch);
/* `places`: values of a grid, if all of them are there, otherwise none. */
bool start_attribute(Attributes *attributes, Attribute *attribute, ConstInts2 places, Arena *scratch);
bool code_group(Context *context, const Attribute *attribute, Group *group, Span payload, int64_t first, int64_t count);
bool decode_values(Attributes *attributes, const Packet *packet, ConstInts2 places, Arena *scratch);
