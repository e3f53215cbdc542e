/* Payloads written by the functions that read them: faces, and fields of integers on them. */
#include "library/writing.h"

#include "library/arithmetic.h"
#include "bitstream/payloads/payloads.h"

#ifdef BSMDEC_WRITES

/* A caller writes what it already holds in memory: nothing of it is refused. */
static bsmdec_limits no_limits(void) {
    const double any = 1e300;
    return (bsmdec_limits){
        .size = sizeof(bsmdec_limits), .vertices = any, .faces = any, .blocks = any, .block_size = any,
        .coefficients = any, .frames = any, .gop_frames = any, .frame_bytes = any, .metadata_bytes = any,
        .attributes = any, .attribute_values = any, .sequence_bytes = any, .field_bytes = any, .work = any,
        .work_per_vertex = any, .work_per_byte = any, .most_work = any, .memory = any, .memory_per_vertex = any,
        .memory_per_byte = any, .most_memory = any, .heap = any,
    };
}

void open_writer(PayloadWriter *writer, bsmdec_allocator host) {
    Context *context = &writer->context;
    make_tables();
    memset(writer, 0, sizeof *writer);
    context->host = with_pool(host, &writer->pool);
    context->error.offset = context->error.frame = context->error.block = -1;
    context->limits = no_limits();
    writer->arena = writer->scratch = arena_of(context);
    if (!is_exact())
        FAIL(context, UNSUPPORTED,
            "this build does not round as IEEE 754: compile it without fast or fused arithmetic");
}

void close_writer(PayloadWriter *writer) {
    release_all(&writer->arena);
    release_all(&writer->scratch);
    without_pool(writer->context.host);
}

bool begin_payloads(Context *context, int64_t capacity, Payload *writing) {
    *writing = (Payload){.capacity = capacity};
    return TAKE_OF_HOST(context, capacity, writing->data);
}

void end_payloads(Context *context, Payload *writing) { host_give(context, writing->data, (size_t)writing->capacity); }

static void begin(CodedField *field, Context *context, Source given) {
    memset(field, 0, sizeof *field);
    field->context = context;
    field->arena = field->scratch = field->attributes.coding = field->attributes.recent = arena_of(context);
    field->header = (Header){.vertices = given.rows, .faces = given.faces_count};
    field->faces = (Ints2){(int32_t *)given.faces, given.faces_count, 3}; /* only read */
}

/* Copy values, which are from `low` to those of `largest`. */
static bool fill(Context *context, Ints2 to, Source given, int64_t first, const int32_t *largest, bool both) {
    for (int64_t i = 0; i < to.rows; i++)
        for (int64_t j = 0; j < to.columns; j++) {
            int32_t value = to.data[to.columns * i + j] = given.values[given.columns * i + first + j];
            if (value > largest[j] || value < (both ? -largest[j] : 0))
                return FAIL(context, NUMERIC, "value # of row # is out of its range", value, i);
        }
    return true;
}

bool begin_positions(CodedField *field, const GridField *like, Context *context, Source given,
    const int32_t *largest, int light, const double *origin, double step, const double *exact,
    const int32_t *transforms, int congruence) {
    begin(field, context, given);
    Header *header = &field->header;
    field->kind = ON_GRID;
    *header = (Header){.vertices = given.rows, .faces = given.faces_count, .on_grid = true, .light = light,
        .congruence = congruence, .scale = step};
    memcpy(header->center, origin, sizeof header->center);
    memcpy(header->grid, largest, sizeof header->grid);
    ConstInts2 faces = const_ints2(field->faces);
    if (!begin_grid(&field->grid, like, context, header, faces, &field->arena, &field->scratch)) return false;
    if (exact != NULL) memcpy(field->grid.positions.data, exact, (size_t)(3 * given.rows) * sizeof(double));
    for (int64_t i = 0; i < TRANSFORM_ROW * field->grid.transforms.rows; i++)
        field->grid.transforms.data[i] = transforms[i];
    return fill(context, field->grid.values, given, 0, largest, false);
}

bool begin_refinement(CodedField *field, Context *context, Source given) {
    static const int32_t MOST[] = {1 << 20, 1 << 20, 1 << 20};
    begin(field, context, given);
    field->kind = OF_LEVELS;
    LayerPlan plan = {.faces = const_ints2(field->faces), .vertices = given.rows};
    return begin_levels(&field->layer, context, plan, &field->scratch)
        && fill(context, field->layer.levels.levels, given, 0, MOST, true);
}

