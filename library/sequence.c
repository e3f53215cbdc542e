/* Sequences: consecutive runs, each a mesh and its GOPs (specification, S 1, S 9). */
#include "library/state.h"

#include "bitstream/costs.h"

static bool is_tolerable(const bsmdec *decoder) {
    return decoder->tolerant && failed(&decoder->context) && !decoder->context.starved;
}

/* Frames are lost; how many is known when the next ones come. */
static void lose(Sequence *sequence, bsmdec_error error) {
    if (!sequence->damaged) sequence->damage = error;
    sequence->damaged = true;
}

static void forget_skipped(Sequence *sequence) {
    release_all(&sequence->waiting);
    sequence->first = sequence->last = NULL;
}

static void forget(bsmdec *decoder) {
    forget_skipped(&decoder->sequence);
    if (decoder->mesh.gops.begun) forget_frames(&decoder->mesh.gops);
}

/* Report `count` frames as lost, or fail. */
static bool report_loss(bsmdec *decoder, int64_t frames) {
    Sequence *sequence = &decoder->sequence;
    Context *context = &decoder->context;
    int64_t first = sequence->next;
    if (!decoder->tolerant) return FAIL(context, CORRUPT, "# frames from number # on are missing", frames, first);
    if (!sequence->damaged) {
        FAIL(context, CORRUPT, "a GOP is missing");
        lose(sequence, take_error(context));
    }
    sequence->damaged = false;
    sequence->next += frames;
    sequence->missing += frames;
    sequence->lossy = true;
    return emit_loss(decoder, sequence->damage, first, frames);
}

/* The place of a mesh on the shelf, -1 if it is not there. */
static int place_of_mesh(const Sequence *sequence, int64_t run) {
    int place = sequence->cached - 1;
    while (place >= 0 && sequence->cache[place]->run != run) place--;
    return place;
}

static CachedMesh *take_cached(Sequence *sequence, int place) {
    CachedMesh *taken = sequence->cache[place];
    for (sequence->cached--; place < sequence->cached; place++) sequence->cache[place] = sequence->cache[place + 1];
    return taken;
}

static void drop_cached(Context *context, CachedMesh *cached) {
    end_mesh(&cached->mesh);
    host_give(context, cached, sizeof *cached);
}

static void count_anew(bsmdec *decoder) {
    decoder->sequence.kept = decoder->context.spent.reserved;
    decoder->sequence.vertices = decoder->context.spent.vertices;
}

static void give_back(Context *context, double memory, int64_t vertices) {
    context->spent.reserved -= memory;
    context->spent.gone += vertices;
}

/* The run is over: its mesh is kept for later ones, or nothing of it. */
static void leave_run(bsmdec *decoder) {
    Sequence *sequence = &decoder->sequence;
    Context *context = &decoder->context;
    forget(decoder);
    forget_changes(&decoder->changes);
    suspend_gops(&decoder->mesh.gops);
    double memory = context->spent.reserved - sequence->kept;
    int64_t vertices = context->spent.vertices - sequence->vertices;
    int place = decoder->has_mesh ? place_of_mesh(sequence, sequence->mesh) : -1;
    if (place >= 0) {
        sequence->cache[place]->memory += memory;
        sequence->cache[place]->vertices += vertices;
        sequence->cache[place]->mesh = decoder->mesh;
    } else {
        give_back(context, memory, vertices);
        if (decoder->has_mesh) end_mesh(&decoder->mesh);
    }
    forget_split(decoder);
    decoder->mesh = (Mesh){.arena = arena_of(context)};
    decoder->has_mesh = decoder->has_positions = false;
    count_anew(decoder);
}

/* Another mesh comes: where there is no room for it, the one that was used longest ago is given up. */
static void make_room(bsmdec *decoder) {
    Sequence *sequence = &decoder->sequence;
    if (sequence->cached < MOST_CACHED) return;
    CachedMesh *oldest = take_cached(sequence, 0);
    give_back(&decoder->context, oldest->memory, oldest->vertices);
    drop_cached(&decoder->context, oldest);
    count_anew(decoder);
}

