/* Graph, parts and blocks of a mesh, all integers (specification, M 2 to M 6). */
#include "codec/basis/patches.h"

#include "codec/blocks/blocks.h"
#include "codec/geometry/geometry.h"
#include "bitstream/costs.h"

enum { PASSES = 2, CHAIN_NUMBERS = 7, MOST_WORK = 1 << 16, FULL = -1, TOO_MUCH = -2 };

bool make_graph(Ints2 faces, int64_t size, Arena *arena, Arena *scratch, Graph *graph) {
    Mark mark = mark_of(scratch);
    Ints offsets, filled, ends, second, neighbors;
    bool done = take_ints(arena, size + 1, &offsets) && take_ints(scratch, size, &filled)
        && take_ints(scratch, 6 * faces.rows, &ends) && take_ints(scratch, 6 * faces.rows, &second);
    if (done) {
        int64_t kept = collect_edges(const_ints2(faces), offsets, filled, ends, second);
        done = take_ints(arena, kept, &neighbors);
        if (done) memcpy(neighbors.data, ends.data, (size_t)kept * sizeof *ends.data);
        if (done) *graph = (Graph){size, const_ints(offsets), const_ints(neighbors)};
    }
    release_to(scratch, mark);
    return done;
}

static bool find_all_cells(Context *context, const Coarse *base, const Graph *graph, ConstInts2 faces, Arena *arena,
    Arena *scratch, CellMesh *cells) {
    int64_t n = graph->size, ends = graph->neighbors.size;
    Bytes far;
    Ints own, order, bounds, filled, found, links, linked, sorted;
    Ints2 triples, kept;
    if (!take_bytes(scratch, n, &far) || !take_ints(scratch, n, &order) || !take_ints(arena, n, &own)) return false;
    int64_t m = find_cells(graph->offsets, graph->neighbors, base->reach, far, order, own);
    if (base->cells != 0 && m != base->cells)
        return FAIL(context, CORRUPT, "# cells where the header has #", m, base->cells);
    if (!take_ints(scratch, m + 1, &bounds) || !take_ints(scratch, m, &filled) || !take_ints(scratch, ends + 1, &found)
        || !take_ints(arena, m + 1, &links) || !take_ints(scratch, ends + 1, &linked))
        return false;
    int64_t count = link_cells(
        graph->offsets, graph->neighbors, const_ints(own), bounds, order, filled, found, links, linked);
    Ints neighbors;
    if (!take_ints(arena, count, &neighbors) || !take_ints2(scratch, faces.rows, 3, &triples)
        || !take_ints2(scratch, faces.rows, 3, &kept) || !take_ints(scratch, faces.rows, &order)
        || !take_ints(scratch, faces.rows, &sorted))
        return false;
    memcpy(neighbors.data, linked.data, (size_t)count * sizeof *linked.data);
    count = cell_faces(faces, const_ints(own), bounds, triples, order, sorted, kept);
    if (!take_ints2(arena, count, 3, &cells->faces)) return false;
    memcpy(cells->faces.data, kept.data, (size_t)(3 * count) * sizeof *kept.data);
    cells->own = const_ints(own);
    cells->graph = (Graph){m, const_ints(links), const_ints(neighbors)};
    return true;
}

bool make_cells(Context *context, const Coarse *base, const Graph *graph, ConstInts2 faces, Arena *arena,
    Arena *scratch, CellMesh *cells) {
    double n = (double)graph->size, ends = (double)graph->neighbors.size, m = (double)faces.rows;
    if (!reserve(context, cells_memory(n, ends, m, (double)base->cells), 0)
        || !charge(context, cells_work(n, ends, m, base->reach) + base->rounds * prolong_work(n, ends), 0))
        return false;
    Mark mark = mark_of(scratch);
    bool done = find_all_cells(context, base, graph, faces, arena, scratch, cells);
    release_to(scratch, mark);
    return done;
}

bool derive_labels(Context *context, const Graph *graph, int64_t parts, Arena *scratch, Ints labels) {
    Ints order, bounds, votes;
    Words room;
    Longs sizes;
    if (!take_ints(scratch, graph->size, &order) || !take_ints(scratch, parts + 1, &bounds)
        || !take_ints(scratch, parts, &votes) || !take_words(scratch, bisection_scratch(graph->size), &room)
        || !take_longs(scratch, parts, &sizes))
        return false;
    if (!bisect(graph->offsets, graph->neighbors, order, bounds, room))
        return FAIL(context, CORRUPT, "# vertices cannot be cut into # parts", graph->size, parts);
    label_parts(const_ints(order), const_ints(bounds), labels);
    refine_partition(graph->offsets, graph->neighbors, labels, PASSES, sizes, votes);
    return true;
}

