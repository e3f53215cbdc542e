#include "library/python/chaining.h"

#include "codec/signal/signal.h"
#include "codec/signal/chain.h"
#include "codec/sequence/gop.h"
#include "library/writing.h"

struct CodedChain {
    Writer *writer;
    Header header;
    Graph graph;
    Blocks blocks;
    Chains chains;
    Suspended block;
    CodedBlock shown;
    int64_t index;
    Singles2 dictionary;
    Parts parts;
    const Site *site;
    CodedPart part;
};

CodedChain *open_chain(Writer *writer) {
    CodedChain *chain;
    if (!TAKE_ZEROS(&writer->arena, 1, chain)) return NULL;
    chain->writer = writer;
    return chain;
}

void close_chain(CodedChain *chain) {
    if (chain->blocks.count > 0) end_chains(&chain->chains);
}

const CodedBlock *present_block(const CodedChain *chain) { return &chain->shown; }
ConstSingles2 present_dictionary(const CodedChain *chain) { return const_singles2(chain->dictionary); }

bool are_below(const int32_t *numbers, int64_t count, int64_t least, int64_t bound) {
    for (int64_t i = 0; i < count; i++)
        if (numbers[i] < least || numbers[i] >= bound) return false;
    return true;
}

bool are_all_there(Writer *writer, const int32_t *numbers, int64_t count, int64_t bound) {
    Bytes there;
    int64_t missing = bound;
    if (!zero_bytes(&writer->scratch, bound, &there)) return false;
    for (int64_t i = 0; i < count; i++)
        if (numbers[i] >= 0 && !there.data[numbers[i]]) there.data[numbers[i]] = 1, missing--;
    return missing == 0;
}

static bool is_graph(ConstInts offsets, ConstInts neighbors) {
    int64_t n = offsets.size - 1;
    bool fits = n > 0 && offsets.data[0] == 0 && offsets.data[n] == neighbors.size;
    for (int64_t v = 0; fits && v < n; v++) fits = offsets.data[v] <= offsets.data[v + 1];
    return fits && are_below(neighbors.data, neighbors.size, 0, n);
}

static bool take_graph(CodedChain *chain, ConstInts offsets, ConstInts neighbors) {
    chain->graph = (Graph){offsets.size - 1, offsets, neighbors};
    return is_graph(offsets, neighbors)
        || FAIL(&chain->writer->context, MISUSED, "the offsets and neighbors do not form a graph");
}

bool label_graph(CodedChain *chain, ConstInts offsets, ConstInts neighbors, int64_t parts, Ints labels) {
    Writer *writer = chain->writer;
    return take_graph(chain, offsets, neighbors)
        && derive_labels(&writer->context, &chain->graph, parts, &writer->scratch, labels);
}

bool grow_parts(CodedChain *chain, ConstInts offsets, ConstInts neighbors, ConstInts labels, int64_t parts,
    int64_t size, GrownBlocks *grown) {
    Writer *writer = chain->writer;
    Blocks blocks;
    Header header = {.blocks = parts, .block_size = size};
    if (!take_graph(chain, offsets, neighbors)) return false;
    bool fits = labels.size == chain->graph.size && parts > 0 && parts <= labels.size && size > 0
        && are_below(labels.data, labels.size, 0, parts)
        && are_all_there(writer, labels.data, labels.size, parts);
    if (!fits) return FAIL(&writer->context, MISUSED, "labels do not fit the graph, or a part is empty");
    if (!make_blocks(&writer->context, &header, &chain->graph, (Ints){(int32_t *)labels.data, labels.size},
            &writer->arena, &writer->scratch, &blocks))
        return false;
    *grown = (GrownBlocks){const_ints(blocks.cores), const_ints(blocks.members),
        {blocks.starts.data, blocks.starts.size}, {blocks.edges.data, blocks.edges.size}};
    return true;
}