bool begin_attribute(CodedField *field, Context *context, Source given, const Declaration *declaration,
    int64_t vertices, const int32_t *at, const int32_t *places, int swift) {
    Attribute *attribute = &field->attribute;
    begin(field, context, given);
    field->kind = OF_VALUES;
    field->header.vertices = vertices;
    field->header.swift = swift;
    begin_attributes(&field->attributes, context, &field->header, const_ints2(field->faces), &field->arena);
    attribute->declaration = *declaration;
    attribute->rows = given.rows;
    attribute->faces = const_ints2(field->faces);
    attribute->vertices = (Ints){(int32_t *)at, given.rows}; /* only read */
    for (int64_t r = 0; r < given.rows && at != NULL; r++)
        if (at[r] >= vertices) return FAIL(context, NUMERIC, "row # is at vertex # of #", r, at[r], vertices);
    ConstInts2 known = {places, places != NULL ? vertices : 0, 3};
    if (!start_attribute(&field->attributes, attribute, known, &field->scratch)) return false;
    for (int g = 0; g < attribute->groups; g++) {
        Group *group = &attribute->group[g];
        bool of_faces = declaration->domain == BSMDEC_FACE;
        const int32_t *largest = (of_faces ? group->face_values.largest : swift > 0 ? group->swift.own.largest
                                       : group->values.largest).data;
        if (!fill(context, group->pieces, given, MOST_COMPONENTS * g, largest, false)) return false;
    }
    return true;
}

void end_field(CodedField *field) {
    end_layer(&field->layer);
    end_attributes(&field->attributes);
    release_all(&field->arena);
    release_all(&field->scratch);
}

/* The surface of faces that do not repeat a corner, closed by dummies (C 4), and room for its conquest. */
static bool close_surface(Context *context, ConstInts2 faces, int64_t vertices, Arena *arena, Surface *surface) {
    ConstInts origin = {faces.data, 3 * faces.rows};
    int64_t size = origin.size, closed = size, all;
    Guide *guide = &surface->guide;
    Longs starts;
    Ints by_high, order, twin, corner, vertex, leaving, full_twin, full_corner, valence;
    if (!take_longs(arena, vertices + 1, &starts) || !take_ints(arena, size, &by_high)
        || !take_ints(arena, size, &order) || !take_ints(arena, size, &twin) || !take_ints(arena, size, &corner)
        || !take_ints(arena, size, &vertex))
        return false;
    match_halfedges(origin, starts, by_high, order, twin);
    join_sheets(origin, const_ints(order), twin);
    guide->real = find_fans(origin, const_ints(twin), corner, vertex);
    for (int64_t h = 0; h < size; h++) closed += 3 * (twin.data[h] < 0);
    if (closed > INT32_MAX) return FAIL(context, LIMIT, "# faces are too many", faces.rows);
    if (!take_ints(arena, guide->real, &leaving) || !take_ints(arena, closed, &full_twin)
        || !take_ints(arena, closed, &full_corner))
        return false;
    surface->dummies = fill_loops(const_ints(twin), const_ints(corner), leaving, full_twin, full_corner);
    all = guide->real + surface->dummies;
    if (!zero_ints(arena, all, &valence) || !TAKE(arena, all, guide->number) || !TAKE(arena, closed, guide->node)
        || !TAKE_ZEROS(arena, closed / 3, guide->conquered) || !TAKE(arena, guide->real, guide->fans)
        || !TAKE(arena, faces.rows, guide->faces))
        return false;
    for (int64_t h = 0; h < closed; h++) valence.data[full_corner.data[h]]++;
    for (int64_t i = 0; i < all; i++) guide->number[i] = -1;
    guide->twin = full_twin.data;
    guide->corner = full_corner.data;
    guide->valence = valence.data;
    surface->vertex = vertex.data;
    return true;
}

static bool write_connectivity(Context *context, Source given, int64_t vertices, int repeats, Arena *arena,
    Arena *scratch, int32_t *order, int32_t *face_order, int32_t *faces) {
    int64_t m = given.faces_count, proper = 0, next = 0;
    Header header = {.vertices = vertices, .faces = m, .repeats = repeats};
    Surface surface = {.order = {order, vertices}};
    Ints2 own, coded;
    Ints places;
    if (!take_ints2(arena, m, 3, &own) || !take_ints(arena, m, &places)
        || !take_ints(arena, vertices, &surface.number))
        return false;
    for (int repeated = 0; repeated < 2; repeated++) {
        proper = next;
        for (int64_t f = 0; f < m; f++) {
            const int32_t *face = given.faces + 3 * f;
            if ((face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) != repeated) continue;
            for (int k = 0; k < 3; k++) own.data[3 * next + k] = face[k];
            places.data[next++] = (int32_t)f;
        }
    }
    if (!close_surface(context, (ConstInts2){own.data, proper, 3}, given.rows, arena, &surface)) return false;
    int64_t fans = surface.guide.real, corners = 3 * (m - proper);
    if (!take_ints(arena, fans + corners, &surface.used) || !take_ints(arena, m - proper, &surface.on_edge)
        || !take_ints(arena, m - proper, &surface.places))
        return false;
    for (int64_t i = 0; i < m - proper; i++) surface.places.data[i] = (int32_t)i;
    memcpy(surface.used.data + fans, own.data + 3 * proper, (size_t)corners * sizeof *own.data);
    for (int64_t i = 0; i < fans && given.values != NULL; i++) surface.vertex[i] = given.values[surface.vertex[i]];
    int64_t regular = number_by_appearance((ConstInts){surface.vertex, fans}, surface.order, surface.number);
    for (int64_t i = fans; i < fans + corners && given.values != NULL; i++)
        surface.used.data[i] = given.values[surface.used.data[i]];
    surface.repeated = m - proper;
    surface.lonely = vertices - regular;
    surface.surplus = fans - regular;
    if (!code_connectivity(context, (Span){0}, &header, &surface, arena, scratch, &coded)) return false;
    memcpy(faces, coded.data, (size_t)(3 * m) * sizeof *faces);
    for (int64_t i = 0; i < proper; i++) face_order[i] = places.data[surface.guide.faces[i]];
    for (int64_t i = proper; i < m; i++) face_order[i] = places.data[proper + surface.places.data[i - proper]];
    return true;
}

