/* Sequences: consecutive runs, each a mesh and its GOPs (specification, S 1, S 9). */
#pragma once

#include "library/state.h"

bool accept_in_sequence(bsmdec *decoder, const Packet *packet);
/* The error is the context's. */
bool accept_damage_in_sequence(bsmdec *decoder);
/* Nothing follows. */
bool end_sequence(bsmdec *decoder);
/* Make a reported frame the current one. */
bool show(bsmdec *decoder, int64_t index);
void close_sequence(bsmdec *decoder);
