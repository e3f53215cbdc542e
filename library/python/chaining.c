#include "library/python/chaining.h"

#include "bitstream/payloads/payloads.h"
#include "codec/signal/signal.h"
#include "codec/signal/decoding.h"
#include "codec/sequence/gops.h"
#include "library/writing.h"

struct CodedChain {
    PayloadWriter *writer;
    Header header;
    Graph graph;
    Blocks blocks;
    Chains chains;
    Suspended block;
    CodedBlock shown;
    int64_t index;
    Singles2 dictionary;
    Gops gops;
};

CodedChain *open_chain(PayloadWriter *writer) {
    CodedChain *chain;
    if (!TAKE_ZEROS(&writer->arena, 1, chain)) return NULL;
    chain->writer = writer;
    return chain;
}

void close_chain(CodedChain *chain) {
    end_gops(&chain->gops);
    if (chain->blocks.count > 0) end_chains(&chain->chains);
}

const CodedBlock *present_block(const CodedChain *chain) { return &chain->shown; }
ConstSingles2 present_dictionary(const CodedChain *chain) { return const_singles2(chain->dictionary); }

bool are_below(const int32_t *numbers, int64_t count, int64_t least, int64_t bound) {
    for (int64_t i = 0; i < count; i++)
        if (numbers[i] < least || numbers[i] >= bound) return false;
    return true;
}

bool are_all_there(PayloadWriter *writer, const int32_t *numbers, int64_t count, int64_t bound) {
    Bytes there;
    int64_t missing = bound;
    if (!zero_bytes(&writer->scratch, bound, &there)) return false;
    for (int64_t i = 0; i < count; i++)
        if (numbers[i] >= 0 && !there.data[numbers[i]]) there.data[numbers[i]] = 1, missing--;
    return missing == 0;
}

bool begin_graph(CodedChain *chain, ConstInts offsets, ConstInts neighbors) {
    int64_t n = offsets.size - 1;
    bool fits = n > 0 && offsets.data[0] == 0 && offsets.data[n] == neighbors.size;
    for (int64_t v = 0; fits && v < n; v++) fits = offsets.data[v] <= offsets.data[v + 1];
    chain->graph = (Graph){n, offsets, neighbors};
    return (fits && are_below(neighbors.data, neighbors.size, 0, n))
        || FAIL(&chain->writer->context, MISUSED, "the offsets and neighbors do not form a graph");
}

bool label_graph(CodedChain *chain, int64_t parts, Ints labels) {
    return derive_labels(&chain->writer->context, &chain->graph, parts, &chain->writer->scratch, labels);
}

static bool are_labels(CodedChain *chain, ConstInts labels, int64_t parts) {
    return (labels.size == chain->graph.size && parts > 0 && parts <= labels.size
               && are_below(labels.data, labels.size, 0, parts)
               && are_all_there(chain->writer, labels.data, labels.size, parts))
        || FAIL(&chain->writer->context, MISUSED, "labels do not fit the graph, or a part is empty");
}

bool write_labels(CodedChain *chain, ConstInts labels, int64_t parts, Payload *writing) {
    Context *context = &chain->writer->context;
    const Graph *graph = &chain->graph;
    Ints own;
    if (!are_labels(chain, labels, parts) || !take_ints(&chain->writer->scratch, labels.size, &own)) return false;
    memcpy(own.data, labels.data, (size_t)labels.size * sizeof *own.data);
    context->writing = writing;
    bool done =
        code_partition(context, (Span){0}, graph->offsets, graph->neighbors, parts, &chain->writer->scratch, own);
    context->writing = NULL;
    return done;
}

