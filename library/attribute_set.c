/* Declarations, seams, and rows of attributes (specification, D 1 to D 3). */
#include "library/attribute.h"

#include "bitstream/costs.h"
#include "bitstream/payloads/payloads.h"

enum { GUESSES_PLAIN = MOST_COMPONENTS * BASES * VALENCES, GUESSES_OTHERS = 2 * BASES * VALENCES, FACE_MEMORY = 257,
    DIRECTIONS = 12, AXES = 3 };
static const double DECLARED_WORK = 6e5, ATTRIBUTE_WORK = 4e5;

void begin_attributes(Attributes *attributes, Context *context, const Header *header, ConstInts2 faces, Arena *arena) {
    *attributes = (Attributes){.context = context, .header = header, .faces = faces, .arena = arena,
        .coding = arena_of(context), .recent = arena_of(context)};
}

void end_attributes(Attributes *attributes) {
    release_all(&attributes->recent);
    release_all(&attributes->coding);
}

/* What the last two attributes with seams have at each edge, 3 times the last: 0 nothing, 1 no seam, 2 seam (D 2.5). */
static void look_at_others(const Attributes *attributes, int64_t before, Bytes others) {
    int factor = 3;
    for (int64_t k = before - 1; k >= 0 && factor > 0; k--) {
        const Attribute *attribute = attributes->list[k];
        if (attribute == NULL || !attribute->own_joins) continue;
        for (int64_t i = 0; i < others.size; i++)
            others.data[i] += (uint8_t)(factor * (1 + (attribute->joins->seams.data[i] == SEAM)));
        factor = factor == 3 ? 1 : 0;
    }
}

static bool read_seams(Attributes *attributes, int64_t index, Span payload, Arena *scratch, Joins *joins) {
    Context *context = attributes->context;
    int64_t n = attributes->header->vertices, size = 3 * attributes->faces.rows;
    double vertices = (double)n, m = (double)attributes->faces.rows, bytes = (double)payload.size;
    double first = attributes->has_corners ? 0.0 : 8 * vertices + 36 * m;
    if (!reserve(context, 15 * m + first, bytes) || !fits_memory(context, 16 * vertices + 24 * m)
        || !charge(context, 5e4 + 10 * vertices + 120 * m + 800 * bytes, bytes))
        return false;
    if (!attributes->has_corners)
        attributes->has_corners =
            link_mesh(context, attributes->faces, n, attributes->arena, scratch, &attributes->corners);
    Bytes others;
    Ints firsts;
    Ints2 ends;
    Bank bank;
    Coding coding;
    if (!attributes->has_corners || !zero_bytes(attributes->arena, size, &joins->seams)
        || !take_ints2(attributes->arena, attributes->faces.rows, 3, &joins->faces)
        || !zero_bytes(scratch, size, &others) || !take_ints(scratch, size, &firsts)
        || !take_ints2(scratch, n, 3, &ends)
        || !make_bank(scratch, EDGE_BANK, &bank)
        || !begin_coding(context, payload, &coding))
        return false;
    look_at_others(attributes, index, others);
    code_edges(&coding.coder, &bank, &attributes->corners, joins->seams.data, others.data, ends);
    if (!finish_coding(&coding)) return false;
    joins->count =
        join_corners(attributes->corners, const_bytes(joins->seams), (Ints){joins->faces.data, size}, firsts);
    return true;
}

static bool find_joins(Attributes *attributes, int64_t index, Attribute *attribute, Span seams, Arena *scratch) {
    Context *context = attributes->context;
    const Declaration *d = &attribute->declaration;
    if (d->domain != BSMDEC_CORNER) return true;
    if (d->seams_of > 0) {
        const Attribute *shared = d->seams_of <= MOST_ATTRIBUTES ? attributes->list[d->seams_of - 1] : NULL;
        attribute->joins = shared != NULL ? shared->joins : NULL;
        return attribute->joins != NULL
            || FAIL(context, CORRUPT, "the seams of '$' are those of an attribute that is missing", .name = d->name);
    }
    if (attributes->count < index)
        return FAIL(context, CORRUPT, "the seams of '$' depend on those of an attribute that is missing",
            .name = d->name);
    Joins *joins;
    if (!TAKE(attributes->arena, 1, joins) || !read_seams(attributes, index, seams, scratch, joins)) return false;
    attribute->joins = joins;
    attribute->own_joins = true;
    return true;
}

