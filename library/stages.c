/* The stages of one mesh: faces, blocks or grids, refinements, attributes (specification, F 3.8, F 8.3). */
#include "library/state.h"

#include "bitstream/costs.h"
#include "bitstream/payloads/payloads.h"

/* Whether a frame belongs before stages that have begun: after a loss the grammar does not know what came before. */
static bool is_too_late(const Mesh *mesh, FrameType type) {
    const uint32_t early = 1u << CONNECTIVITY_FRAME | 1u << PARTITION_FRAME | 1u << ORDER_FRAME | 1u << BLOCK_FRAME;
    const uint32_t positions = mesh->values_begun ? 1u << GRID_FRAME | 1u << REFINEMENT_FRAME : 0;
    return (mesh->has_cell_layer || mesh->has_layer || mesh->values_begun) && (early | positions) >> type & 1;
}

void end_mesh(Mesh *mesh) {
    end_ahead(mesh);
    if (mesh->has_chains) end_chains(&mesh->chains);
    if (mesh->has_attributes) end_attributes(&mesh->attributes);
    end_layer(&mesh->cell_layer);
    end_layer(&mesh->layer);
    end_gops(&mesh->gops);
    release_all(&mesh->arena);
}

static bool accept_connectivity(bsmdec *decoder, Span data) {
    Context *context = &decoder->context;
    Mesh *mesh = &decoder->mesh;
    const Header *header = &mesh->header;
    double n = (double)header->vertices, m = (double)header->faces, bytes = (double)data.size;
    if (!code_connectivity(context, data, header, &(Surface){0}, &mesh->arena, &decoder->scratch, &mesh->faces))
        return false;
    context->spent.vertices += header->vertices;
    mesh->has_faces = true;
    mesh->numbering = (Numbering){.size = header->vertices, .faces = const_ints2(mesh->faces)};
    double work = mesh_work(n, m, bytes) + (has_edges(header) ? edges_work(m) : 0);
    return reserve(context, mesh_memory(n, m), bytes) && charge(context, work, bytes);
}

static bool accept_partition(bsmdec *decoder, Span data) {
    Context *context = &decoder->context;
    Mesh *mesh = &decoder->mesh;
    if (!graph_of(decoder)) return false;
    const Graph *graph = &mesh->graph;
    double n = (double)graph->size, ends = (double)graph->neighbors.size, bytes = (double)data.size;
    return zero_ints(&mesh->arena, graph->size, &mesh->labels)
        && charge(context, labels_work(n, ends, bytes), bytes)
        && code_partition(context, data, graph->offsets, graph->neighbors, mesh->header.blocks, &decoder->scratch,
            mesh->labels);
}

/* Give up the blocks before `index` that did not come. */
static bool skip_to(bsmdec *decoder, int64_t index) {
    Mesh *mesh = &decoder->mesh;
    for (; mesh->next_block < index; mesh->next_block++) {
        FAIL(&decoder->context, CORRUPT, "the frame of the block is missing");
        locate(&decoder->context.error, -1, -1, mesh->next_block);
        if (!tolerate_error(decoder, mesh->next_block, mesh->header.gop_frames == 0)) return false;
    }
    return true;
}

/* Keep a block for the decoder that asked for it. */
static bool hand_over(bsmdec *decoder, const DecodedBlock *block) {
    release_all(&decoder->shown);
    return copy_block(block, &decoder->shown, &decoder->share.handed);
}

static bool find_block(bsmdec *decoder, const Packet *packet, DecodedBlock *block) {
    Chains *chains = &decoder->mesh.chains;
    look_ahead(decoder, packet);
    const ReadyBlock *ready = find_ready(decoder, packet);
    if (ready == NULL)
        return decode_block(chains, packet->index, packet->coefficients, packet->data, &decoder->scratch, block);
    *block = ready->block;
    return settle_block(chains, packet->index, &ready->ledger);
}

/* Whether the caller wants no packets after the blocks. */
static bool ends_with_blocks(const bsmdec *decoder) {
    return decoder->base_alone && decoder->mesh.header.refined && decoder->mesh.header.gop_frames == 0;
}

static bool end_with_blocks(bsmdec *decoder) {
    decoder->over = true;
    return finish_mesh(decoder);
}