/* Keep the present mesh, from now on. */
static bool cache_mesh(bsmdec *decoder) {
    Sequence *sequence = &decoder->sequence;
    if (place_of_mesh(sequence, sequence->mesh) >= 0) return true;
    CachedMesh *place;
    if (!TAKE_OF_HOST(&decoder->context, 1, place)) return false;
    *place = (CachedMesh){.run = sequence->mesh, .mesh.arena = arena_of(&decoder->context)};
    sequence->cache[sequence->cached++] = place;
    return true;
}

void close_sequence(bsmdec *decoder) {
    Sequence *sequence = &decoder->sequence;
    int present = decoder->has_mesh ? place_of_mesh(sequence, sequence->mesh) : -1;
    for (int i = 0; i < sequence->cached; i++) {
        if (i == present) host_give(&decoder->context, sequence->cache[i], sizeof *sequence->cache[i]);
        else drop_cached(&decoder->context, sequence->cache[i]);
    }
    forget_skipped(sequence);
}

/* A run that has the mesh of an earlier one (S 9.3). */
static bool resume(bsmdec *decoder, const Header *header) {
    Sequence *sequence = &decoder->sequence;
    Context *context = &decoder->context;
    int place = place_of_mesh(sequence, sequence->mesh);
    if (place < 0)
        return FAIL(context, CORRUPT, "run # has the mesh of run #, which is no longer kept", header->run,
            header->mesh_of);
    CachedMesh *found = take_cached(sequence, place);
    sequence->cache[sequence->cached++] = found;
    decoder->mesh = found->mesh;
    found->mesh = (Mesh){.arena = arena_of(context)};
    decoder->has_mesh = true;
    Header *own = &decoder->mesh.header;
    if (own->vertices != header->vertices || own->faces != header->faces)
        return FAIL(context, CORRUPT, "run # has another mesh than the run that it names", header->run);
    own->frames = header->frames;
    own->gop_frames = header->gop_frames;
    own->run = header->run;
    for (int k = 0; k < MOST_ATTRIBUTES; k++)
        if (decoder->mesh.attributes.list[k] != NULL) decoder->mesh.attributes.list[k]->moved = NULL;
    return emit_event(decoder, BSMDEC_HEADER, header->run, 0) && emit_event(decoder, BSMDEC_CONNECTIVITY, 0, 0);
}

static bool begin_run(bsmdec *decoder, const Header *header) {
    Sequence *sequence = &decoder->sequence;
    Context *context = &decoder->context;
    if (sequence->active) leave_run(decoder);
    sequence->announced = header->frames;
    sequence->mesh = header->mesh_of >= 0 ? header->mesh_of : header->run;
    if (header->mesh_of >= 0) {
        if (!resume(decoder, header)) return false;
    } else {
        make_room(decoder);
        if (header->smoothing != 0.0)
            return FAIL(context, UNSUPPORTED, "smoothing of sequences is unknown to this decoder");
        if (!WITHIN(context, sequence_bytes, 8.0 * (double)header->vertices * (double)header->coefficients))
            return false;
        begin_mesh(decoder, header);
        if (!emit_event(decoder, BSMDEC_HEADER, header->run, 0)) return false;
    }
    sequence->lost = false;
    return sequence->active = true;
}

/* What comes before the GOPs of the run is not whole; the next run is waited for. */
static bool lose_run(bsmdec *decoder) {
    if (!is_tolerable(decoder) || !decoder->sequence.active) return false;
    locate(&decoder->context.error, decoder->reader.last_offset, decoder->reader.last_frame, -1);
    decoder->sequence.why = take_error(&decoder->context);
    lose(&decoder->sequence, decoder->sequence.why);
    return decoder->sequence.lost = true;
}

