/* Overlapping blocks in a chain, and the graph of one of them in row order (specification, M 5 and M 6). */
#include "codec/blocks/blocks.h"
#include "codec/geometry/geometry.h"

static const uint32_t FREE = 0xFFFFFFFFu;

/* Breadth-first from each part, neighbors in ascending order, until `size` vertices are found; vertices with more than
 * `size` neighbors are left out. Returns the number of members. `seen` is scratch, one entry a vertex. */
static int64_t grow_blocks(ConstInts offsets, ConstInts neighbors, Partition parts, int64_t size, Ints seen,
    BlockChain blocks) {
    Ints members = blocks.members;
    int64_t count = 0;
    for (int64_t v = 0; v < seen.size; v++) seen.data[v] = -1;
    for (int64_t index = 0; index < blocks.chain.size; index++) {
        int64_t head = count, full = least(count + size, members.size), part = blocks.chain.data[index];
        blocks.starts.data[index] = count;
        for (int64_t i = parts.bounds.data[part]; i < parts.bounds.data[part + 1] && count < members.size; i++) {
            members.data[count++] = parts.order.data[i];
            seen.data[parts.order.data[i]] = (int32_t)index;
        }
        while (head < count && count < full) {
            int32_t v = members.data[head++];
            for (int64_t i = offsets.data[v]; i < offsets.data[v + 1]; i++) {
                int32_t w = neighbors.data[i];
                if (seen.data[w] != index && count < full && offsets.data[w + 1] - offsets.data[w] <= size) {
                    seen.data[w] = (int32_t)index;
                    members.data[count++] = w;
                }
            }
        }
    }
    blocks.starts.data[blocks.chain.size] = count;
    return count;
}

static uint64_t table_size(int64_t rows) {
    uint64_t capacity = 16;
    while (capacity < 4 * (uint64_t)rows) capacity *= 2;
    return capacity;
}

/* Slot of `key` in an open-addressed table of keys. */
INLINE uint64_t slot_of(const uint32_t *table, uint64_t mask, uint32_t key) {
    uint64_t slot = (((uint64_t)key * 2654435761u) >> 7) & mask;
    while (table[slot] != key && table[slot] != FREE) slot = (slot + 1) & mask;
    return slot;
}

/* Words of scratch for `order_block`, by rows and ends of edges. */
int64_t order_scratch(int64_t rows, int64_t edges) {
    return 2 * (int64_t)table_size(rows) + edges + 1 + 4 * rows + 2 + bisection_scratch(rows);
}

/* The graph among the vertices `rows`, with its rows in the order of a full bisection.
 *
 * Returns the ends of edges that there are; where they are more than `local_neighbors` has room for, nothing else has
 * been done. */
int64_t order_block(ConstInts offsets, ConstInts neighbors, ConstInts rows, Ints vertices, Ints local_offsets,
                    Ints local_neighbors, Words scratch) {
    int64_t n = rows.size;
    uint64_t capacity = table_size(n), mask = capacity - 1;
    uint32_t *table = scratch.data, *number = table + capacity;
    int32_t *first_offsets = (int32_t *)(number + capacity), *order = first_offsets + n + 1, *rank = order + n;
    int32_t *bounds = rank + n, *first_neighbors = bounds + n + 1;
    uint32_t *rest = (uint32_t *)(first_neighbors + local_neighbors.size + 1);
    if (scratch.size < order_scratch(n, local_neighbors.size) || vertices.size < n || local_offsets.size < n + 1)
        return -1;
    for (uint64_t k = 0; k < capacity; k++) table[k] = FREE;
    for (int64_t r = 0; r < n; r++) {
        uint64_t slot = slot_of(table, mask, (uint32_t)rows.data[r]);
        table[slot] = (uint32_t)rows.data[r];
        number[slot] = (uint32_t)r;
    }
    int64_t filled = 0, room = local_neighbors.size;
    first_offsets[0] = 0;
    for (int64_t r = 0; r < n; r++) {
        int32_t v = rows.data[r];
        for (int64_t i = offsets.data[v]; i < offsets.data[v + 1]; i++) {
            /* Without a branch, which the processor could not predict: what is not in `rows` is overwritten. */
            uint64_t slot = slot_of(table, mask, (uint32_t)neighbors.data[i]);
            first_neighbors[least(filled, room)] = (int32_t)number[slot];
            filled += table[slot] != FREE;
        }
        first_offsets[r + 1] = (int32_t)filled;
    }
    if (filled > room) return filled;
    Words left = {rest, bisection_scratch(n)};
    if (!bisect((ConstInts){first_offsets, n + 1}, (ConstInts){first_neighbors, filled}, (Ints){order, n},
                (Ints){bounds, n + 1}, left))
        return -1;
    for (int64_t r = 0; r < n; r++) rank[order[r]] = (int32_t)r;
    int64_t end = 0;
    local_offsets.data[0] = 0;
    for (int64_t r = 0; r < n; r++) {
        int32_t source = order[r];
        vertices.data[r] = rows.data[source];
        for (int64_t i = first_offsets[source]; i < first_offsets[source + 1]; i++)
            local_neighbors.data[end++] = rank[first_neighbors[i]];
        local_offsets.data[r + 1] = (int32_t)end;
    }
    return end;
}

/* The chain of parts: from part 0 on, the unvisited neighbor that shares most edges with all parts visited so far;
 * where there is none, the lowest unvisited neighbor of the latest part that has one; else the lowest unvisited.
 *
 * `starts`, `ends`, `edges`: the graph of the parts in compressed rows, with the number of edges between them. The rest
 * is scratch, one entry a part; `seen` holds the first entry of each row when it comes. */
