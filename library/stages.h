/* The stages of one mesh: faces, blocks or grids, refinements, attributes (specification, F 3.8, F 8.3). */
#pragma once

#include "library/state.h"

/* Accept a packet, and queue its events. */
bool accept_section(bsmdec *decoder, const Packet *packet);
/* The error is the context's. */
bool accept_damage_in_mesh(bsmdec *decoder);
/* Nothing follows. */
bool finish_mesh(bsmdec *decoder);
void end_mesh(Mesh *mesh);
/* Positions of a mesh that is not whole yet, as far as they are known. */
bool look_at_positions(bsmdec *decoder);
/* Whether the checksum of all positions is the stream's; a tolerant decoder reports a difference as a loss. */
bool check_sum(bsmdec *decoder, uint32_t found);
