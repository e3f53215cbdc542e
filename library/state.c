/* Events and losses, the state that a new mesh resets, and the blocks of a mesh. */
#include "library/state.h"

void forget_changes(Changes *changes) {
    release_all(&changes->answer);
    release_all(&changes->memory);
    *changes = (Changes){.memory = arena_of(changes->memory.context), .answer = arena_of(changes->memory.context)};
}

void begin_mesh(bsmdec *decoder, const Header *header) {
    forget_split(decoder);
    forget_changes(&decoder->changes);
    decoder->mesh = (Mesh){.header = *header, .arena = arena_of(&decoder->context)};
    decoder->has_mesh = true;
}

bsmdec_event event_of(const bsmdec *decoder, bsmdec_event_type type, int64_t index, int64_t count) {
    const Mesh *mesh = &decoder->mesh;
    return (bsmdec_event){type, index, count, mesh->announced ? mesh->numbering.size : mesh->header.vertices,
        mesh->header.faces, decoder->has_mesh ? mesh->header.frames : decoder->sequence.announced};
}

bool emit_event(bsmdec *decoder, bsmdec_event_type type, int64_t index, int64_t count) {
    Context *context = &decoder->context;
    if (decoder->waiting == decoder->slots) {
        int64_t slots = 2 * decoder->slots + 16;
        Report *queue;
        if (!TAKE_OF_HOST(context, slots, queue)) return false;
        for (int64_t i = 0; i < decoder->waiting; i++) queue[i] = decoder->queue[(decoder->first + i) % decoder->slots];
        host_give(context, decoder->queue, (size_t)decoder->slots * sizeof *queue);
        decoder->queue = queue;
        decoder->slots = slots;
        decoder->first = 0;
    }
    decoder->queue[(decoder->first + decoder->waiting++) % decoder->slots].event =
        event_of(decoder, type, index, count);
    return true;
}

bool emit_loss(bsmdec *decoder, bsmdec_error error, int64_t index, int64_t count) {
    if (!emit_event(decoder, BSMDEC_LOSS, index, count)) return false;
    decoder->queue[(decoder->first + decoder->waiting - 1) % decoder->slots].loss = error;
    return true;
}

bool tolerate_error(bsmdec *decoder, int64_t block, bool anywhere) {
    Context *context = &decoder->context;
    if (!decoder->tolerant || !anywhere || context->starved || !failed(context)) return false;
    locate(&context->error, decoder->reader.last_offset, decoder->reader.last_frame, block);
    if (block >= 0 && decoder->mesh.has_chains) lose_block(&decoder->mesh.assembly, &decoder->mesh.blocks, block);
    return emit_loss(decoder, take_error(context), block, 0);
}

bool graph_of(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    if (!mesh->has_graph)
        mesh->has_graph = make_graph(mesh->faces, mesh->header.vertices, &mesh->arena, &decoder->scratch, &mesh->graph);
    return mesh->has_graph;
}

bool announce(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    if (mesh->announced) return true;
    mesh->announced = true;
    return emit_event(decoder, BSMDEC_CONNECTIVITY, 0, 0);
}

bool build(bsmdec *decoder) {
    Context *context = &decoder->context;
    Mesh *mesh = &decoder->mesh;
    if (mesh->has_chains) return true;
    const Graph *ground = ground_of(mesh);
    if (!graph_of(decoder)
        || (has_base(mesh)
            && !make_cells(context, &mesh->header.base, &mesh->graph, const_ints2(mesh->faces), &mesh->arena,
                &decoder->scratch, &mesh->cells))
        || !make_blocks(context, &mesh->header, ground, mesh->labels, &mesh->arena, &decoder->scratch, &mesh->blocks)
        || !begin_assembly(&mesh->assembly, ground->size, mesh->blocks.count, &mesh->arena))
        return false;
    mesh->has_chains = begin_chains(&mesh->chains, context, &mesh->header, ground, &mesh->blocks, &mesh->arena);
    return mesh->has_chains && announce(decoder);
}

/* Places of all cells; unknown ones are near known ones. */
static bool place_cells(bsmdec *decoder, Arena *arena, Doubles2 *places) {
    Mesh *mesh = &decoder->mesh;
    const Assembly *assembly = &mesh->assembly;
    Arena *scratch = &decoder->scratch;
    *places = mesh->cell_layer.positions;
    return (mesh->has_cell_layer
               || blend_all(assembly, &mesh->header, &mesh->cells.graph, arena, scratch, places))
        && fill_unknown(&mesh->cells.graph, const_doubles(assembly->blend.weights), scratch, *places);
}

bool place_base(bsmdec *decoder, Arena *arena, Doubles2 *positions) {
    Mesh *mesh = &decoder->mesh;
    Arena *scratch = &decoder->scratch;
    Doubles2 places;
    if (!has_base(mesh)) return blend_all(&mesh->assembly, &mesh->header, &mesh->graph, arena, scratch, positions);
    return place_cells(decoder, arena, &places)
        && prolong_cells(&mesh->cells, &mesh->graph, const_doubles2(places), mesh->header.base.rounds, arena, scratch,
            positions);
}

bool place_some(bsmdec *decoder, ConstInts vertices, Arena *arena, Doubles2 *positions) {
    Mesh *mesh = &decoder->mesh;
    Doubles2 places;
    if (vertices.size == mesh->graph.size) return place_base(decoder, arena, positions);
    return place_cells(decoder, arena, &places)
        && prolong_some(&mesh->cells, &mesh->graph, const_doubles2(places), mesh->header.base.rounds, vertices, arena,
            &decoder->scratch, positions);
}

bool mark_base(bsmdec *decoder, int beyond, Arena *arena, Bytes *whole) {
    Mesh *mesh = &decoder->mesh;
    const Graph *ground = ground_of(mesh);
    Bytes fit;
    if (!has_base(mesh) || !mesh->has_cell_layer) {
        if (!mark_whole(&mesh->assembly, &mesh->header, ground, arena, &decoder->scratch, has_base(mesh) ? 0 : beyond,
                whole))
            return false;
    } else if (!fit_vertices(&mesh->cell_layer, arena, whole)) {
        return false;
    }
    fit = *whole;
    return !has_base(mesh)
        || mark_prolonged(&mesh->cells, &mesh->graph, const_bytes(fit), mesh->header.base.rounds + beyond, arena,
            &decoder->scratch, whole);
}

bool blend(bsmdec *decoder, Refined *refined) {
    Mesh *mesh = &decoder->mesh;
    return place_base(decoder, &mesh->arena, &refined->base) && mark_base(decoder, 1, &mesh->arena, &refined->whole)
        && find_frames(&decoder->context, const_ints2(mesh->faces), &mesh->arena, refined);
}