bool order_rows(CodedChain *chain, ConstInts offsets, ConstInts neighbors, ConstInts members) {
    Patch patch;
    if (!take_graph(chain, offsets, neighbors)) return false;
    if (members.size < 1 || !are_below(members.data, members.size, 0, chain->graph.size))
        return FAIL(&chain->writer->context, MISUSED, "members of a block do not fit the graph");
    if (!order_patch(&chain->graph, members, &chain->writer->scratch, &patch)) return false;
    chain->shown = (CodedBlock){.vertices = patch.vertices, .offsets = patch.offsets, .neighbors = patch.neighbors};
    return true;
}

bool begin_coded_chain(CodedChain *chain, ChainRules rules, ConstInts offsets, ConstInts neighbors, ConstInts cores,
    ConstLongs starts, ConstLongs edges, ConstInts members) {
    Context *context = &chain->writer->context;
    int64_t count = starts.size - 1, n = offsets.size - 1;
    bool fits = is_graph(offsets, neighbors) && count > 0 && edges.size == count
        && cores.size == count && starts.data[0] == 0
        && starts.data[count] == members.size && rules.power >= 0 && rules.iterations >= 0 && rules.key_iterations >= 0
        && rules.apart >= 0 && rules.key_interval >= 0;
    for (int64_t i = 0; fits && i < count; i++)
        fits = cores.data[i] > 0 && starts.data[i] + cores.data[i] <= starts.data[i + 1];
    if (!fits || !are_below(members.data, members.size, 0, n))
        return FAIL(context, MISUSED, "blocks do not fit their graph");
    chain->graph = (Graph){n, offsets, neighbors};
    /* Only read. */
    chain->blocks = (Blocks){.count = count, .cores = {(int32_t *)cores.data, count},
        .starts = {(int64_t *)starts.data, count + 1}, .edges = {(int64_t *)edges.data, count},
        .members = {(int32_t *)members.data, members.size}};
    chain->header = (Header){.blocks = count, .key_interval = rules.key_interval, .onorm = rules.apart,
        .coefficients = rules.whole, .gop_frames = rules.whole > 0,
        .paper = {.exact = rules.exact, .power = rules.power, .iterations = rules.iterations,
            .key_iterations = rules.key_iterations, .springs = rules.springs, .shift = rules.shift}};
    return begin_chains(&chain->chains, context, &chain->header, &chain->graph, &chain->blocks, &chain->writer->arena);
}

/* Patches of encoders, whose weights are all 1. */
static bool hang_block(CodedChain *chain) {
    Context *context = &chain->writer->context;
    const Patch *patch = &chain->block.patch;
    Doubles weights;
    if (!find_patch_fronts(context, &chain->writer->scratch, &chain->block.patch)
        || !suspend_block(&chain->chains, &chain->writer->scratch, &chain->block)
        || !take_doubles(&chain->writer->scratch, patch->size, &weights))
        return false;
    weigh_rows(patch, weights);
    chain->shown = (CodedBlock){patch->vertices, patch->offsets, patch->neighbors, const_doubles(chain->block.springs),
        const_doubles(weights), const_doubles2(chain->block.pulls), const_doubles2(chain->block.continued)};
    return true;
}

bool begin_coded_block(CodedChain *chain, int64_t index) {
    Context *context = &chain->writer->context;
    Chains *chains = &chain->chains;
    if (failed(context)) return false;
    if (index < 0 || index >= chain->blocks.count) return FAIL(context, MISUSED, "block # is not there", index);
    int64_t number = index / chain_length(&chain->header);
    if (number != chains->number && !begin_chain(chains, number)) return false;
    if (index != chains->next) return FAIL(context, MISUSED, "block # is not the next one", index);
    release_all(&chain->writer->scratch);
    chain->dictionary = (Singles2){NULL, 0, 0};
    chain->shown = (CodedBlock){.vertices = {NULL, 0}};
    chain->index = index;
    return order_patch(&chain->graph, members_of(&chain->blocks, index, size_of_block(&chain->blocks, index)),
               &chain->writer->scratch, &chain->block.patch)
        && hang_block(chain);
}

double dictionary_work_of(const CodedChain *chain, int64_t width) {
    const Patch *patch = &chain->block.patch;
    return work_of_dictionary(&chain->header, patch, chain->chains.subspace.rows == patch->size, width);
}