static bool find_bases(const Attributes *attributes, Attribute *tangents) {
    const Declaration *d = &tangents->declaration;
    Attribute *coordinates = attributes->list[d->bases[1] - 1];
    tangents->normals = attributes->list[d->bases[0] - 1];
    if (tangents->normals == NULL || coordinates == NULL)
        return FAIL(attributes->context, CORRUPT, "the normals or texture coordinates of '$' are missing",
            .name = d->name);
    coordinates->is_base = true;
    return true;
}

bool declare_attribute(Attributes *attributes, int64_t index, const Declaration *declaration, Span seams,
    Arena *scratch) {
    Context *context = attributes->context;
    bool recomputed = declaration->coding == RECOMPUTED;
    double rows = recomputed ? 3.0 * (double)attributes->faces.rows : (double)declaration->rows; /* at most (F 5.8) */
    double numbers = attributes->numbers + rows * (double)largest(declaration->words, declaration->components);
    if (!charge(context, DECLARED_WORK, 0) || !WITHIN(context, attribute_values, numbers)) return false;
    Attribute *attribute;
    if (!TAKE_ZEROS(attributes->arena, 1, attribute)) return false;
    attribute->declaration = *declaration;
    if (!find_joins(attributes, index, attribute, seams, scratch)) return false;
    attributes->numbers = numbers;
    if (declaration->coding == TANGENTS && !find_bases(attributes, attribute)) return false;
    attributes->list[index] = attribute;
    attributes->count++;
    return true;
}

static int64_t loose_rows(const Declaration *d, const Numbering *numbering) {
    return is_by_vertex(d) ? numbering->loose.rows : 0;
}

static int64_t expected_rows(const Attributes *attributes, const Attribute *attribute, const Numbering *numbering) {
    if (attribute->declaration.domain == BSMDEC_FACE) return attributes->faces.rows;
    return (attribute->joins != NULL ? attribute->joins->count : attributes->header->vertices)
        + loose_rows(&attribute->declaration, numbering);
}

bool check_rows(const Attributes *attributes, int64_t index, const Numbering *numbering) {
    const Attribute *attribute = attributes->list[index];
    if (attribute == NULL || attribute->declaration.coding == RECOMPUTED) return true;
    int64_t expected = expected_rows(attributes, attribute, numbering);
    return attribute->declaration.rows == expected
        || FAIL(attributes->context, CORRUPT, "attribute '$' has # values where # belong", attribute->declaration.rows,
            expected, .name = attribute->declaration.name);
}

/* The values of an attribute as vertices of a mesh of their own (D 3.1). */
static bool lay_out(Attributes *attributes, Attribute *attribute, const Numbering *numbering) {
    int64_t n = attributes->header->vertices, size = 3 * attributes->faces.rows;
    attribute->faces = attributes->faces;
    if (attribute->declaration.domain == BSMDEC_FACE) return true;
    if (!take_ints(attributes->arena, attribute->rows, &attribute->vertices)) return false;
    int64_t placed = attribute->rows - loose_rows(&attribute->declaration, numbering);
    if (attribute->joins != NULL) {
        attribute->faces = const_ints2(attribute->joins->faces);
        for (int64_t k = 0; k < size; k++)
            attribute->vertices.data[attribute->faces.data[k]] = attributes->faces.data[k];
    } else {
        for (int64_t r = 0; r < n; r++) attribute->vertices.data[r] = (int32_t)r;
    }
    for (int64_t r = placed; r < attribute->rows; r++) attribute->vertices.data[r] = -1;
    return true;
}