static bool accept_block(bsmdec *decoder, const Packet *packet) {
    Mesh *mesh = &decoder->mesh;
    DecodedBlock block;
    if (!(mesh->has_chains ? build(decoder) : build_beside(decoder)) || !skip_to(decoder, packet->index)) return false;
    mesh->next_block++;
    if (!is_own(&decoder->share, &mesh->header, packet->index))
        return decoder->share.helps || emit_event(decoder, (bsmdec_event_type)BLOCK_OF_HELPER, packet->index, 0);
    bool last = ends_with_blocks(decoder) && mesh->next_block == mesh->header.blocks;
    if (!find_block(decoder, packet, &block))
        return tolerate_error(decoder, packet->index, mesh->header.gop_frames == 0)
            && (!last || end_with_blocks(decoder));
    if (!decoder->share.helps) add_block(&mesh->assembly, &block);
    else if (!hand_over(decoder, &block)) return false;
    return emit_event(decoder, BSMDEC_BLOCK, packet->index, 0) && (!last || end_with_blocks(decoder));
}

static bool ensure_grid(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    if (mesh->has_grid) return true;
    mesh->has_grid = begin_grid(&mesh->grid, NULL, &decoder->context, &mesh->header, const_ints2(mesh->faces),
        &mesh->arena, &decoder->scratch);
    return mesh->has_grid && announce(decoder);
}

static bool accept_grid(bsmdec *decoder, const Packet *packet) {
    Mesh *mesh = &decoder->mesh;
    if (!ensure_grid(decoder)) return false;
    if (mesh->grid.broken) return true;
    if (decode_grid(&mesh->grid, packet->first, packet->count, packet->data, &decoder->scratch))
        return emit_event(decoder, BSMDEC_BLOCK, mesh->chunks++, 0);
    mesh->grid.broken = true;
    return tolerate_error(decoder, -1, true);
}

/* No more blocks come. */
static bool end_blocks(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    if (!build(decoder) || !skip_to(decoder, mesh->header.blocks)) return false;
    end_chains(&mesh->chains);
    end_chains_ahead(mesh);
    return true;
}

static bool ensure_cell_layer(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    Refined refined;
    Arena *arena = &mesh->arena, *scratch = &decoder->scratch;
    if (mesh->has_cell_layer) return true;
    if (!end_blocks(decoder)) return false;
    ConstInts2 faces = const_ints2(mesh->cells.faces);
    mesh->has_cell_layer =
        blend_all(&mesh->assembly, &mesh->header, &mesh->cells.graph, arena, scratch, &refined.base)
        && mark_whole(&mesh->assembly, &mesh->header, &mesh->cells.graph, arena, scratch, 1, &refined.whole)
        && find_frames(&decoder->context, faces, arena, &refined)
        && begin_layer(&mesh->cell_layer, &decoder->context, plan_of_cells(&mesh->header, faces), refined, arena,
            scratch);
    return mesh->has_cell_layer;
}

static bool ensure_layer(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    Refined refined;
    if (mesh->has_layer) return true;
    if (has_base(mesh)
            ? !ensure_cell_layer(decoder) || !close_layer(&mesh->cell_layer, &mesh->arena, &decoder->scratch)
            : !end_blocks(decoder))
        return false;
    LayerPlan plan = plan_of_layer(&mesh->header, const_ints2(mesh->faces));
    mesh->has_layer = blend_beside(decoder, &refined)
        && begin_layer(&mesh->layer, &decoder->context, plan, refined, &mesh->arena, &decoder->scratch);
    return mesh->has_layer;
}

/* Levels of cells; the last ones give the whole shape. */
static bool accept_cell_levels(bsmdec *decoder, const Packet *packet) {
    Mesh *mesh = &decoder->mesh;
    Layer *layer = &mesh->cell_layer;
    if (!ensure_cell_layer(decoder)) return false;
    if (!decode_layer(layer, packet->first, packet->count, packet->data, &decoder->scratch)) {
        layer->lossy = true;
        return tolerate_error(decoder, -1, true);
    }
    return layer->coded < mesh->header.base.cells
        || (ensure_layer(decoder) && emit_event(decoder, BSMDEC_REFINEMENT, 0, 0));
}