double block_work_of(const CodedChain *chain, int64_t width) {
    double rows = (double)chain->block.patch.size, edges = (double)chain->blocks.edges.data[chain->index];
    return block_work(rows, edges, 3.0 * (double)width) + ground_work(&chain->block.patch.fronts, width);
}

double block_memory_of(const CodedChain *chain, int64_t width) {
    return patch_memory(&chain->block.patch.fronts, width);
}

static Arena *room_for_dictionary(CodedChain *chain) {
    Arena *arena = &chain->chains.subspaces[!chain->chains.present];
    release_all(arena);
    chain->dictionary = (Singles2){NULL, 0, 0};
    return arena;
}

bool make_coded_dictionary(CodedChain *chain, int64_t width) {
    Context *context = &chain->writer->context;
    Arena *scratch = &chain->writer->scratch;
    int64_t rows = chain->block.patch.size;
    if (failed(context)) return false;
    if (width < 1 || chain->shown.vertices.size < 1)
        return FAIL(context, MISUSED, "# columns for a block of # rows", width, chain->shown.vertices.size);
    room_for_dictionary(chain);
    Mark mark = mark_of(scratch);
    bool made = make_dictionary(&chain->chains, &chain->block, least(width, rows), scratch, &chain->dictionary);
    release_to(scratch, mark);
    return made;
}

bool give_dictionary(CodedChain *chain, ConstSingles2 own) {
    Context *context = &chain->writer->context;
    if (own.rows < 1 || own.rows != chain->shown.vertices.size || own.columns > own.rows)
        return FAIL(context, MISUSED, "a dictionary of # rows for #", own.rows, chain->shown.vertices.size);
    Arena *arena = room_for_dictionary(chain);
    if (!take_singles2(arena, own.rows, own.columns, &chain->dictionary)) return false;
    memcpy(chain->dictionary.data, own.data, (size_t)(own.rows * own.columns) * sizeof *own.data);
    return true;
}

bool commit_coded_block(CodedChain *chain, int64_t width, ConstDoubles2 positions) {
    Singles2 all = chain->dictionary, first = {all.data, all.rows, width};
    if (width > all.columns || positions.rows != all.rows || positions.columns != 3)
        return FAIL(&chain->writer->context, MISUSED, "positions or columns do not fit the block");
    for (int64_t r = 1; width < all.columns && r < all.rows; r++)
        memmove(first.data + r * width, all.data + r * all.columns, (size_t)width * sizeof *all.data);
    commit_block(&chain->chains, first,
        &(DecodedBlock){chain->index, chain->shown.vertices, positions, chain->shown.weights});
    chain->dictionary = (Singles2){NULL, 0, 0};
    chain->chains.next++;
    return true;
}

bool hang_parts(CodedChain *chain, ConstInts2 faces, ConstDoubles2 first_frame) {
    Writer *writer = chain->writer;
    bool fits = first_frame.rows == chain->graph.size && first_frame.columns == 3 && faces.columns == 3
        && are_below(faces.data, 3 * faces.rows, 0, first_frame.rows);
    if (!fits) return FAIL(&writer->context, MISUSED, "the first frame does not fit the graph");
    chain->parts = (Parts){.context = &writer->context, .header = &chain->header, .graph = &chain->graph,
        .blocks = &chain->blocks, .arena = &writer->arena};
    return find_parts(&chain->parts, faces, first_frame, &writer->scratch);
}

bool begin_coded_part(CodedChain *part, const CodedChain *whole, int64_t index) {
    Writer *writer = part->writer;
    if (index < 0 || index >= whole->parts.count) return FAIL(&writer->context, MISUSED, "part # is not there", index);
    const Site *site = part->site = whole->parts.part + index;
    part->part = (CodedPart){site->patch.vertices, const_ints(site->around), site->width, site->memory, site->making};
    bool made = key_dictionary(&writer->context, &whole->header, &site->patch, const_doubles(site->springs), NULL,
        site->width, &writer->arena, &writer->scratch, &part->dictionary);
    release_all(&writer->scratch);
    return made;
}

const CodedPart *present_part(const CodedChain *part) { return &part->part; }

