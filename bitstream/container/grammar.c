/* Which packet may follow which, and what a packet must have to agree with the header (specification, F 3.5 to F
 * 3.14). */
#include "bitstream/container/container.h"

#define BIT(type) (1u << (type))
static const uint32_t BODY = BIT(BLOCK_FRAME) | BIT(GOP_FRAME) | BIT(GRID_FRAME) | BIT(REFINEMENT_FRAME)
    | BIT(END_FRAME);
static const uint32_t TAIL = BIT(VALUES_FRAME) | BIT(END_FRAME);

/* Types that may follow one, METADATA and skippable ones left aside (F 3.8). */
static uint32_t followers(FrameType type) {
    switch (type) {
        case NO_FRAME: return BIT(HEADER_FRAME);
        case HEADER_FRAME: return BIT(CONNECTIVITY_FRAME);
        case CONNECTIVITY_FRAME: return BODY | BIT(PARTITION_FRAME) | BIT(ORDER_FRAME) | BIT(ATTRIBUTE_FRAME);
        case PARTITION_FRAME: return BODY | BIT(ORDER_FRAME) | BIT(ATTRIBUTE_FRAME);
        case ORDER_FRAME: return BODY | BIT(ATTRIBUTE_FRAME);
        case ATTRIBUTE_FRAME: return BODY | BIT(ATTRIBUTE_FRAME) | BIT(VALUES_FRAME);
        case BLOCK_FRAME: return TAIL | BIT(BLOCK_FRAME) | BIT(GOP_FRAME) | BIT(REFINEMENT_FRAME);
        case GOP_FRAME: return BIT(GOP_FRAME) | BIT(HEADER_FRAME) | BIT(END_FRAME);
        case GRID_FRAME: return TAIL | BIT(GRID_FRAME);
        case REFINEMENT_FRAME: return TAIL | BIT(REFINEMENT_FRAME);
        case VALUES_FRAME: return TAIL | BIT(GOP_FRAME);
        default: return 0;
    }
}

/* All types that may come at any distance after a frame. */
static uint32_t reachable(FrameType type) {
    uint32_t found = followers(type), before = 0;
    while (found != before) {
        before = found;
        for (int next = 0; next < 16; next++)
            if (before >> next & 1) found |= followers((FrameType)next);
    }
    return found;
}

static void begin_mesh(Grammar *grammar) {
    grammar->next_block = grammar->next_vertex = grammar->valued = grammar->next_value = 0;
    grammar->declared_count = 0;
    memset(grammar->declared, 0, sizeof grammar->declared);
    grammar->lossy = grammar->resuming = false;
}

void begin_grammar(Grammar *grammar, bool joining) {
    *grammar = (Grammar){.last = NO_FRAME, .allowed = followers(NO_FRAME), .joining = joining};
}

/* Whether the header says that frames of a type may come, if it has to say so (F 3.6). */
bool announces(const Grammar *grammar, int type) {
    const Header *header = grammar->header;
    if (header == NULL) return true;
    if (type == GRID_FRAME) return header->on_grid;
    if (type == REFINEMENT_FRAME) return header->refined;
    if (type == ATTRIBUTE_FRAME || type == VALUES_FRAME) return header->attributes > 0;
    return true;
}

uint32_t expected_types(const Grammar *grammar) {
    bool open = grammar->header != NULL && grammar->last != END_FRAME && !grammar->resuming;
    return open ? grammar->allowed | BIT(METADATA_FRAME) : grammar->allowed;
}

/* An unknown number of frames is missing here: what does not depend on them may come now (F 8.2). */
void lose_frames(Grammar *grammar) {
    grammar->allowed = reachable(grammar->last) & (BODY | BIT(HEADER_FRAME));
    grammar->lossy = grammar->resuming = true;
}

/* Whether the values of the attributes before one are there. */
static bool check_values_before(Context *context, const Grammar *grammar, int64_t before) {
    for (int64_t k = 0; k < MOST_ATTRIBUTES && k < before; k++) {
        if (grammar->declared[k] == NULL) continue;
        int64_t rows = grammar->declared[k]->rows;
        int64_t done = k < grammar->valued ? rows : k == grammar->valued ? grammar->next_value : 0;
        if (done < rows) return FAIL(context, CORRUPT, "the values of attribute # end at # of #", k, done, rows);
    }
    return true;
}