static bool accept_refinement(bsmdec *decoder, const Packet *packet) {
    Mesh *mesh = &decoder->mesh;
    if (ends_with_blocks(decoder)) return end_with_blocks(decoder);
    int64_t first = packet->first - mesh->header.base.cells;
    if (first < 0) return accept_cell_levels(decoder, packet);
    if (!ensure_layer(decoder)) return false;
    if (decode_layer(&mesh->layer, first, packet->count, packet->data, &decoder->scratch))
        return emit_event(decoder, BSMDEC_REFINEMENT, first + packet->count, 0);
    mesh->layer.lossy = true;
    return tolerate_error(decoder, -1, true);
}

static bool accept_attribute(bsmdec *decoder, const Packet *packet) {
    Mesh *mesh = &decoder->mesh;
    if (!mesh->has_attributes)
        begin_attributes(&mesh->attributes, &decoder->context, &mesh->header, const_ints2(mesh->faces), &mesh->arena);
    mesh->has_attributes = true;
    if (mesh->has_grid && !mesh->attributes.has_corners) {
        mesh->attributes.corners = mesh->grid.corners;
        mesh->attributes.has_corners = true;
    }
    if (!declare_attribute(&mesh->attributes, packet->index, packet->declaration, packet->data, &decoder->scratch))
        return tolerate_error(decoder, -1, true);
    return decoder->tolerant || check_rows(&mesh->attributes, packet->index, &mesh->numbering);
}

/* All positions are there, or known to be lost. */
static bool ensure_values(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    if (mesh->values_begun) return true;
    if (mesh->header.on_grid ? !ensure_grid(decoder) : !build(decoder) || !skip_to(decoder, mesh->header.blocks))
        return false;
    mesh->values_begun = true;
    return begin_values(&mesh->attributes, &mesh->numbering);
}

static bool accept_values(bsmdec *decoder, const Packet *packet) {
    Mesh *mesh = &decoder->mesh;
    ConstInts2 places = {NULL, 0, 3};
    if (!mesh->has_attributes) return FAIL(&decoder->context, CORRUPT, "attribute # is not declared", packet->index);
    if (!ensure_values(decoder)) return false;
    if (mesh->has_grid && !mesh->grid.broken && mesh->grid.coded == mesh->header.vertices)
        places = const_ints2(mesh->grid.values);
    if (!decode_values(&mesh->attributes, packet, places, &decoder->scratch))
        return tolerate_error(decoder, -1, mesh->header.gop_frames == 0);
    return emit_event(decoder, mesh->attributes.list[packet->index]->whole ? BSMDEC_ATTRIBUTE : BSMDEC_VALUES,
        packet->index, 0);
}

/* Positions as the encoder had them, in whatever unit, if they are there; no rows otherwise. */
static bool find_solid(bsmdec *decoder, ConstDoubles2 *solid) {
    Mesh *mesh = &decoder->mesh;
    Doubles2 positions = {NULL, 0, 3};
    if (mesh->has_grid) {
        if (!mesh->grid.broken && mesh->grid.coded == mesh->header.vertices) positions = mesh->grid.positions;
    } else if (!mesh->assembly.lossy && mesh->has_layer) {
        if (!mesh->layer.lossy) positions = mesh->layer.positions;
    } else if (!mesh->assembly.lossy && !mesh->cell_layer.lossy
        && !place_base(decoder, &decoder->shown, &positions)) {
        return false;
    }
    *solid = const_doubles2(positions);
    return true;
}

/* Attributes that follow from positions, where these are there. */
static bool finish_attributes(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    ConstDoubles2 solid = {NULL, 0, 3};
    if (!mesh->has_attributes) return true;
    if (!ensure_values(decoder)) return false;
    for (int k = 0; k < MOST_ATTRIBUTES; k++) {
        Attribute *attribute = mesh->attributes.list[k];
        if (attribute == NULL || attribute->declaration.coding != RECOMPUTED) continue;
        if (solid.rows == 0 && !find_solid(decoder, &solid)) return false;
        if (solid.rows > 0
            && (!recompute(attribute, solid, &decoder->scratch) || !emit_event(decoder, BSMDEC_ATTRIBUTE, k, 0)))
            return false;
    }
    return true;
}