static bool extend(CodedChain *part, ConstDoubles2 ends, int64_t columns, Doubles2 *extension) {
    Writer *writer = part->writer;
    if (failed(&writer->context)) return false;
    if (ends.rows != part->site->around.size || ends.columns != columns)
        return FAIL(&writer->context, MISUSED, "values around a part do not fit it");
    release_all(&writer->scratch);
    return take_doubles2(&writer->scratch, part->site->patch.size, columns, extension)
        && extend_part(part->site, ends, &writer->scratch, *extension);
}

bool part_coefficients(CodedChain *part, ConstDoubles2 values, ConstDoubles2 ends, Doubles2 coefficients) {
    Doubles2 rest;
    if (values.rows != part->site->patch.size || coefficients.rows != part->dictionary.columns
        || coefficients.columns != values.columns)
        return FAIL(&part->writer->context, MISUSED, "values do not fit the rows of a part");
    if (!extend(part, ends, values.columns, &rest)) return false;
    for (int64_t i = 0; i < values.rows * values.columns; i++) rest.data[i] = values.data[i] - rest.data[i];
    project(const_singles2(part->dictionary), const_doubles2(rest), coefficients);
    return true;
}

bool part_values(CodedChain *part, ConstDoubles2 coefficients, ConstDoubles2 ends, Doubles2 values) {
    Doubles2 extension;
    if (coefficients.rows != part->dictionary.columns || values.rows != part->site->patch.size
        || coefficients.columns != values.columns)
        return FAIL(&part->writer->context, MISUSED, "coefficients do not fit the columns of a part");
    if (!extend(part, ends, values.columns, &extension)) return false;
    reconstruct(const_singles2(part->dictionary), coefficients, values);
    for (int64_t i = 0; i < values.rows * values.columns; i++) values.data[i] += extension.data[i];
    return true;
}

bool begin_solver(CodedChain *chain, ConstInts offsets, ConstInts neighbors, ConstDoubles shift) {
    Context *context = &chain->writer->context;
    Arena *arena = &chain->writer->arena;
    int64_t n = offsets.size - 1;
    Patch *patch = &chain->block.patch;
    if (!take_graph(chain, offsets, neighbors)) return false;
    if (shift.size != n) return FAIL(context, MISUSED, "# shifts for # rows", shift.size, n);
    *patch = (Patch){.size = n, .offsets = offsets, .neighbors = neighbors};
    if (!take_doubles(arena, n, &patch->diagonal)) return false;
    for (int64_t r = 0; r < n; r++) patch->diagonal.data[r] = offsets.data[r + 1] - offsets.data[r];
    return find_patch_fronts(context, arena, patch) && factorize_patch(patch, shift, 0.0, arena, &chain->block.factor);
}

bool solve_iterations(CodedChain *chain, ConstSingles2 start, int64_t power, int64_t iterations, int64_t apart,
    Singles2 subspace) {
    Context *context = &chain->writer->context;
    int64_t n = chain->block.patch.size;
    if (failed(context)) return false;
    if (start.rows != n || subspace.rows != n || subspace.columns > start.columns || start.columns < 1 || power < 0
        || iterations < 0 || apart < 0)
        return FAIL(context, MISUSED, "# rows of a start for # of a graph", start.rows, n);
    release_all(&chain->writer->scratch);
    return iterate_columns(context, &chain->block.patch, &chain->block.factor,
        (Singles2){(float *)start.data, n, start.columns}, (Schedule){power, iterations, n, apart},
        &chain->writer->scratch, subspace);
}

double memory_of_gop(int method, int64_t frames, ConstLongs2 fields, int64_t vertices, double around) {
    GopField field[MOST_ATTRIBUTES + 1] = {{0}};
    Gop gop = {.method = method, .frames = frames, .count = (int)fields.rows, .field = field};
    if (fields.columns != 2 || fields.rows > MOST_ATTRIBUTES + 1 || vertices < 1) return -1.0;
    for (int k = 0; k < gop.count; k++) {
        field[k].width = fields.data[2 * k];
        field[k].components = fields.data[2 * k + 1];
    }
    return gop_memory(vertices, &gop, around);
}