bool begin_values(Attributes *attributes, const Numbering *numbering) {
    Context *context = attributes->context;
    double m = (double)attributes->faces.rows;
    if (attributes->begun) return true;
    attributes->begun = true;
    for (int k = 0; k < MOST_ATTRIBUTES; k++)
        if (!check_rows(attributes, k, numbering)) return false;
    for (int k = 0; k < MOST_ATTRIBUTES; k++) {
        Attribute *attribute = attributes->list[k];
        if (attribute == NULL) continue;
        const Declaration *d = &attribute->declaration;
        attribute->rows = expected_rows(attributes, attribute, numbering);
        double rows = (double)attribute->rows;
        double numbers = 2.0 * (double)kind_size(d->kind) * d->components;
        if (attribute->is_base) numbers += 8;
        bool done = reserve(context, (numbers + 12) * rows, 0)
            && (d->coding != RECOMPUTED || fits_memory(context, 200 * m + 100 * rows))
            && charge(context, ATTRIBUTE_WORK + 150 * rows + 60 * m, 0)
            && lay_out(attributes, attribute, numbering);
        done = done && take_values(attributes->arena, attribute, &attribute->values)
            && (!attribute->is_base || take_ints2(attributes->arena, attribute->rows, 2, &attribute->words));
        if (!done) return false;
    }
    return true;
}

/* For each row the next one at the same vertex, in a ring (A 2.4). */
static bool find_twins(const Attribute *attribute, int64_t vertices, Arena *scratch, Ints twin) {
    Ints first, last;
    if (!take_ints(scratch, vertices, &first) || !take_ints(scratch, vertices, &last)) return false;
    for (int64_t v = 0; v < vertices; v++) first.data[v] = last.data[v] = -1;
    for (int64_t r = 0; r < attribute->rows; r++) {
        int32_t v = attribute->vertices.data[r];
        twin.data[r] = (int32_t)r;
        if (v < 0) continue;
        if (last.data[v] < 0) first.data[v] = (int32_t)r;
        else twin.data[last.data[v]] = (int32_t)r;
        last.data[v] = (int32_t)r;
        twin.data[r] = first.data[v];
    }
    return true;
}

typedef enum { PLAIN, TEXCOORDS, NORMALS } ValueKind;

/* How numbers are predicted (D 3.4). */
static ValueKind value_kind(const Declaration *d) {
    bool small = d->coding == LEVELS;
    for (int i = 0; i < d->words; i++) small = small && d->largest[i] <= MOST_WHOLE;
    if (d->coding == OCTAHEDRAL) return NORMALS;
    return small && d->semantic == BSMDEC_TEXCOORD && d->words == 2 ? TEXCOORDS : PLAIN;
}

static bool start_learners(Arena *arena, ValueKind kind, Longs2 *learners) {
    int64_t guesses = kind == PLAIN ? GUESSES_PLAIN : GUESSES_OTHERS, count = guesses + guesses / VALENCES;
    if (!make_learners(arena, count, learners)) return false;
    for (int64_t k = 0; k < count; k++) {
        bool size = k >= guesses;
        start_learner(*learners, k, 0, size ? 40000 : kind == PLAIN ? 16384 : kind == TEXCOORDS ? 8192 : 0);
        start_learner(*learners, k, 1, size ? 8192 : kind == PLAIN ? 16384 : 0);
    }
    return true;
}

/* Whether values are quick to decode (A 9.1). */
static bool is_swift(const Attributes *attributes, const Declaration *d) {
    return attributes->header->swift > 0 && d->domain != BSMDEC_FACE;
}

/* The corners of rows: those that are there, or new ones; no normal is guessed from what lies beyond an edge. */
static bool link_rows(Attributes *attributes, const Attribute *attribute, bool normals, Arena *scratch,
    Corners *corners) {
    Context *context = attributes->context;
    Arena *arena = &attributes->coding;
    bool shared = attributes->has_corners && attribute->joins == NULL;
    if (shared && attribute->rows == attributes->header->vertices) {
        *corners = attributes->corners;
        return true;
    }
    if (normals) return gather_mesh(context, attribute->faces, attribute->rows, arena, corners);
    if (attributes->has_corners) {
        return link_parts_of(context, &attributes->corners, attribute->faces, attribute->rows, arena, scratch, corners);
    }
    return link_mesh(context, attribute->faces, attribute->rows, arena, scratch, corners);
}