bool grow_parts(CodedChain *chain, ConstInts labels, int64_t parts, int64_t size, GrownBlocks *grown) {
    PayloadWriter *writer = chain->writer;
    Blocks blocks;
    Header header = {.blocks = parts, .block_size = size};
    if (!are_labels(chain, labels, parts)
        || !make_blocks(&writer->context, &header, &chain->graph, (Ints){(int32_t *)labels.data, labels.size},
            &writer->arena, &writer->scratch, &blocks))
        return false;
    *grown = (GrownBlocks){const_ints(blocks.cores), const_ints(blocks.members),
        {blocks.starts.data, blocks.starts.size}, {blocks.edges.data, blocks.edges.size}};
    return true;
}

bool cell_graph(CodedChain *chain, ConstInts2 faces, int64_t reach, GraphCells *cells) {
    PayloadWriter *writer = chain->writer;
    CellMesh found;
    Coarse base = {.reach = (int)reach};
    if (faces.columns != 3 || reach < 0 || reach > 8
        || !are_below(faces.data, 3 * faces.rows, 0, chain->graph.size))
        return FAIL(&writer->context, MISUSED, "faces do not fit the graph, or cells are too large");
    if (!make_cells(&writer->context, &base, &chain->graph, faces, &writer->arena, &writer->scratch, &found))
        return false;
    *cells = (GraphCells){found.own, found.graph.offsets, found.graph.neighbors, const_ints2(found.faces)};
    return true;
}

bool order_rows(CodedChain *chain, ConstInts members) {
    Patch patch;
    if (members.size < 1 || !are_below(members.data, members.size, 0, chain->graph.size))
        return FAIL(&chain->writer->context, MISUSED, "members of a block do not fit the graph");
    if (!order_patch(&chain->graph, members, &chain->writer->scratch, &patch)) return false;
    chain->shown = (CodedBlock){.vertices = patch.vertices, .offsets = patch.offsets, .neighbors = patch.neighbors};
    return true;
}

bool begin_coded_chain(CodedChain *chain, ChainRules rules, ConstInts cores, ConstLongs starts, ConstLongs edges,
    ConstInts members) {
    Context *context = &chain->writer->context;
    int64_t count = starts.size - 1;
    bool fits = count > 0 && edges.size == count && cores.size == count && starts.data[0] == 0
        && starts.data[count] == members.size && rules.power >= 0 && rules.iterations >= 0 && rules.key_iterations >= 0
        && rules.apart >= 0 && rules.key_interval >= 0 && rules.width >= 0;
    for (int64_t i = 0; fits && i < count; i++)
        fits = cores.data[i] > 0 && starts.data[i] + cores.data[i] <= starts.data[i + 1];
    if (!fits || !are_below(members.data, members.size, 0, chain->graph.size))
        return FAIL(context, MISUSED, "blocks do not fit their graph");
    /* Only read. */
    chain->blocks = (Blocks){.count = count, .cores = {(int32_t *)cores.data, count},
        .starts = {(int64_t *)starts.data, count + 1}, .edges = {(int64_t *)edges.data, count},
        .members = {(int32_t *)members.data, members.size}};
    chain->header = (Header){.blocks = count, .key_interval = rules.key_interval, .onorm = rules.apart,
        .coefficients = largest(rules.whole, rules.width), .gop_frames = rules.whole > 0,
        .paper = {.exact = rules.exact, .power = rules.power, .iterations = rules.iterations,
            .key_iterations = rules.key_iterations, .springs = rules.springs, .shift = rules.shift}};
    return begin_chains(&chain->chains, context, &chain->header, &chain->graph, &chain->blocks, &chain->writer->arena);
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
    const Suspended *block = &chain->block;
    if (!hang_block(chains, index, &chain->writer->scratch, &chain->block)) return false;
    chain->shown = (CodedBlock){block->patch.vertices, block->patch.offsets, block->patch.neighbors,
        const_doubles(block->springs), const_doubles(block->weights), const_doubles2(block->pulls),
        const_doubles2(block->continued)};
    return true;
}

