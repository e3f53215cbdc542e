/* Attributes of a given mesh in the order of coding (encoder only; specification, D). */
#include "library/encode/encoding.h"

#include "bitstream/payloads/payloads.h"

#ifdef BSMDEC_WRITES

enum { AGAIN_BITS = 8 /* of normals that the decoder computes: those that are the same so are made as one */ };

/* The given row of corner k of coded face f. */
static int64_t given_row(const CodedMesh *coded, const bsmenc_attribute *a, int64_t f, int k) {
    int64_t face = coded->joined->kept.data[coded->face_order.data[f]];
    if (a->domain == BSMDEC_FACE) return face;
    int64_t corner = 3 * face + (coded->turns.data[f] + k) % 3;
    if (a->domain == BSMDEC_VERTEX) return coded->given->corners[corner];
    return a->indices != NULL ? (int64_t)a->indices[corner] : corner;
}

static bool is_loose(const CodedMesh *coded, const bsmenc_attribute *a, int64_t v) {
    return coded->keeps && a->domain == BSMDEC_VERTEX && coded->joined->index.data[v] < 0;
}

/* The values that are used, as they are numbered, in memory of their own; `row`: the new number of each. */
static bool take_used(PayloadWriter *writer, const CodedMesh *coded, const bsmenc_attribute *a, Ints row, void **values,
    int64_t *count) {
    int width = a->domain == BSMDEC_FACE ? 1 : 3;
    size_t bytes = bsmdec_kind_size(a->kind) * (size_t)a->components;
    for (int64_t i = 0; i < row.size; i++) row.data[i] = -1;
    for (int64_t f = 0; f < coded->faces.rows; f++)
        for (int k = 0; k < width; k++) row.data[given_row(coded, a, f, k)] = 0;
    for (int64_t v = 0; v < coded->given->vertices && a->domain == BSMDEC_VERTEX; v++)
        if (is_loose(coded, a, v)) row.data[v] = 0;
    *count = 0;
    for (int64_t i = 0; i < row.size; i++)
        if (row.data[i] == 0) row.data[i] = (int32_t)(*count)++;
    if (!is_there(*values = find_memory(&writer->scratch, *count, bytes))) return false;
    for (int64_t i = 0; i < row.size; i++)
        if (row.data[i] >= 0)
            memcpy((char *)*values + bytes * (size_t)row.data[i], (const char *)a->values + bytes * (size_t)i, bytes);
    return true;
}

/* The seams of numbered corners: where they differ on the two sides of an edge, at either end. Joined between them,
 * corners have values: that of each is in `joined`, and the first corner of each in `first`. Returns how many. */
static int64_t join_values(Corners corners, const int32_t *number, Bytes seams, Ints joined, Ints first) {
    const int32_t *vertex = corners.faces.data;
    for (int32_t k = 0; k < (int32_t)seams.size; k++) {
        int32_t beyond = corners.opposite.data[k];
        seams.data[k] = OPEN;
        if (beyond < 0) continue;
        int32_t a = next_corner(k), b = previous_corner(k), c = next_corner(beyond), d = previous_corner(beyond);
        if (vertex[a] != vertex[d]) {
            int32_t swapped = c;
            c = d;
            d = swapped;
        }
        seams.data[k] = number[a] != number[d] || number[b] != number[c];
    }
    return join_corners(corners, const_bytes(seams), joined, first);
}

/* The values as vertices of a mesh of their own: of vertices if all corners of each have one, otherwise joined. */
static bool lay_out(PayloadWriter *writer, const CodedMesh *coded, const bsmenc_attribute *a, const int32_t *number,
    int index, Carried *all, Ints chosen, int64_t *count) {
    Carried *carried = all + index;
    Declaration *d = &carried->quantized.declaration;
    Arena *arena = &writer->arena, *scratch = &writer->scratch;
    int64_t n = coded->vertex_order.size, size = 3 * coded->faces.rows;
    bool differ = false;
    for (int64_t i = 0; i < size; i++) chosen.data[coded->faces.data[i]] = carried->rows.data[i];
    for (int64_t i = 0; i < size && !differ; i++)
        differ = number[carried->rows.data[i]] != number[chosen.data[coded->faces.data[i]]];
    d->domain = differ ? BSMDEC_CORNER : BSMDEC_VERTEX;
    d->origin = d->domain == a->domain ? 0 : 1;
    *count = n;
    if (!differ) {
        carried->faces = coded->faces;
        if (!take_ints(arena, n + coded->given->vertices, &carried->vertices)) return false;
        for (int64_t v = 0; v < n; v++) carried->vertices.data[v] = (int32_t)v;
        return true;
    }
    Ints corner_number, first;
    if (!take_ints(scratch, size, &corner_number) || !take_ints(scratch, size, &first)
        || !take_bytes(arena, size, &carried->seams) || !take_ints2(arena, coded->faces.rows, 3, &carried->faces))
        return false;
    for (int64_t i = 0; i < size; i++) corner_number.data[i] = number[carried->rows.data[i]];
    *count = join_values(coded->corners, corner_number.data, carried->seams, (Ints){carried->faces.data, size}, first);
    carried->joins = index;
    for (int k = 0; k < index; k++) {
        if (all[k].seams.size == 0 || memcmp(all[k].seams.data, carried->seams.data, (size_t)size) != 0) continue;
        carried->joins = k;
        carried->seams.size = 0;
        d->seams_of = k + 1;
        break;
    }
    if (!take_ints(arena, *count + coded->given->vertices, &carried->vertices)) return false;
    for (int64_t r = 0; r < *count; r++) {
        chosen.data[r] = carried->rows.data[first.data[r]];
        carried->vertices.data[r] = coded->faces.data[first.data[r]];
    }
    return true;
}

