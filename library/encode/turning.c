/* Tangents as turns from the texture's direction about their normals (encoder only; specification, A 9.8 to A 9.10). */
#include "library/encode/encoding.h"

#include "codec/geometry/geometry.h"

#ifdef BSMDEC_WRITES

enum { MOST_TURN_BITS = 16 };
static const double UNIT_SLACK = 1e-3, STEPS_OFF = 2.0, DEGREES = 180.0 / 3.141592653589793;

bool may_turn(const Table *t, int semantic, bsmenc_quality quality, double amount) {
    if (t->components != 4 || t->kind < BSMDEC_FLOAT32 || semantic != BSMDEC_GENERIC) return false;
    if (quality != BSMENC_BITS || amount < 2.0 || amount > MOST_TURN_BITS) return false;
    for (int64_t r = 0; r < t->rows; r++) {
        double number[4];
        for (int j = 0; j < 4; j++) number[j] = load_number(t->values, 4 * r + j, t->kind);
        double length = __builtin_sqrt(dot3(number, number));
        if (!(__builtin_fabs(length - 1.0) <= UNIT_SLACK) || __builtin_fabs(number[3]) != 1.0) return false;
    }
    return true;
}

/* The words of the turn that is nearest to a tangent. */
static void find_turn(const TangentAxes *axes, const double *tangent, int64_t size, int64_t *word) {
    double ahead = dot3(tangent, axes->along), aside = dot3(tangent, axes->aside);
    double sum = __builtin_fabs(ahead) + __builtin_fabs(aside);
    double across = sum > 0.0 ? (double)size * (__builtin_fabs(aside) / sum) : 0.0;
    double turn = __builtin_rint(ahead >= 0.0 ? across : 2.0 * (double)size - across);
    word[0] = (int64_t)(aside < 0.0 ? -turn : turn) + 2 * size;
    word[1] = tangent[3] != axes->hand;
}

bool turn_tangents(Arena *scratch, const GivenTangents *given, Longs2 words, double *values, double *error) {
    const TangentPlaces *places = &given->places;
    TangentPlan plan;
    Bytes turned;
    double farthest = 0.0;
    if (!plan_tangents(scratch, places, &plan) || !zero_bytes(scratch, places->rows, &turned)) return false;
    *error = 180.0;
    for (int64_t i = 0; i < 3 * places->faces.rows; i++) {
        int64_t row = places->faces.data[i];
        const double *tangent = given->tangents + 4 * (int64_t)given->rows[i];
        double *value = values + 4 * row;
        if (!turned.data[row]) {
            TangentAxes axes = tangent_axes(&plan, row, given->normals + 3 * (int64_t)plan.normals.data[row]);
            find_turn(&axes, tangent, given->size, words.data + 2 * row);
            turn_axes(&axes, words.data + 2 * row, given->size, value);
            turned.data[row] = 1;
        }
        if (value[3] != tangent[3]) return true;
        double off[3] = {value[0] - tangent[0], value[1] - tangent[1], value[2] - tangent[2]};
        if (dot3(off, off) > farthest * farthest) farthest = __builtin_sqrt(dot3(off, off));
    }
    for (int64_t r = 0; r < places->rows; r++)
        if (!turned.data[r]) return true; /* of a vertex without faces */
    /* The arc is longer than its chord, by a part in a thousand where it is as long as is allowed. */
    *error = farthest * (1.0 + farthest * farthest / 8.0) * DEGREES;
    return true;
}

bool is_turn_near(double error, int64_t size) { return error <= STEPS_OFF * DEGREES / (double)size; }

void declare_turns(Declaration *d, int normals, int coordinates, int64_t size, const Longs2 *words) {
    d->coding = TANGENTS;
    d->words = 2;
    d->leans = true;
    d->bases[0] = normals + 1;
    d->bases[1] = coordinates + 1;
    d->largest[0] = (uint32_t)(4 * size);
    d->largest[1] = 0;
    for (int64_t r = 0; r < words->rows; r++) d->largest[1] |= (uint32_t)words->data[2 * r + 1];
    for (int j = 0; j < 2; j++) d->offset[j] = 0.0, d->step[j] = 1.0;
}

/* The number of the first of the attributes before `index` that can be the normals of tangents, or their texture
 * coordinates; -1: there is none. */
static int find_base(const Carried *all, int index, bool normals) {
    for (int k = 0; k < index; k++) {
        const Declaration *d = &all[k].quantized.declaration;
        if (d->domain == BSMDEC_FACE) continue;
        if (normals && d->coding == OCTAHEDRAL) return k;
        bool pairs = d->coding == LEVELS && d->semantic == BSMDEC_TEXCOORD && d->words == 2;
        if (!normals && pairs && d->largest[0] <= MOST_WHOLE && d->largest[1] <= MOST_WHOLE) return k;
    }
    return -1;
}

bool turn_carried(PayloadWriter *writer, const CodedMesh *coded, const int32_t *at, int index, Carried *all) {
    Carried *carried = all + index;
    Declaration *d = &carried->quantized.declaration;
    Arena *scratch = &writer->scratch;
    int normals = find_base(all, index, true), coordinates = find_base(all, index, false);
    if (carried->tangents.rows == 0 || normals < 0 || coordinates < 0) return true;
    int64_t size = INT64_C(1) << (carried->turn_bits - 1);
    const Declaration *of_normals = &all[normals].quantized.declaration;
    Longs2 coordinate_levels = all[coordinates].levels, words;
    Ints2 coordinate_words;
    Doubles2 decoded, values;
    Mark mark = mark_of(scratch);
    double error;
    bool done = take_ints2(scratch, coordinate_levels.rows, 2, &coordinate_words)
        && take_doubles2(scratch, of_normals->rows, 3, &decoded) && take_doubles2(scratch, d->rows, 4, &values)
        && take_longs2(&writer->arena, d->rows, 2, &words);
    for (int64_t i = 0; done && i < 2 * coordinate_levels.rows; i++)
        coordinate_words.data[i] = (int32_t)coordinate_levels.data[i];
    for (int64_t r = 0; done && r < of_normals->rows; r++) {
        unfold_direction(all[normals].levels.data + 2 * r, of_normals->largest[0] / 2, decoded.data + 3 * r);
        for (int j = 0; j < 3 && of_normals->kind == BSMDEC_FLOAT32; j++)
            decoded.data[3 * r + j] = in_single(decoded.data[3 * r + j]);
    }
    if (done) {
        GivenTangents given = {{const_ints2(carried->faces), const_ints2(all[normals].faces),
                                   const_ints2(all[coordinates].faces), carried->vertices.data,
                                   {at, coded->vertex_order.size, 3}, const_ints2(coordinate_words), d->rows},
            decoded.data, carried->tangents.data, carried->rows.data, size};
        done = turn_tangents(scratch, &given, words, values.data, &error);
    }
    release_to(scratch, mark);
    if (!done || !is_turn_near(error, size)) return done;
    declare_turns(d, normals, coordinates, size, &words);
    carried->levels = words;
    carried->quantized.outcome = (bsmenc_outcome){.error = error, .bits = carried->turn_bits};
    return true;
}

#endif