/* Blocks and attributes, when the first section after the faces comes. */
static bool begin_first_frame(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    if (!mesh->has_faces) return FAIL(&decoder->context, CORRUPT, "the stream ends before its first block");
    return build(decoder)
        && (!mesh->has_attributes || begin_values(&mesh->attributes, &mesh->numbering));
}

static bool find_moving(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    Context *context = &decoder->context;
    if (!TAKE_ZEROS(&mesh->arena, mesh->has_attributes ? mesh->attributes.count : 0, mesh->moving)) return false;
    for (int k = 0; mesh->has_attributes && k < MOST_ATTRIBUTES; k++) {
        const Attribute *attribute = mesh->attributes.list[k];
        if (attribute == NULL || !attribute->declaration.moves) continue;
        if (attribute->declaration.rows != mesh->header.vertices)
            return FAIL(context, CORRUPT, "attribute '$' moves, and what no face uses has values of it",
                .name = attribute->declaration.name);
        if (!attribute->whole && !decoder->tolerant)
            return FAIL(context, CORRUPT, "attribute '$' moves, and not all of its first values have come",
                .name = attribute->declaration.name);
        MovingAttribute *moving = mesh->moving + mesh->moving_count++;
        *moving = (MovingAttribute){.number = k, .width = attribute->declaration.components};
        if (!take_doubles2(&mesh->arena, attribute->whole ? attribute->rows : 0, moving->width, &moving->start))
            return false;
        relative_values(attribute, moving->start);
    }
    return true;
}

/* The first frame is there, and GOPs come. */
static bool enter_gops(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    if (mesh->in_gops) return true;
    if (!begin_first_frame(decoder)) return false;
    if (mesh->next_block < mesh->header.blocks)
        return FAIL(&decoder->context, CORRUPT, "the first frame ends after # of # blocks", mesh->next_block,
            mesh->header.blocks);
    end_chains(&mesh->chains);
    end_ahead(mesh);
    mesh->in_gops = find_moving(decoder)
        && blend_all(&mesh->assembly, &mesh->header, &mesh->graph, &mesh->arena, &decoder->scratch, &mesh->first_frame);
    return mesh->in_gops;
}

/* A GOP cannot be decoded, or was not there. */
static bool lose_gop(bsmdec *decoder) {
    if (!is_tolerable(decoder)) return false;
    locate(&decoder->context.error, decoder->reader.last_offset, decoder->reader.last_frame, -1);
    lose(&decoder->sequence, take_error(&decoder->context));
    forget(decoder);
    return true;
}

static bool read_gop(bsmdec *decoder, Span data, Gop *gop) {
    Mesh *mesh = &decoder->mesh;
    return parse_gop(&decoder->context, data, mesh->header.gop_frames, mesh->header.run, mesh->moving,
        mesh->moving_count, decoder->tolerant, &decoder->scratch, gop);
}

static bool parse_next(bsmdec *decoder, const Packet *packet, Gop *gop) {
    const Header *header = &decoder->mesh.header;
    Context *context = &decoder->context;
    if (packet->index < decoder->sequence.next)
        return FAIL(context, CORRUPT, "GOP at frame #, expected # or later", packet->index, decoder->sequence.next);
    if (!read_gop(decoder, packet->data, gop) || !WITHIN(context, sequence_bytes, gop_memory(header->vertices, gop, 0)))
        return false;
    int64_t last = packet->index + gop->frames - 1;
    return header->frames == 0 || last < header->frames
        || FAIL(context, CORRUPT, "frames # to # of #", packet->index, last, header->frames);
}

/* Frames and bytes of a GOP pay for the work done at its first frame. */
static bool pay_for(bsmdec *decoder, const Gop *gop, double received) {
    Mesh *mesh = &decoder->mesh;
    Context *context = &decoder->context;
    if (!reserve(context, 0, received)) return false;
    context->spent.shown += mesh->header.vertices * gop->frames;
    if (mesh->gops.begun) return true;
    bool begun = begin_gops(&mesh->gops, context, &mesh->header, &mesh->graph, &mesh->blocks, const_ints2(mesh->faces),
        const_doubles2(mesh->first_frame), mesh->numbering.size, mesh->moving, mesh->moving_count, &decoder->scratch);
    if (!begun) end_gops(&mesh->gops);
    return begun;
}