static bool carry(PayloadWriter *writer, const CodedMesh *coded, const bsmenc_attribute *a, int index, Carried *all) {
    Context *context = &writer->context;
    Arena *arena = &writer->arena, *scratch = &writer->scratch;
    Carried *carried = all + index;
    Declaration *d = &carried->quantized.declaration;
    int width = a->domain == BSMDEC_FACE ? 1 : 3;
    int64_t given = a->domain == BSMDEC_VERTEX ? coded->given->vertices : a->rows, count, used;
    Ints row, number, chosen;
    void *values;
    if (!take_ints(scratch, given, &row) || !take_used(writer, coded, a, row, &values, &used)
        || !quantize(context, values, used, a->quality, a->amount, arena, &carried->quantized)
        || !take_ints(arena, width * coded->faces.rows, &carried->rows))
        return false;
    for (int64_t i = 0; i < carried->rows.size; i++)
        carried->rows.data[i] = row.data[given_row(coded, a, i / width, (int)(i % width))];
    Table table = {values, used, d->components, d->kind};
    if (width == 3 && may_turn(&table, d->semantic, a->quality, a->amount)) {
        carried->turn_bits = (int)a->amount;
        if (!take_doubles2(arena, used, 4, &carried->tangents)) return false;
        for (int64_t i = 0; i < 4 * used; i++) carried->tangents.data[i] = load_number(values, i, d->kind);
    }
    int64_t most = 3 * coded->faces.rows + coded->given->vertices;
    if (!take_ints(scratch, most, &chosen)) return false;
    count = coded->faces.rows;
    if (width == 1) {
        d->domain = BSMDEC_FACE;
        carried->faces = coded->faces;
        memcpy(chosen.data, carried->rows.data, (size_t)count * sizeof *chosen.data);
    } else {
        Quantized again = {.declaration = *d};
        const Quantized *apart = d->coding == RECOMPUTED ? &again : &carried->quantized;
        if (d->coding == RECOMPUTED
            && !quantize(context, values, used, BSMENC_BITS, AGAIN_BITS, scratch, &again))
            return false;
        if (!take_ints(scratch, used, &number)
            || number_rows(apart->levels.data, used, (int)apart->levels.columns, scratch, number) < 0
            || !lay_out(writer, coded, a, number.data, index, all, chosen, &count))
            return false;
        for (int64_t v = 0; v < coded->given->vertices; v++) {
            if (!is_loose(coded, a, v)) continue;
            carried->vertices.data[count] = -1;
            chosen.data[count++] = row.data[v];
        }
        carried->vertices.size = count;
    }
    if (d->coding == RECOMPUTED) return true;
    d->rows = count;
    if (!take_longs2(arena, count, d->words, &carried->levels)) return false;
    for (int64_t r = 0; r < count; r++)
        memcpy(carried->levels.data + d->words * r, carried->quantized.levels.data + d->words * (int64_t)chosen.data[r],
            (size_t)d->words * sizeof *carried->levels.data);
    return true;
}

bool carry_attribute(
    PayloadWriter *writer, const CodedMesh *coded, const bsmenc_attribute *given, int index, Carried *all) {
    Declaration *d = &all[index].quantized.declaration;
    Mark mark = mark_of(&writer->scratch);
    all[index].joins = -1;
    d->name_size = (int)strlen(given->name);
    memcpy(d->name, given->name, (size_t)d->name_size);
    d->semantic = given->semantic;
    d->kind = given->kind;
    d->components = given->components;
    bool done = carry(writer, coded, given, index, all);
    release_to(&writer->scratch, mark);
    return done || name_attribute(&writer->context, d->name);
}

