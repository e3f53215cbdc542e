/* Stubs for what a smaller build lacks (web/scripts/kernels.mjs); the linker prefers the real functions. */
#include "engine/ahead.h"
#include "engine/sequence.h"
#include "engine/zstd.h"

#define ABSENT __attribute__((weak))

#define ABSENT_PART "this build decodes less than all; bsm.js decodes the rest"
static bool absent(Context *context) { return FAIL(context, UNSUPPORTED, ABSENT_PART); }

ABSENT bool accept_in_sequence(bsmdec *decoder, const Packet *packet) {
    (void)packet;
    return absent(&decoder->context);
}
ABSENT bool accept_damage_in_sequence(bsmdec *decoder) { return absent(&decoder->context); }
ABSENT bool end_sequence(bsmdec *decoder) { return absent(&decoder->context); }
ABSENT bool show(bsmdec *decoder, int64_t index) {
    (void)index;
    return absent(&decoder->context);
}
ABSENT void close_sequence(bsmdec *decoder) { (void)decoder; }
ABSENT void end_gops(Gops *gops) { (void)gops; }

/* A page has no threads: its workers have decoders of their own. */
ABSENT bool build_beside(bsmdec *decoder) { return build(decoder); }
ABSENT void look_ahead(bsmdec *decoder, const Packet *packet) { (void)decoder, (void)packet; }
ABSENT const ReadyBlock *find_ready(const bsmdec *decoder, const Packet *packet) {
    (void)decoder, (void)packet;
    return NULL;
}
ABSENT void end_chains_ahead(Mesh *mesh) { (void)mesh; }
ABSENT bool blend_beside(bsmdec *decoder, Refined *refined) { return blend(decoder, refined); }
ABSENT void end_ahead(Mesh *mesh) { (void)mesh; }

ABSENT bool parse_declaration(Context *context, Span payload, Arena *scratch, Declaration *declaration) {
    (void)payload, (void)scratch, (void)declaration;
    return absent(context);
}
ABSENT void begin_attributes(Attributes *attributes, Context *context, const Header *header, ConstInts2 faces,
    Arena *arena) {
    (void)attributes, (void)header, (void)faces, (void)arena;
    FAIL(context, UNSUPPORTED, ABSENT_PART);
}
ABSENT void end_attributes(Attributes *attributes) { (void)attributes; }
ABSENT bool declare_attribute(Attributes *attributes, int64_t index, const Declaration *declaration, Span seams,
    Arena *scratch) {
    (void)attributes, (void)index, (void)declaration, (void)seams;
    return absent(scratch->context);
}
ABSENT bool check_rows(const Attributes *attributes, int64_t index, const Numbering *numbering) {
    (void)attributes, (void)index, (void)numbering;
    return false;
}
ABSENT bool begin_values(Attributes *attributes, const Numbering *numbering, Arena *scratch) {
    (void)attributes, (void)numbering;
    return absent(scratch->context);
}
ABSENT bool decode_values(Attributes *attributes, const Packet *packet, ConstInts2 places, Arena *scratch) {
    (void)attributes, (void)packet, (void)places;
    return absent(scratch->context);
}
ABSENT bool recompute(Attribute *attribute, ConstDoubles2 positions, Arena *scratch) {
    (void)attribute, (void)positions;
    return absent(scratch->context);
}
ABSENT bool take_values(Arena *arena, const Attribute *attribute, void **values) {
    (void)attribute, (void)values;
    return absent(arena->context);
}
ABSENT void relative_values(const Attribute *attribute, Doubles2 beyond) { (void)attribute, (void)beyond; }
ABSENT bool move_values(Context *context, Attribute *attribute, ConstDoubles2 change, void *moved) {
    (void)attribute, (void)change, (void)moved;
    return absent(context);
}
ABSENT Given given_shape(const Attribute *attribute, const Numbering *numbering) {
    (void)attribute, (void)numbering;
    return (Given){0};
}
ABSENT bool given_rows(const Attribute *attribute, const Numbering *numbering, Arena *scratch, Longs rows) {
    (void)attribute, (void)numbering, (void)rows;
    return absent(scratch->context);
}
ABSENT int32_t row_of_corner(const Attribute *attribute, const Numbering *numbering, int64_t corner) {
    (void)attribute, (void)numbering, (void)corner;
    return 0;
}

ABSENT bool begin_grid(GridField *field, Context *context, const Header *header, ConstInts2 faces, Arena *arena,
    Arena *scratch) {
    (void)field, (void)header, (void)faces, (void)arena, (void)scratch;
    return absent(context);
}
ABSENT bool decode_grid(GridField *field, int64_t first, int64_t count, Span payload, Arena *scratch) {
    (void)field, (void)first, (void)count, (void)payload;
    return absent(scratch->context);
}
ABSENT void end_layer(Layer *layer) { (void)layer; }
ABSENT bool find_frames(Context *context, ConstInts2 faces, Arena *arena, Refined *refined) {
    (void)faces, (void)arena, (void)refined;
    return absent(context);
}
ABSENT bool begin_layer(Layer *layer, Context *context, const Header *header, ConstInts2 faces, Refined refined,
    Arena *arena, Arena *scratch) {
    (void)layer, (void)header, (void)faces, (void)refined, (void)arena, (void)scratch;
    return absent(context);
}
ABSENT bool decode_layer(Layer *layer, int64_t first, int64_t count, Span payload, Arena *scratch) {
    (void)layer, (void)first, (void)count, (void)payload;
    return absent(scratch->context);
}
ABSENT bool fit_vertices(const Layer *layer, Arena *scratch, Bytes *fit) {
    (void)layer, (void)fit;
    return absent(scratch->context);
}

ABSENT bool unpack_zstd(Context *context, Span frame, uint8_t *content, int64_t size, Arena *scratch) {
    (void)frame, (void)content, (void)size, (void)scratch;
    return absent(context);
}