/* The state of values that are quick to decode (A 9). */
static bool begin_swift_group(Attributes *attributes, Attribute *attribute, Group *group, ConstInts largest,
    ConstInts2 geometry, Arena *scratch) {
    Arena *arena = &attributes->coding;
    Swift *swift = &group->swift;
    int64_t size = attribute->rows, columns = largest.size;
    bool normals = value_kind(&attribute->declaration) == NORMALS;
    *swift = (Swift){.normals = normals, .mixed = attributes->header->swift > 1};
    swift->slots_of_one = swift->mixed ? LEAN_INPUTS * SWIFT_CONTEXTS * LEAN_NODES : LIGHT_SLOTS;
    swift->own = (Values){.largest = largest, .geometry = geometry, .values = group->pieces};
    if (!link_rows(attributes, attribute, normals, scratch, &swift->corners)
        || !zero_ints2(arena, size, SWIFT_TALLIES, &swift->tallies)
        || !zero_ints2(arena, normals ? size : 0, 2 * AXES, &swift->directions)
        || !take_words(arena, columns * swift->slots_of_one, &swift->slots)
        || !take_ints(arena, swift->mixed ? columns * LEAN_NODES * LEAN_INPUTS : 0, &swift->weights)
        || !zero_longs(arena, 2, &swift->own.chart))
        return false;
    for (int64_t i = 0; i < swift->slots.size; i++) swift->slots.data[i] = 1u << 31;
    for (int64_t i = 0; i < swift->weights.size; i++) swift->weights.data[i] = ONE * 3 / 8;
    if (!normals || geometry.rows == 0) return true;
    Mark mark = mark_of(scratch);
    Longs sums;
    bool done = zero_longs(scratch, AXES * size, &sums);
    if (done) expect_directions(swift, sums.data);
    release_to(scratch, mark);
    return done;
}

static bool begin_vertex_group(Attributes *attributes, Attribute *attribute, Group *group, ConstInts largest,
    int32_t most, ConstInts2 geometry, Arena *scratch) {
    Context *context = attributes->context;
    Arena *arena = &attributes->coding;
    int64_t size = attribute->rows, columns = largest.size, words = most / 64 + 1;
    ValueKind kind = value_kind(&attribute->declaration);
    Values *values = &group->values;
    Ints twin;
    if (!take_ints(arena, size, &twin) || !link_mesh(context, attribute->faces, size, arena, scratch, &group->corners)
        || !order_mesh(&group->corners, arena, scratch, &group->order)
        || !find_twins(attribute, attributes->header->vertices, scratch, twin))
        return false;
    *values = (Values){.largest = largest, .order = const_ints(group->order), .twin = const_ints(twin),
        .geometry = geometry, .values = group->pieces};
    if (!zero_ints2(arena, size, columns, &values->gaps) || !zero_longs2(arena, size, columns + 1, &values->sums)
        || !zero_longs2(arena, columns, words, &values->seen) || !start_learners(arena, kind, &values->learners)
        || !zero_ints2(arena, kind == NORMALS ? size : 0, DIRECTIONS, &values->directions)
        || !zero_longs(arena, 2, &values->chart))
        return false;
    values->chart.data[1] = 16 * (int64_t)largest.data[0];
    if (kind == NORMALS) expect_normals(group->corners, *values);
    return true;
}