static bool grow(Context *context, const Header *header, const Graph *graph, Ints labels, Arena *arena, Arena *scratch,
    Blocks *blocks) {
    int64_t parts = header->blocks, n = graph->size, size = header->block_size;
    Ints bounds, order, seen, chain, members, linked;
    Longs shares, room;
    if (!take_ints(scratch, parts + 1, &bounds) || !take_ints(scratch, n, &order) || !take_ints(scratch, n, &seen)
        || !take_ints(scratch, parts, &chain) || !take_ints(scratch, parts * least(size, n), &members))
        return false;
    group_by_label(const_ints(labels), bounds, order);
    int64_t most = 0;
    for (int64_t p = 0; p < parts; p++) most = largest(most, bounds.data[p + 1] - bounds.data[p]);
    if (most > size) return FAIL(context, CORRUPT, "a part of # vertices in blocks of #", most, size);
    double pairs = (double)parts * (double)(parts - 1);
    int64_t links = pairs < (double)graph->neighbors.size ? parts * (parts - 1) : graph->neighbors.size;
    blocks->count = parts;
    if (!take_ints(scratch, links, &linked) || !take_longs(scratch, links, &shares)
        || !take_longs(scratch, CHAIN_NUMBERS * parts, &room) || !take_ints(arena, parts, &blocks->cores)
        || !take_longs(arena, parts + 1, &blocks->starts) || !take_longs(arena, parts, &blocks->edges))
        return false;
    int64_t count = chain_blocks(graph->offsets, graph->neighbors,
        (Partition){const_ints(order), const_ints(bounds), const_ints(labels)}, size, (PartLinks){linked, shares}, room,
        seen, (BlockChain){chain, blocks->starts, blocks->edges, members});
    if (!take_ints(arena, count, &blocks->members)) return false;
    memcpy(blocks->members.data, members.data, (size_t)count * sizeof *members.data);
    for (int64_t i = 0; i < parts; i++)
        blocks->cores.data[i] = bounds.data[chain.data[i] + 1] - bounds.data[chain.data[i]];
    return true;
}

bool make_blocks(Context *context, const Header *header, const Graph *graph, Ints labels, Arena *arena, Arena *scratch,
    Blocks *blocks) {
    double copies = (double)header->blocks * (double)header->block_size, n = (double)graph->size;
    if (!reserve(context, COPY_MEMORY * copies, 0)
        || !charge(context, partition_work(n, (double)graph->neighbors.size, header->blocks, copies), 0))
        return false;
    Mark mark = mark_of(scratch);
    bool done = labels.size > 0
        || (take_ints(scratch, graph->size, &labels) && derive_labels(context, graph, header->blocks, scratch, labels));
    done = done && grow(context, header, graph, labels, arena, scratch, blocks);
    release_to(scratch, mark);
    return done;
}

bool order_patch(const Graph *graph, ConstInts members, Arena *arena, Patch *patch) {
    int64_t size = members.size, room = 8 * size;
    Ints vertices, offsets, neighbors;
    Words scratch;
    if (!take_ints(arena, size, &vertices) || !take_ints(arena, size + 1, &offsets)) return false;
    for (;;) {
        if (!take_ints(arena, room, &neighbors) || !take_words(arena, order_scratch(size, room), &scratch))
            return false;
        int64_t ends = order_block(graph->offsets, graph->neighbors, members, vertices, offsets, neighbors, scratch);
        if (ends <= room) {
            *patch = (Patch){.size = size, .vertices = const_ints(vertices), .offsets = const_ints(offsets),
                .neighbors = {neighbors.data, ends}};
            break;
        }
        room = ends;
    }
    if (!take_doubles(arena, size, &patch->diagonal)) return false;
    for (int64_t r = 0; r < size; r++) patch->diagonal.data[r] = (double)(offsets.data[r + 1] - offsets.data[r]);
    return true;
}

/* Which rows are eliminated when. */
bool find_patch_fronts(Context *context, Arena *arena, Patch *patch) {
    int64_t n = patch->size, room = 16 * n + 64, count = FULL;
    Words scratch;
    Fronts fronts;
    if (!take_words(arena, n, &fronts.rows) || !take_words(arena, n, &fronts.steps)
        || !take_words(arena, n, &fronts.owners) || !take_words(arena, 3 * n, &scratch)
        || !take_words(arena, n + 1, &fronts.firsts) || !take_words(arena, n + 1, &fronts.starts)
        || !take_words(arena, n + 1, &fronts.places) || !take_doubles(arena, 2, &fronts.sums))
        return false;
    for (; count == FULL; room *= 4) {
        if (!take_words(arena, room, &fronts.borders)) return false;
        count = find_fronts(patch->offsets, patch->neighbors, (double)MOST_WORK * (double)n, scratch, &fronts);
    }
    if (count == TOO_MUCH) return FAIL(context, LIMIT, "the faces of a block of # vertices are too entangled", n);
    fronts.firsts.size = fronts.starts.size = fronts.places.size = count + 1;
    fronts.borders.size = fronts.starts.data[count];
    patch->fronts = fronts;
    return true;
}