static bool check_run(Context *context, const Grammar *grammar, const Header *header) {
    const Header *before = grammar->header;
    if (before == NULL) {
        if (header->run == 0 || grammar->joining) return true;
        return FAIL(context, CORRUPT, "the stream begins within a sequence; a tolerant decoder joins it there");
    }
    if (before->gop_frames == 0 || header->gop_frames == 0)
        return FAIL(context, CORRUPT, "a second HEADER of a static mesh");
    int64_t following = before->run + 1;
    if (header->run < following || (header->run > following && !grammar->lossy))
        return FAIL(context, CORRUPT, "run # where run # must follow", header->run, following);
    if (header->frames != before->frames)
        return FAIL(context, CORRUPT, "a run of a sequence of # frames in one of #", header->frames, before->frames);
    return grammar->lossy || check_values_before(context, grammar, MOST_ATTRIBUTES);
}

/* Whether an attribute can be a base of tangents: their normals, or their texture coordinates (A 9.8). */
static bool is_base(const Declaration *d, bool normals) {
    if (d == NULL || d->domain == BSMDEC_FACE) return false;
    if (normals) return d->coding == OCTAHEDRAL;
    return d->coding == LEVELS && d->words == 2 && d->largest[0] < 1 << 20 && d->largest[1] < 1 << 20;
}

static bool check_tangents(Context *context, const Grammar *grammar, const Declaration *d) {
    if (grammar->header->swift == 0 || grammar->header->gop_frames > 0)
        return FAIL(context, CORRUPT, "tangents where the header does not allow them");
    for (int i = 0; i < 2; i++)
        if (d->bases[i] > MOST_ATTRIBUTES || !is_base(grammar->declared[d->bases[i] - 1], i == 0))
            return FAIL(context, CORRUPT, "tangents of attribute #, which cannot be their base", d->bases[i] - 1);
    return true;
}

static bool check_attribute(Context *context, const Grammar *grammar, const Packet *packet) {
    const Declaration *d = packet->declaration;
    int64_t index = packet->index;
    if (index != grammar->declared_count || index >= grammar->header->attributes)
        return FAIL(context, CORRUPT, "attribute #, where attribute # must follow", index, grammar->declared_count);
    for (int k = 0; k < MOST_ATTRIBUTES; k++) {
        const Declaration *e = grammar->declared[k];
        if (e != NULL && e->name_size == d->name_size && memcmp(e->name, d->name, (size_t)d->name_size) == 0)
            return FAIL(context, CORRUPT, "attribute # has the name of attribute #", index, k);
    }
    bool own_seams = d->domain == BSMDEC_CORNER && d->seams_of == 0;
    if (packet->data.size > 0 && !own_seams)
        return FAIL(context, CORRUPT, "seams of an attribute that has none of its own");
    if (d->seams_of > 0) {
        const Declaration *shared = d->seams_of <= MOST_ATTRIBUTES ? grammar->declared[d->seams_of - 1] : NULL;
        if (shared == NULL || shared->domain != BSMDEC_CORNER || shared->seams_of > 0)
            return FAIL(context, CORRUPT, "the seams of attribute #, which has none that come before", d->seams_of - 1);
    }
    if (d->leans && !grammar->header->on_grid)
        return FAIL(context, CORRUPT, "an attribute is predicted from positions that are on no grid");
    if (d->coding == TANGENTS && !check_tangents(context, grammar, d)) return false;
    if (d->moves && grammar->header->gop_frames == 0)
        return FAIL(context, CORRUPT, "an attribute of one mesh that moves");
    if (grammar->header->gop_frames > 0 && d->coding == RECOMPUTED)
        return FAIL(context, CORRUPT, "an attribute of a sequence that is recomputed from positions");
    return true;
}

static bool check_values(Context *context, const Grammar *grammar, const Packet *packet) {
    const Declaration *declared = packet->index < MOST_ATTRIBUTES ? grammar->declared[packet->index] : NULL;
    if (declared == NULL) return FAIL(context, CORRUPT, "values of attribute #, which is not declared", packet->index);
    if (packet->index < grammar->valued)
        return FAIL(context, CORRUPT, "values of attribute # follow those of #", packet->index, grammar->valued);
    int64_t following = packet->index == grammar->valued ? grammar->next_value : 0;
    if (packet->first != following)
        return FAIL(context, CORRUPT, "values begin at #, expected #", packet->first, following);
    if (packet->count == 0 || packet->count > declared->rows - packet->first)
        return FAIL(context, CORRUPT, "# values from # on, of #", packet->count, packet->first, declared->rows);
    return packet->index == grammar->valued || check_values_before(context, grammar, packet->index);
}

static bool check_block(Context *context, const Grammar *grammar, const Packet *packet) {
    const Header *header = grammar->header;
    if (packet->index < grammar->next_block) return FAIL(context, CORRUPT, "the indices of blocks must ascend");
    if (packet->index >= header->blocks) return FAIL(context, CORRUPT, "block # of #", packet->index, header->blocks);
    if (packet->coefficients > header->coefficients)
        return FAIL(context, CORRUPT, "# coefficients where the header allows #", packet->coefficients,
            header->coefficients);
    if (grammar->resuming && packet->index % chain_length(header) != 0)
        return FAIL(context, CORRUPT, "block # depends on one that is lost", packet->index);
    return true;
}