static bool chain_parts(ConstLongs starts, ConstInts ends, ConstLongs edges, Longs shared, Longs seen, Ints trail,
                 Bytes visited, Ints chain) {
    int64_t parts = chain.size, length = 0, lowest = 0;
    if (starts.size != parts + 1 || shared.size < parts || seen.size < parts || trail.size < parts ||
        visited.size < parts || ends.size < starts.data[parts] || edges.size < starts.data[parts])
        return false;
    for (int64_t p = 0; p < parts; p++) {
        shared.data[p] = 0;
        seen.data[p] = starts.data[p];
        visited.data[p] = 0;
    }
    int32_t current = 0;
    for (int64_t step = 0; step < parts; step++) {
        chain.data[step] = current;
        visited.data[current] = 1;
        trail.data[length++] = current;
        int32_t best = -1;
        for (int64_t i = starts.data[current]; i < starts.data[current + 1]; i++) {
            int32_t p = ends.data[i];
            shared.data[p] += edges.data[i];
            if (!visited.data[p] && (best == -1 || shared.data[p] > shared.data[best])) best = p;
        }
        /* The way back: a part leaves it once it has no unvisited neighbors, and is not looked at again. */
        while (best == -1 && length > 0) {
            int32_t last = trail.data[length - 1];
            while (seen.data[last] < starts.data[last + 1] && visited.data[ends.data[seen.data[last]]])
                seen.data[last]++;
            if (seen.data[last] < starts.data[last + 1]) {
                best = ends.data[seen.data[last]];
            } else {
                length--;
            }
        }
        if (best == -1) {
            while (lowest < parts && visited.data[lowest]) lowest++;
            best = (int32_t)lowest;
        }
        current = best;
    }
    return true;
}

/* The graph of the parts, as `chain_parts` takes it: a part's neighbors in ascending order. Vertices before the
 * `first` are in no part; `labels` are those of the others. `counts`, one entry a part, is scratch. False if `links`
 * are too short. */
static bool link_parts(ConstInts offsets, ConstInts neighbors, Partition parts, Longs counts, Longs starts,
    PartLinks links) {
    int64_t found = 0, first = offsets.size - 1 - parts.labels.size;
    int32_t *ends = links.ends.data;
    for (int64_t p = 0; p < counts.size; p++) counts.data[p] = 0;
    for (int64_t p = 0; p < counts.size; p++) {
        starts.data[p] = found;
        for (int64_t k = parts.bounds.data[p]; k < parts.bounds.data[p + 1]; k++) {
            int32_t v = parts.order.data[k];
            for (int64_t i = offsets.data[v]; i < offsets.data[v + 1]; i++) {
                if (neighbors.data[i] < first) continue;
                int32_t other = parts.labels.data[neighbors.data[i] - first];
                if (other == p || counts.data[other]++ > 0) continue;
                if (found == links.ends.size || found == links.edges.size) return false;
                ends[found++] = other;
            }
        }
        sort_ascending(ends + starts.data[p], found - starts.data[p]);
        for (int64_t i = starts.data[p]; i < found; i++) {
            links.edges.data[i] = counts.data[ends[i]];
            counts.data[ends[i]] = 0;
        }
    }
    starts.data[counts.size] = found;
    return true;
}

/* The parts in a chain and grown to blocks: `chain_parts` and `grow_blocks`. `links` have room for each pair of parts
 * that share an edge, `scratch` has seven entries a part. Returns the number of members. */
int64_t chain_blocks(ConstInts offsets, ConstInts neighbors, Partition parts, int64_t size, PartLinks links,
    Longs scratch, Ints seen, BlockChain blocks) {
    int64_t n = offsets.size - 1, count = parts.bounds.size - 1;
    if (!fits_graph(offsets, neighbors) || count < 1 || parts.order.size != parts.labels.size || parts.labels.size > n
        || seen.size != n || scratch.size < 7 * count || blocks.chain.size != count || blocks.starts.size != count + 1
        || blocks.edges.size != count)
        return MISUSED;
    int64_t *room = scratch.data;
    Longs shared = {room, count}, next = {room + count, count}, first = {room + 4 * count, count + 1};
    Ints trail = {(int32_t *)(room + 2 * count), count};
    Bytes visited = {(uint8_t *)(room + 3 * count), count};
    if (!link_parts(offsets, neighbors, parts, shared, first, links)
        || !chain_parts((ConstLongs){first.data, first.size}, (ConstInts){links.ends.data, links.ends.size},
            (ConstLongs){links.edges.data, links.edges.size}, shared, next, trail, visited, blocks.chain))
        return MISUSED;
    int64_t found = grow_blocks(offsets, neighbors, parts, size, seen, blocks);
    for (int64_t p = 0; p < count; p++) {
        blocks.edges.data[p] = 0;
        for (int64_t i = blocks.starts.data[p]; i < blocks.starts.data[p + 1]; i++) {
            int32_t v = blocks.members.data[i];
            blocks.edges.data[p] += offsets.data[v + 1] - offsets.data[v];
        }
    }
    return found;
}

/* Weighted sums over the copies of each vertex (paper, Algorithm 3; specification, M 12). */

/* Add one copy of each of `vertices`, all below `total.size`. */
void add_copies(Doubles2 sums, Doubles total, ConstInts vertices, ConstDoubles2 positions, ConstDoubles weights) {
    int64_t count = least(vertices.size, least(positions.rows, weights.size));
    for (int64_t r = 0; r < count; r++) {
        int64_t v = vertices.data[r];
        double weight = weights.data[r];
        total.data[v] += weight;
        for (int d = 0; d < 3; d++) sums.data[3 * v + d] += weight * positions.data[3 * r + d];
    }
}