bool accept_section(bsmdec *decoder, const Packet *packet) {
    Context *context = &decoder->context;
    Mesh *mesh = &decoder->mesh;
    if (is_too_late(mesh, packet->type))
        return FAIL(context, CORRUPT, "unexpected section type #", packet->type);
    switch (packet->type) {
        case HEADER_FRAME:
            begin_mesh(decoder, packet->header);
            return emit_event(decoder, BSMDEC_HEADER, 0, 0);
        case METADATA_FRAME: return emit_event(decoder, BSMDEC_METADATA, decoder->reader.metadata.count, 0);
        case CONNECTIVITY_FRAME: return accept_connectivity(decoder, packet->data);
        case PARTITION_FRAME: return accept_partition(decoder, packet->data);
        case ORDER_FRAME:
            return decode_order(context, packet->data, const_ints2(mesh->faces), &mesh->header, &mesh->arena,
                &decoder->scratch, &mesh->numbering);
        case BLOCK_FRAME: return accept_block(decoder, packet);
        case GRID_FRAME: return accept_grid(decoder, packet);
        case REFINEMENT_FRAME: return accept_refinement(decoder, packet);
        case ATTRIBUTE_FRAME: return accept_attribute(decoder, packet);
        case VALUES_FRAME: return accept_values(decoder, packet);
        case END_FRAME: return finish_mesh(decoder);
        default: return FAIL(context, UNSUPPORTED, "sections of type # are unknown to this decoder", packet->type);
    }
}

bool accept_damage_in_mesh(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    FrameType type = decoder->reader.damage.type;
    bool started = mesh->has_chains || mesh->has_grid;
    bool tolerable = started || (mesh->has_faces && (type == BLOCK_FRAME || type == ATTRIBUTE_FRAME));
    if (mesh->has_grid) mesh->grid.broken = true;
    if (mesh->has_layer && !mesh->values_begun && type != VALUES_FRAME) mesh->layer.lossy = true;
    if (mesh->has_cell_layer && !mesh->has_layer && type != VALUES_FRAME) mesh->cell_layer.lossy = true;
    return tolerable && tolerate_error(decoder, -1, true);
}

/* All positions, in the unit of the mesh. */
static bool finish_positions(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    Doubles2 positions;
    if (mesh->has_grid) {
        decoder->positions = const_doubles2(mesh->grid.positions);
        return true;
    }
    if (mesh->has_layer) {
        if (!take_doubles2(&decoder->shown, mesh->graph.size, 3, &positions)) return false;
        memcpy(positions.data, mesh->layer.positions.data, (size_t)(3 * mesh->graph.size) * sizeof(double));
    } else if (!place_base(decoder, &decoder->shown, &positions)) {
        return false;
    }
    decoder->positions = const_doubles2(positions);
    if (!into_unit(&decoder->context, &mesh->header, positions)) return false;
    for (int64_t v = 0; v < positions.rows; v++)
        for (int d = 0; d < 3 && !is_placed(mesh, v); d++)
            positions.data[3 * v + d] = __builtin_nan("");
    return true;
}

bool look_at_positions(bsmdec *decoder) {
    const Mesh *mesh = &decoder->mesh;
    if (decoder->ended || decoder->sequence.active || !(mesh->has_grid || mesh->has_chains)) return false;
    release_all(&decoder->shown);
    return finish_positions(decoder);
}

bool check_sum(bsmdec *decoder, uint32_t found) {
    if (!decoder->has_checksum || found == decoder->expected_sum) return true;
    FAIL(&decoder->context, CORRUPT,
        "the checksum of decoded positions is wrong: they are not those that the encoder saw");
    return tolerate_error(decoder, -1, true);
}

/* Whether nothing of the positions is lost. */
static bool is_whole(const Mesh *mesh) {
    if (mesh->has_grid) return !mesh->grid.broken && mesh->grid.coded == mesh->header.vertices;
    return !mesh->assembly.lossy && !mesh->cell_layer.lossy && !(mesh->has_layer && mesh->layer.lossy);
}

bool finish_mesh(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    if (!decoder->has_mesh || !mesh->has_faces)
        return FAIL(&decoder->context, CORRUPT, "the stream ends before its first block");
    if (mesh->header.on_grid ? !ensure_grid(decoder) : !build(decoder) || !skip_to(decoder, mesh->header.blocks))
        return false;
    if (!finish_attributes(decoder) || !finish_positions(decoder)) return false;
    if (decoder->has_checksum && is_whole(mesh)
        && !check_sum(decoder, crc32_of_positions(&decoder->reader.sums, decoder->positions, 0)))
        return false;
    decoder->has_positions = decoder->ended = true;
    return emit_event(decoder, BSMDEC_END, 0, 0);
}
