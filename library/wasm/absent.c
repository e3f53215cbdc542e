/* Stubs for what a smaller build lacks (web/scripts/kernels.mjs); the linker prefers the real functions.
 *
 * A header that needs the missing parts is refused (BSMDEC_LACKS in header.c), so these are the only functions that are
 * called without them. The linker lets calls of the others trap. */
#include "library/state.h"

#define ABSENT __attribute__((weak))

ABSENT void close_sequence(bsmdec *decoder) { (void)decoder; }
ABSENT void end_gops(Gops *gops) { (void)gops; }
ABSENT void end_layer(Layer *layer) { (void)layer; }
ABSENT bool parse_declaration(Context *context, Span payload, Arena *scratch, Declaration *declaration) {
    (void)payload, (void)scratch, (void)declaration;
    return FAIL(context, UNSUPPORTED, "");
}

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