static void find_starts(Source given, const int32_t *order, const int32_t *face_order, const int32_t *faces,
    uint8_t *starts) {
    for (int64_t f = 0; f < given.faces_count; f++) {
        const int32_t *face = given.faces + 3 * (int64_t)face_order[f];
        starts[f] = 0;
        for (int k = 2; k >= 0; k--) {
            bool same = true;
            for (int j = 0; j < 3; j++) {
                int32_t corner = face[(j + k) % 3];
                same = same && (given.values != NULL ? given.values[corner] : corner) == order[faces[3 * f + j]];
            }
            if (same) starts[f] = (uint8_t)k;
        }
    }
}

static bool write_faces_as(PayloadWriter *writer, Source given, int64_t vertices, int repeats, Payload *writing,
    int32_t *order, int32_t *face_order, int32_t *faces) {
    Arena arena = arena_of(&writer->context);
    writing->size = writing->count = 0;
    writer->context.writing = writing;
    bool done = write_connectivity(&writer->context, given, vertices, repeats, &arena, &writer->scratch, order,
        face_order, faces);
    writer->context.writing = NULL;
    release_all(&arena);
    return done;
}

/* How many faces repeat a corner. */
static int64_t count_repeated(Source given) {
    int64_t repeated = 0;
    for (int64_t f = 0; f < given.faces_count; f++) {
        const int32_t *face = given.faces + 3 * f;
        repeated += face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
    }
    return repeated;
}

bool write_faces(PayloadWriter *writer, Source given, int64_t vertices, int *repeats, Payload *writing,
    int32_t *order, int32_t *face_order, int32_t *faces, uint8_t *starts) {
    bool is_free = *repeats == WHERE_SMALLER, done = true;
    int64_t repeated = is_free ? count_repeated(given) : 0, as_corners = 0;
    int64_t bits = 64 - __builtin_clzll((uint64_t)vertices), least_gain = LEAST_GAIN + repeated * TURN_BITS / 8;
    if (is_free) *repeats = 3 * repeated * bits / 8 > least_gain ? ON_EDGES : AS_CORNERS;
    if (is_free && *repeats == ON_EDGES) {
        done = write_faces_as(writer, given, vertices, AS_CORNERS, writing, order, face_order, faces);
        as_corners = writing->size;
    }
    done = done && write_faces_as(writer, given, vertices, *repeats, writing, order, face_order, faces);
    if (done && as_corners > 0 && writing->size + least_gain > as_corners) {
        *repeats = AS_CORNERS;
        done = write_faces_as(writer, given, vertices, AS_CORNERS, writing, order, face_order, faces);
    }
    if (done) find_starts(given, order, face_order, faces, starts);
    return done;
}

int64_t room_of_chunk(const CodedField *field, int64_t count) {
    int64_t columns = 3;
    for (int g = 0; g < field->attribute.groups; g++) columns = MOST_COMPONENTS * (g + 1);
    return 1024 + 160 * count * (columns + 4);
}

bool code_chunk(CodedField *field, int64_t first, int64_t count, Span payload, Payload *writing) {
    GridField *grid = &field->grid;
    Attribute *attribute = &field->attribute;
    bool done = true;
    field->context->writing = writing;
    if (field->kind == ON_GRID) {
        done = code_grid_values(grid, first, count, payload);
        if (done && grid->header->light == EXACT_FLOATS)
            done = place_floats(grid, (ConstInts){grid->order.data + first, count}, payload, &field->scratch);
    } else if (field->kind == OF_LEVELS) {
        done = code_layer(&field->layer, first, count, payload);
    }
    for (int g = 0; done && field->kind == OF_VALUES && g < attribute->groups; g++)
        done = code_group(field->context, attribute, &attribute->group[g], payload, first, count);
    field->context->writing = NULL;
    release_all(&field->scratch);
    return done;
}

#endif