static bool skip_gop(Sequence *sequence, Span data) {
    Skipped *skipped;
    uint8_t *copy;
    if (!TAKE(&sequence->waiting, 1, skipped) || !TAKE(&sequence->waiting, data.size, copy)) return false;
    memcpy(copy, data.data, (size_t)data.size);
    *skipped = (Skipped){NULL, {copy, data.size}};
    if (sequence->first == NULL) sequence->first = skipped;
    else sequence->last->next = skipped;
    sequence->last = skipped;
    return true;
}

/* Decode a GOP, or keep it, where no frame of it is wanted and others may depend on it. */
static bool decode_frames(bsmdec *decoder, const Gop *gop, Span data) {
    Sequence *sequence = &decoder->sequence;
    Gops *gops = &decoder->mesh.gops;
    if (!reserve_gop(gops, gop, (double)data.size)) return false;
    if (gop->method == LEARNED || gop->method == KEY_FRAMES) forget_skipped(sequence);
    if (sequence->next + gop->frames <= sequence->start) return skip_gop(sequence, data);
    for (const Skipped *skipped = sequence->first; skipped != NULL; skipped = skipped->next) {
        Gop earlier;
        Mark mark = mark_of(&decoder->scratch);
        bool done = read_gop(decoder, skipped->data, &earlier) && decode_gop(gops, &earlier, &decoder->scratch);
        release_to(&decoder->scratch, mark);
        if (!done) return false;
    }
    forget_skipped(sequence);
    return decode_gop(gops, gop, &decoder->scratch);
}

static bool accept_gop(bsmdec *decoder, const Packet *packet) {
    Sequence *sequence = &decoder->sequence;
    Gop gop;
    decoder->has_positions = false;
    if (packet->index > sequence->next) {
        if (!report_loss(decoder, packet->index - sequence->next)) return false;
        forget(decoder);
    }
    if (!parse_next(decoder, packet, &gop)) return lose_gop(decoder);
    if (!pay_for(decoder, &gop, (double)packet->data.size)) return false;
    if (!decode_frames(decoder, &gop, packet->data)) {
        decoder->context.spent.shown -= decoder->mesh.header.vertices * gop.frames;
        return lose_gop(decoder);
    }
    sequence->gop = sequence->next;
    sequence->next += gop.frames;
    for (int64_t t = sequence->gop; t < sequence->next; t++)
        if (t >= sequence->start && !emit_event(decoder, BSMDEC_FRAME, t, 0)) return false;
    return true;
}

bool show(bsmdec *decoder, int64_t index) {
    Mesh *mesh = &decoder->mesh;
    Gops *gops = &mesh->gops;
    int64_t t = index - decoder->sequence.gop;
    ConstDoubles2 frame;
    if (!show_frame(gops, t, &decoder->scratch, 0, &frame)) return false;
    decoder->positions = frame;
    decoder->has_positions =
        into_unit(&decoder->context, &mesh->header, (Doubles2){(double *)frame.data, frame.rows, 3});
    if (decoder->has_positions)
        decoder->shown_sum = crc32_of_positions(&decoder->reader.sums, frame, decoder->shown_sum);
    for (int k = 0; k < mesh->moving_count && decoder->has_positions; k++) {
        Attribute *attribute = mesh->attributes.list[mesh->moving[k].number];
        if (!attribute->whole) continue;
        void *moved = attribute->moved;
        if ((moved == NULL && !take_values(&mesh->arena, attribute, &moved))
            || !show_frame(gops, t, &decoder->scratch, k + 1, &frame))
            return false;
        decoder->has_positions = move_values(&decoder->context, attribute, frame, moved);
    }
    return decoder->has_positions;
}

