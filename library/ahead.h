/* Chains of blocks, and levels of refinements, that threads of the host decode before their packets are accepted.
 *
 * Decoding ahead changes nothing but time. A chain that fails ahead, for whatever reason, is decoded again in its turn.
 * A chain that does not fail leaves its charges in ledgers, and they are made in its turn. */
#pragma once

#include "library/state.h"

/* Build blocks from the graph; meanwhile another thread reads levels of refinements, which need faces alone. */
bool build_beside(bsmdec *decoder);
/* Decode the chain that begins with this block and the next ones, as far as all of their bytes have come. */
void look_ahead(bsmdec *decoder, const Packet *packet);
/* A block that was decoded ahead; NULL if it was not. */
const ReadyBlock *find_ready(const bsmdec *decoder, const Packet *packet);
/* Chains are over: keep levels alone. */
void end_chains_ahead(Mesh *mesh);
/* `blend`; meanwhile another thread reads the levels that are left. All become those of the mesh, if there are any. */
bool blend_beside(bsmdec *decoder, Refined *refined);
void end_ahead(Mesh *mesh);
