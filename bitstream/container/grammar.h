/* Which packet may follow which (specification, F 3.5 to F 3.14). */
#pragma once

#include "bitstream/container/packet.h"

typedef struct {
    const Header *header; /* of the present run, NULL before the first */
    FrameType last;       /* NO_FRAME before the first */
    uint32_t allowed;     /* bit k: type k */
    bool lossy, resuming, joining, joined; /* resuming: after damage, before anything else has come */
    int64_t next_block, next_frame, next_vertex, valued, next_value;
    Declaration *declared[MOST_ATTRIBUTES];
    int declared_count;
} Grammar;

void begin_grammar(Grammar *grammar, bool joining);
bool announces(const Grammar *grammar, int type);
uint32_t expected_types(const Grammar *grammar);
void lose_frames(Grammar *grammar);
bool check_packet(Context *context, const Grammar *grammar, const Packet *packet);
/* What an attribute's packet declares has to stay: `declaration` is the grammar's own copy of it. */
void advance_grammar(Grammar *grammar, const Packet *packet, Declaration *declaration);