static bool accept_block(bsmdec *decoder, const Packet *packet) {
    Mesh *mesh = &decoder->mesh;
    if (!begin_first_frame(decoder)) return false;
    if (packet->index != mesh->next_block)
        return FAIL(&decoder->context, CORRUPT, "block # of the first frame where block # belongs", packet->index,
            mesh->next_block);
    return reserve(&decoder->context, 0, (double)packet->data.size + BLOCK_FRAME_BYTES)
        && accept_section(decoder, packet);
}

static bool accept_values(bsmdec *decoder, const Packet *packet) {
    if (!begin_first_frame(decoder) || decoder->mesh.next_block < decoder->mesh.header.blocks)
        return enter_gops(decoder);
    return accept_section(decoder, packet) || tolerate_error(decoder, -1, true);
}

static bool accept_in_run(bsmdec *decoder, const Packet *packet) {
    Mesh *mesh = &decoder->mesh;
    if (packet->type == HEADER_FRAME) return begin_run(decoder, packet->header);
    if (packet->type == METADATA_FRAME) return accept_section(decoder, packet);
    if (decoder->sequence.lost) return true;
    if (!mesh->in_gops) {
        if (!mesh->has_faces && packet->type != CONNECTIVITY_FRAME)
            return FAIL(&decoder->context, CORRUPT, "unexpected section type #", packet->type);
        if (packet->type == BLOCK_FRAME) return accept_block(decoder, packet);
        if (packet->type == VALUES_FRAME) return accept_values(decoder, packet);
        if (!mesh->has_chains && packet->type != GOP_FRAME && packet->type != END_FRAME)
            return accept_section(decoder, packet);
    }
    if (!enter_gops(decoder)) return false;
    if (packet->type == GOP_FRAME) return accept_gop(decoder, packet) && cache_mesh(decoder);
    if (packet->type != END_FRAME) FAIL(&decoder->context, CORRUPT, "unexpected section type #", packet->type);
    return (packet->type == END_FRAME || lose_gop(decoder)) && cache_mesh(decoder);
}

bool accept_in_sequence(bsmdec *decoder, const Packet *packet) {
    return accept_in_run(decoder, packet) || lose_run(decoder);
}

static bool accept_damage_in_run(bsmdec *decoder, FrameType type) {
    Mesh *mesh = &decoder->mesh;
    bool before = mesh->has_faces && !mesh->has_chains && (type == BLOCK_FRAME || type == ATTRIBUTE_FRAME);
    bool behind = mesh->has_chains && !mesh->in_gops && mesh->next_block == mesh->header.blocks && type == VALUES_FRAME;
    if (before || behind) return tolerate_error(decoder, -1, true);
    if (!mesh->has_chains || mesh->next_block < mesh->header.blocks) return false;
    bsmdec_error error = take_error(&decoder->context);
    if (!enter_gops(decoder) || !cache_mesh(decoder)) return false;
    if (type == END_FRAME && decoder->sequence.lossy) return true;
    decoder->context.error = error;
    return lose_gop(decoder);
}

/* The error is the context's. */
bool accept_damage_in_sequence(bsmdec *decoder) {
    if (decoder->sequence.lost) {
        take_error(&decoder->context);
        return true;
    }
    return accept_damage_in_run(decoder, decoder->reader.damage.type) || lose_run(decoder);
}

/* Nothing follows. */
bool end_sequence(bsmdec *decoder) {
    Sequence *sequence = &decoder->sequence;
    if (!sequence->lost && !enter_gops(decoder) && !lose_run(decoder)) return false;
    if (sequence->lost && sequence->next <= sequence->missing) {
        decoder->context.error = sequence->why;
        return false;
    }
    int64_t missing = sequence->announced > 0 ? sequence->announced - sequence->next : 0;
    if ((missing != 0 || (sequence->damaged && sequence->announced == 0)) && !report_loss(decoder, missing))
        return false;
    if (!sequence->lossy && !check_sum(decoder, decoder->shown_sum)) return false;
    decoder->ended = true;
    return emit_event(decoder, BSMDEC_END, 0, 0);
}