static bool begin_group(Attributes *attributes, Attribute *attribute, Group *group, const int32_t *pieces,
    ConstInts2 geometry, Arena *scratch) {
    Context *context = attributes->context;
    Arena *arena = &attributes->coding;
    bool of_faces = attribute->declaration.domain == BSMDEC_FACE;
    double n = (double)attribute->rows, m = (double)attribute->faces.rows, c = group->columns,
           model = VALUE_MODEL_BYTES + (1 << 17);
    double own = value_kind(&attribute->declaration) == NORMALS ? 48 : 0;
    bool quick = is_swift(attributes, &attribute->declaration);
    double needed = of_faces ? (72 + 48 + 8 * c) * m + model : (84 + 16 * c + own) * n + 48 * m + model + c * (1 << 17);
    if (!WITHIN(context, field_bytes, needed)) return false;
    Ints largest;
    if (!take_ints(arena, group->columns, &largest)
        || (!quick && !make_value_model(arena, &group->model, false))
        || !zero_ints2(arena, attribute->rows, group->columns, &group->pieces))
        return false;
    int32_t most = 0;
    for (int j = 0; j < group->columns; j++) {
        largest.data[j] = pieces[j];
        most = pieces[j] > most ? pieces[j] : most;
    }
    if (quick) return begin_swift_group(attributes, attribute, group, const_ints(largest), geometry, scratch);
    if (!of_faces)
        return begin_vertex_group(attributes, attribute, group, const_ints(largest), most, geometry, scratch);
    group->face_values = (FaceValues){.largest = const_ints(largest), .values = group->pieces};
    return zero_ints2(arena, attribute->rows, group->columns, &group->face_values.gaps)
        && zero_ints2(arena, group->columns, FACE_MEMORY, &group->face_values.memory)
        && link_mesh(context, attribute->faces, attributes->header->vertices, arena, scratch, &group->corners);
}

/* Where rows are, in whole numbers (D 5); nothing if values do not lean on that. */
static bool find_geometry(Attributes *attributes, const Attribute *attribute, ConstInts2 places, ConstInts2 *geometry) {
    *geometry = (ConstInts2){NULL, 0, 3};
    if (!attribute->declaration.leans || attribute->declaration.coding == TANGENTS) return true;
    if (places.rows == 0)
        return FAIL(attributes->context, CORRUPT, "positions are missing that attributes are predicted from");
    Ints2 found;
    if (!zero_ints2(&attributes->coding, attribute->rows, 3, &found)) return false;
    for (int64_t r = 0; r < attribute->rows; r++)
        if (attribute->vertices.data[r] >= 0)
            memcpy(found.data + 3 * r, places.data + 3 * (int64_t)attribute->vertices.data[r], 3 * sizeof(int32_t));
    *geometry = const_ints2(found);
    return true;
}

/* The state of an attribute replaces the state of the one before. */
bool start_attribute(Attributes *attributes, Attribute *attribute, ConstInts2 places, Arena *scratch) {
    Context *context = attributes->context;
    const Declaration *d = &attribute->declaration;
    double rows = (double)attribute->rows, m = (double)attribute->faces.rows, wide = 2.0 * d->components;
    ConstInts2 geometry;
    int32_t pieces[MOST_PIECES];
    int count = 0;
    double work = is_swift(attributes, d) ? swift_work(rows, m, d->components) : layer_work(rows, m, d->components);
    release_all(&attributes->coding);
    attribute->begun = true;
    attribute->coding = (84 + 16 * wide + 48) * rows + 48 * m + VALUE_MODEL_BYTES + wide * (1 << 17) + (1 << 17);
    if (!reserve(context, attribute->coding, 0) || !charge(context, work, 0)
        || !find_geometry(attributes, attribute, places, &geometry))
        return false;
    for (int i = 0; i < d->words; i++) {
        bool wide_word = d->largest[i] > MOST_WHOLE;
        pieces[count++] = (int32_t)(wide_word ? d->largest[i] >> 16 : d->largest[i]);
        if (wide_word) pieces[count++] = 65535;
    }
    for (int start = 0; start < count; start += MOST_COMPONENTS) {
        Group *group = &attribute->group[attribute->groups++];
        group->columns = (int)least(count - start, MOST_COMPONENTS);
        if (!begin_group(attributes, attribute, group, pieces + start, geometry, scratch)) return false;
    }
    return true;
}

/* What tangents are turned from, once that is complete (A 9.8). */
static bool begin_tangents(Attributes *attributes, Attribute *attribute, ConstInts2 places) {
    const Declaration *d = &attribute->declaration;
    const Attribute *normals = attribute->normals, *coordinates = attributes->list[d->bases[1] - 1];
    if (places.rows == 0 || !normals->whole || !coordinates->whole)
        return FAIL(attributes->context, CORRUPT, "positions, normals or texture coordinates of tangents are missing");
    TangentPlaces all = {attribute->faces, normals->faces, coordinates->faces, attribute->vertices.data, places,
        const_ints2(coordinates->words), attribute->rows};
    return plan_tangents(&attributes->coding, &all, &attribute->tangents);
}