BlockCosts costs_of_block(const CodedChain *chain, int64_t width) {
    const Patch *patch = &chain->block.patch;
    double rows = (double)patch->size, edges = (double)chain->blocks.edges.data[chain->index];
    bool follows = chain->chains.subspace.rows == patch->size;
    return (BlockCosts){work_of_dictionary(&chain->header, patch, follows, width),
        block_work(rows, edges, 3.0 * (double)width) + ground_work(&patch->fronts, width),
        patch_memory(&patch->fronts, width)};
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

bool write_coded_block(CodedChain *chain, ConstDoubles2 prediction, ConstDoubles2 coefficients, double step, bool all,
    Payload *writing, int64_t *rows, Doubles2 positions) {
    Context *context = &chain->writer->context;
    Arena *scratch = &chain->writer->scratch;
    ConstSingles2 dictionary = const_singles2(chain->dictionary);
    if (!(step > 0.0) || coefficients.rows < 1 || coefficients.rows > dictionary.columns || coefficients.columns != 3
        || prediction.rows != dictionary.rows || prediction.columns != 3)
        return FAIL(context, MISUSED, "# coefficients do not fit the block", coefficients.rows);
    chain->header.step = step;
    context->writing = writing;
    Mark mark = mark_of(scratch);
    bool done = write_levels(&chain->chains, prediction, dictionary, coefficients, all, scratch, rows, positions);
    context->writing = NULL;
    release_to(scratch, mark);
    return done;
}

bool commit_coded_block(CodedChain *chain, int64_t width, ConstDoubles2 positions) {
    Singles2 all = chain->dictionary;
    if (width > all.columns || positions.rows != all.rows || positions.columns != 3)
        return FAIL(&chain->writer->context, MISUSED, "positions or columns do not fit the block");
    commit_block(&chain->chains, first_columns(all, width),
        &(DecodedBlock){chain->index, chain->shown.vertices, positions, chain->shown.weights});
    chain->dictionary = (Singles2){NULL, 0, 0};
    chain->chains.next++;
    return true;
}

bool hang_parts(CodedChain *chain, ConstInts2 faces, ConstDoubles2 first_frame, ConstDoubles2 starts, ConstInts widths,
    double *memory) {
    PayloadWriter *writer = chain->writer;
    Arena *scratch = &writer->scratch;
    int64_t n = chain->graph.size, columns = 0;
    MovingAttribute *moving;
    bool fits = first_frame.rows == n && first_frame.columns == 3 && faces.columns == 3 && !chain->gops.begun
        && starts.rows == n && widths.size < MOST_ATTRIBUTES && are_below(faces.data, 3 * faces.rows, 0, n);
    for (int64_t k = 0; k < widths.size; k++) columns += widths.data[k];
    if (!fits || columns != starts.columns)
        return FAIL(&writer->context, MISUSED, "a first frame does not fit the graph");
    if (!TAKE_ZEROS(&writer->arena, widths.size, moving)) return false;
    for (int64_t k = 0, from = 0; k < widths.size; from += widths.data[k++]) {
        moving[k].width = widths.data[k];
        if (!take_doubles2(scratch, n, widths.data[k], &moving[k].start)) return false;
        for (int64_t i = 0; i < n * widths.data[k]; i++)
            moving[k].start.data[i] = starts.data[i / widths.data[k] * columns + from + i % widths.data[k]];
    }
    if (!begin_gops(&chain->gops, &writer->context, &chain->header, &chain->graph, &chain->blocks, faces, first_frame,
            n, moving, (int)widths.size, scratch))
        return false;
    release_all(scratch);
    *memory = chain->gops.memory;
    for (int64_t i = 0; i < chain->gops.parts.count; i++) *memory += chain->gops.parts.part[i].memory;
    return true;
}

bool begin_track(CodedChain *track, const CodedChain *from, int64_t k) {
    PayloadWriter *writer = track->writer;
    if (!from->gops.begun || k < 0 || k >= from->gops.tracks)
        return FAIL(&writer->context, MISUSED, "track # is not there", k);
    return copy_gops(&from->gops, (int)k, &writer->context, &writer->arena, &track->gops);
}

bool write_track_basis(CodedChain *track, ConstInts exponents, ConstDoubles2 spectrum, Payload *writing,
    ConstDoubles2 *basis) {
    PayloadWriter *writer = track->writer;
    int64_t width = track->gops.track->width;
    GopField field = {.width = width, .components = spectrum.columns,
        .exponents = {(int32_t *)exponents.data, exponents.size}}; /* only read */
    Doubles2 found;
    if (spectrum.rows < width || spectrum.rows % width != 0 || exponents.size != spectrum.columns)
        return FAIL(&writer->context, MISUSED, "a basis of # rows for # exponents", spectrum.rows, exponents.size);
    release_all(&writer->scratch);
    bool done = write_basis(&track->gops, field, spectrum.rows / width, spectrum, writing, &writer->scratch, &found);
    if (done) *basis = const_doubles2(found);
    return done;
}

bool write_track(CodedChain *track, int method, int64_t frames, double step, int64_t back, ConstDoubles2 wanted,
    Payload *writing, ConstDoubles2 *field) {
    PayloadWriter *writer = track->writer;
    Gops *gops = &track->gops;
    bool coded = wanted.rows > 0;
    GopField given = {.width = gops->track->width, .components = coded ? wanted.columns : 0, .back = back,
        .step = coded ? step : 0};
    bool fits = frames > 0 && method >= LEARNED && method <= LEARNED_NEXT
        && (!coded || (wanted.rows == gops->parts.graph->size && step > 0
            && (method == LEARNED || method == LEARNED_NEXT || wanted.columns == given.width * frames)));
    if (!fits) return FAIL(&writer->context, MISUSED, "a field of # columns for # frames", wanted.columns, frames);
    release_all(&writer->scratch);
    if (!write_gop(gops, method, frames, given, wanted, writing, &writer->scratch)) return false;
    *field = const_doubles2(gops->field);
    return true;
}

bool iterate_graph(CodedChain *chain, double shift, ConstSingles2 start, int64_t power, int64_t iterations,
    int64_t apart, Singles2 subspace) {
    Context *context = &chain->writer->context;
    Arena *scratch = &chain->writer->scratch;
    const Graph *graph = &chain->graph;
    int64_t n = graph->size;
    Patch patch = {.size = n, .offsets = graph->offsets, .neighbors = graph->neighbors};
    Doubles springs;
    Factor factor;
    if (start.rows != n || start.columns < 1 || power < 0 || iterations < 0 || apart < 0)
        return FAIL(context, MISUSED, "# rows of a start for # of a graph", start.rows, n);
    release_all(scratch);
    if (!zero_doubles(scratch, n, &springs) || !take_doubles(scratch, n, &patch.diagonal)) return false;
    for (int64_t r = 0; r < n; r++) patch.diagonal.data[r] = graph->offsets.data[r + 1] - graph->offsets.data[r];
    return find_patch_fronts(context, scratch, &patch)
        && factorize_patch(&patch, const_doubles(springs), shift, scratch, &factor)
        && iterate_columns(context, &patch, &factor, (Singles2){(float *)start.data, n, start.columns},
            (Schedule){power, iterations, n, apart}, scratch, subspace);
}

double memory_for_gop(const CodedChain *chain, int method, int64_t frames, ConstLongs2 fields) {
    const Parts *parts = &chain->gops.parts;
    GopField field[MOST_ATTRIBUTES + 1] = {{0}};
    Gop gop = {.method = method, .frames = frames, .count = (int)fields.rows, .field = field};
    if (fields.columns != 2 || fields.rows > MOST_ATTRIBUTES + 1 || !chain->gops.begun) return -1.0;
    for (int k = 0; k < gop.count; k++) {
        field[k].width = fields.data[2 * k];
        field[k].components = fields.data[2 * k + 1];
    }
    return gop_memory(chain->graph.size, &gop, parts->around) + memory_in_use(parts, &gop) + parts->making
        + SPARE_MEMORY;
}