static bool check_chunk(Context *context, const Grammar *grammar, const Packet *packet) {
    int64_t following = grammar->next_vertex, cells = grammar->header->base.cells;
    bool of_cells = packet->first < cells, goes_on = grammar->resuming && cells > 0 && packet->first == cells;
    int64_t end = of_cells ? cells : levels_size(grammar->header);
    if (packet->first != following && !goes_on)
        return FAIL(context, CORRUPT, "vertices begin at #, expected #", packet->first, following);
    if (packet->count == 0 || packet->count > end - packet->first)
        return FAIL(context, CORRUPT, "# vertices from # on, of #", packet->count, packet->first, end);
    return true;
}

static bool check_gop(Context *context, const Grammar *grammar, const Packet *packet) {
    const Header *header = grammar->header;
    if (packet->index < grammar->next_frame) return FAIL(context, CORRUPT, "the indices of GOPs must ascend");
    if (header->gop_frames == 0) return FAIL(context, CORRUPT, "a GOP in the stream of a static mesh");
    if (header->frames > 0 && packet->index >= header->frames)
        return FAIL(context, CORRUPT, "a GOP from frame # on, of # frames", packet->index, header->frames);
    return true;
}

static bool check_end(Context *context, const Grammar *grammar) {
    const Header *header = grammar->header;
    if (grammar->lossy) return true;
    if (!check_values_before(context, grammar, MOST_ATTRIBUTES)) return false;
    if (header->on_grid && grammar->next_vertex < header->vertices)
        return FAIL(context, CORRUPT, "the positions end at vertex # of #", grammar->next_vertex, header->vertices);
    return true;
}

/* What is wrong with a packet that comes here. */
bool check_packet(Context *context, const Grammar *grammar, const Packet *packet) {
    const uint32_t COMPLETE = BIT(BLOCK_FRAME) | BIT(GOP_FRAME) | BIT(GRID_FRAME) | BIT(VALUES_FRAME) | BIT(END_FRAME);
    const Header *header = grammar->header;
    if (!(expected_types(grammar) >> packet->type & 1))
        return FAIL(context, CORRUPT, "unexpected section type #", packet->type);
    if (packet->type == HEADER_FRAME) return check_run(context, grammar, packet->header);
    if (header == NULL) return true;
    if (COMPLETE >> packet->type & 1 && grammar->declared_count < header->attributes && !grammar->lossy)
        return FAIL(context, CORRUPT, "# of # attributes are declared", grammar->declared_count, header->attributes);
    switch (packet->type) {
        case ATTRIBUTE_FRAME: return check_attribute(context, grammar, packet);
        case VALUES_FRAME: return check_values(context, grammar, packet);
        case BLOCK_FRAME: return check_block(context, grammar, packet);
        case GOP_FRAME: return check_gop(context, grammar, packet);
        case GRID_FRAME:
        case REFINEMENT_FRAME: return check_chunk(context, grammar, packet);
        case PARTITION_FRAME:
            return !(header->on_grid || header->base.cells > 0)
                || FAIL(context, CORRUPT, "a mesh on a grid or a base has no partition");
        case END_FRAME: return check_end(context, grammar);
        default: return true;
    }
}

void advance_grammar(Grammar *grammar, const Packet *packet, Declaration *declaration) {
    if (packet->type == METADATA_FRAME) return;
    if (packet->type == HEADER_FRAME) {
        grammar->joined = grammar->joined || (grammar->header == NULL && packet->header->run > 0);
        grammar->header = packet->header;
        begin_mesh(grammar);
    }
    if (packet->type == BLOCK_FRAME) grammar->next_block = packet->index + 1;
    if (packet->type == GOP_FRAME) grammar->next_frame = packet->index + 1;
    if (packet->type == GRID_FRAME || packet->type == REFINEMENT_FRAME)
        grammar->next_vertex = packet->first + packet->count;
    if (packet->type == ATTRIBUTE_FRAME) {
        grammar->declared[packet->index] = declaration;
        grammar->declared_count++;
    }
    if (packet->type == VALUES_FRAME) {
        grammar->valued = packet->index;
        grammar->next_value = packet->first + packet->count;
    }
    grammar->last = packet->type;
    grammar->resuming = false;
    bool resumes = packet->type == HEADER_FRAME && packet->header->mesh_of >= 0;
    grammar->allowed = resumes ? BIT(GOP_FRAME) : followers(packet->type);
}