bool code_group(Context *context, const Attribute *attribute, Group *group, Span payload, int64_t first,
    int64_t count) {
    Coding coding;
    int64_t done;
    if (!begin_coding(context, payload, &coding)) return false;
    if (attribute->declaration.domain == BSMDEC_FACE) {
        done = code_faces(&coding.coder, group->model, group->corners, group->face_values, first, count);
    } else if (group->swift.slots.size > 0) {
        done = code_swift(&coding.coder, &group->swift, first, count);
    } else {
        ValueKind kind = value_kind(&attribute->declaration);
        Work work = {.coder = &coding.coder, .model = group->model, .corners = group->corners, .values = group->values,
            .code = kind == NORMALS ? code_normal : kind == TEXCOORDS ? code_texcoord : code_scalar};
        done = code_vertices(&work, first, count);
    }
    return check_chunk_done(&coding, done, count);
}

static bool mark_fresh(Attributes *attributes, const Attribute *attribute, const Packet *packet) {
    release_all(&attributes->recent);
    attributes->latest = attribute;
    attributes->fresh = (Bytes){NULL, 0};
    if (packet->count == attribute->rows) return true;
    if (!zero_bytes(&attributes->recent, attribute->rows, &attributes->fresh)) return false;
    ConstInts order = const_ints(attribute->group[0].order);
    for (int64_t i = packet->first; i < packet->first + packet->count; i++)
        attributes->fresh.data[order.size > 0 ? order.data[i] : i] = 1;
    return true;
}

static bool decode_chunk(Attributes *attributes, Attribute *attribute, const Packet *packet, ConstInts2 places,
    Arena *scratch) {
    Context *context = attributes->context;
    double bytes = (double)packet->data.size;
    if (attribute->whole) return FAIL(context, CORRUPT, "its values are complete already");
    if (!attribute->begun) {
        if (!start_attribute(attributes, attribute, places, scratch)) return false;
        if (attribute->declaration.coding == TANGENTS && !begin_tangents(attributes, attribute, places)) return false;
    }
    double rows = (double)attribute->rows;
    bool swift = is_swift(attributes, &attribute->declaration);
    double work = swift ? swift_chunk_work(bytes, rows) : chunk_work(bytes, rows);
    if (!reserve(context, 0, bytes) || !charge(context, work, bytes)) return false;
    if (packet->first != attribute->coded)
        return FAIL(context, CORRUPT, "the values before number # are missing", packet->first);
    Cursor cursor = {context, packet->data};
    attribute->coded = INT64_MAX; /* until all of it is there: nothing continues after a part */
    for (int g = 0; g < attribute->groups; g++) {
        Span part = attribute->groups > 1 ? take_span(&cursor, take_varint(&cursor)) : take_rest(&cursor);
        if (failed(context)
            || !code_group(context, attribute, &attribute->group[g], part, packet->first, packet->count))
            return false;
    }
    if (!at_end(&cursor) || !restore_values(context, attribute, packet->first, packet->count)) return false;
    attribute->coded = packet->first + packet->count;
    attribute->whole = attribute->coded == attribute->rows;
    if (!mark_fresh(attributes, attribute, packet)) return false;
    if (attribute->whole) {
        release_all(&attributes->coding);
        return reserve(context, -attribute->coding, 0);
    }
    return true;
}

bool decode_values(Attributes *attributes, const Packet *packet, ConstInts2 places, Arena *scratch) {
    Attribute *attribute = attributes->list[packet->index];
    if (attribute == NULL) return FAIL(attributes->context, CORRUPT, "attribute # is not declared", packet->index);
    return decode_chunk(attributes, attribute, packet, places, scratch)
        || name_attribute(attributes->context, attribute->declaration.name);
}