bool write_seams(PayloadWriter *writer, const CodedMesh *coded, int index, const Carried *all, Payload *writing) {
    Context *context = &writer->context;
    Arena *scratch = &writer->scratch;
    Corners corners = coded->corners;
    ConstBytes own = const_bytes(all[index].seams);
    const uint8_t *last = NULL, *before_last = NULL; /* seams of attributes before it (D 2.5) */
    Bytes others, seams;
    Ints2 ends;
    Bank bank;
    Coding coding;
    Mark mark = mark_of(scratch);
    if (own.size == 0) return true;
    for (int k = 0; k < index; k++)
        if (all[k].seams.size > 0) before_last = last, last = all[k].seams.data;
    context->writing = writing;
    bool done = take_bytes(scratch, own.size, &others) && take_bytes(scratch, own.size, &seams)
        && take_ints2(scratch, corners.rank.size, 3, &ends) && make_bank(scratch, EDGE_BANK, &bank)
        && begin_coding(context, (Span){0}, &coding);
    for (int64_t i = 0; done && i < own.size; i++) {
        others.data[i] = (uint8_t)((last == NULL ? 0 : 3 * (1 + (last[i] == SEAM)))
            + (before_last == NULL ? 0 : 1 + (before_last[i] == SEAM)));
        seams.data[i] = own.data[i];
    }
    if (done) code_edges(&coding.coder, &bank, &coded->corners, seams.data, others.data, ends);
    done = done && finish_coding(&coding);
    context->writing = NULL;
    release_to(scratch, mark);
    return done;
}

bool declare_carried(
    PayloadWriter *writer, const CodedMesh *coded, int index, const Carried *all, StreamWriter *stream) {
    Context *context = &writer->context;
    Buffer entries = {.context = context};
    Payload seams;
    bool done = begin_payloads(context, all[index].seams.size + 64, &seams)
        && write_seams(writer, coded, index, all, &seams);
    if (done) {
        const Record record = declaration_record(&all[index].quantized.declaration);
        put_record(&entries, DECLARATION_FIELDS, &record);
        put_varint(&stream->payload, index);
        put_varint(&stream->payload, entries.size);
        put_bytes(&stream->payload, bytes_of(&entries));
        put_bytes(&stream->payload, (Span){seams.data, seams.size});
        put_section(stream, ATTRIBUTE_FRAME);
    }
    give_buffer(&entries);
    end_payloads(context, &seams);
    return !failed(context);
}

bool can_lean(const Declaration *d) {
    bool small = d->coding == LEVELS && d->semantic == BSMDEC_TEXCOORD && d->words == 2;
    for (int i = 0; i < d->words; i++) small = small && d->largest[i] <= MOST_WHOLE;
    return d->domain != BSMDEC_FACE && (small || d->coding == OCTAHEDRAL);
}

static bool code_values(PayloadWriter *writer, CodedField *field, int64_t rows, Buffer *payloads, Longs ends) {
    Context *context = &writer->context;
    bool done = true;
    for (int64_t first = 0, chunk = 0; done && first < rows; first += VALUES_CHUNK, chunk++) {
        int64_t count = least(VALUES_CHUNK, rows - first);
        Payload writing;
        done = begin_payloads(context, room_of_chunk(field, count), &writing)
            && code_chunk(field, first, count, (Span){0}, &writing);
        for (int i = 0; done && i < writing.count; i++) {
            int64_t start = i > 0 ? writing.ends[i - 1] : 0;
            if (writing.count > 1) put_varint(payloads, writing.ends[i] - start);
            put_bytes(payloads, (Span){writing.data + start, writing.ends[i] - start});
        }
        end_payloads(context, &writing);
        ends.data[chunk] = payloads->size;
    }
    return done && !failed(context);
}

bool take_pieces(Arena *arena, const Carried *carried, Ints2 *pieces) {
    const Declaration *d = &carried->quantized.declaration;
    int64_t columns = 0, at = 0;
    for (int i = 0; i < d->words; i++) columns += 1 + (d->largest[i] > MOST_WHOLE);
    if (!take_ints2(arena, d->rows, columns, pieces)) return false;
    for (int64_t i = 0; i < d->rows * d->words; i++) {
        int64_t level = carried->levels.data[i];
        bool wide = d->largest[i % d->words] > MOST_WHOLE;
        if (wide) pieces->data[at++] = (int32_t)(level >> PIECE_BITS);
        pieces->data[at++] = (int32_t)(wide ? level & ((1 << PIECE_BITS) - 1) : level);
    }
    return true;
}

bool code_carried(PayloadWriter *writer, const CodedMesh *coded, const Carried *carried, const int32_t *places,
    Buffer *payloads, Longs ends) {
    Context *context = &writer->context;
    Declaration declared = carried->quantized.declaration;
    int64_t rows = declared.rows;
    Mark mark = mark_of(&writer->scratch);
    CodedField *field;
    Ints2 pieces;
    declared.leans = places != NULL;
    if (!TAKE_ZEROS(&writer->scratch, 1, field) || !take_pieces(&writer->scratch, carried, &pieces)) return false;
    Source given = {carried->faces.data, pieces.data, carried->faces.rows, rows, pieces.columns};
    bool done = begin_attribute(field, context, given, &declared, coded->vertex_order.size,
                    declared.domain == BSMDEC_FACE ? NULL : carried->vertices.data, places, coded->swift)
        && code_values(writer, field, rows, payloads, ends);
    end_field(field);
    release_to(&writer->scratch, mark);
    return done;
}

#endif
