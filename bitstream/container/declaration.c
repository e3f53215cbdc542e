/* What an ATTRIBUTE frame declares: fields, and how they agree (specification, D 1). */
#include "bitstream/container/container.h"

enum {
    NAME = 1, DOMAIN_KEY, ORIGIN, SEMANTIC, KIND, COMPONENTS, CODING, ROWS, LARGEST, OFFSET, STEP, LEANS, MOVES,
    SEAMS_OF = 15, BASES_KEY,
};

static const Field FIELDS[] = {
    {.key = NAME, .type = TEXT_FIELD, .low = 1, .high = MOST_NAME, .required = true},
    {.key = DOMAIN_KEY, .type = METHOD_FIELD, .high = 2},
    {.key = ORIGIN, .type = METHOD_FIELD, .high = 1},
    {.key = SEMANTIC, .type = METHOD_FIELD, .high = 3},
    {.key = KIND, .type = METHOD_FIELD, .high = 7, .fallback = BSMDEC_FLOAT32},
    {.key = COMPONENTS, .type = INT_FIELD, .low = 1, .high = 4, .fallback = 1},
    {.key = CODING, .type = METHOD_FIELD, .high = TANGENTS},
    {.key = ROWS, .type = INT_FIELD, .high = 2147483647.0},
    {.key = LARGEST, .type = INTS_FIELD, .high = UINT32_MAX, .most = MOST_WORDS},
    {.key = OFFSET, .type = FLOATS_FIELD, .low = -1e300, .high = 1e300, .most = MOST_WORDS},
    {.key = STEP, .type = FLOATS_FIELD, .low = 1e-300, .high = 1e300, .most = 4},
    {.key = LEANS, .type = METHOD_FIELD, .high = 1},
    {.key = MOVES, .type = METHOD_FIELD, .high = 1},
    {.key = SEAMS_OF, .type = INT_FIELD, .high = 65535},
    {.key = BASES_KEY, .type = INTS_FIELD, .low = 1, .high = 65535, .most = 2},
};
INSIDE const Fields DECLARATION_FIELDS = {FIELDS, sizeof FIELDS / sizeof *FIELDS};
enum { MOST_DECLARATION = 1 << 16 };

static int words_of(const Declaration *d) {
    if (d->coding == OCTAHEDRAL || d->coding == TANGENTS) return 2;
    if (d->coding == RECOMPUTED) return 0;
    return d->coding == BITS && d->kind == BSMDEC_FLOAT64 ? 2 * d->components : d->components;
}

static void set_declaration(const Record *record, Declaration *d) {
    const double(*number)[MOST_LIST] = record->number;
    *d = (Declaration){
        .name_size = (int)record->text.size, .domain = (int)number[DOMAIN_KEY][0], .origin = (int)number[ORIGIN][0],
        .semantic = (int)number[SEMANTIC][0], .kind = (int)number[KIND][0], .components = (int)number[COMPONENTS][0],
        .coding = (int)number[CODING][0], .rows = (int64_t)number[ROWS][0], .leans = number[LEANS][0] > 0,
        .moves = number[MOVES][0] > 0, .seams_of = (int64_t)number[SEAMS_OF][0],
    };
    memcpy(d->name, record->text.data, (size_t)record->text.size);
    for (int i = 0; i < record->count[BASES_KEY]; i++) d->bases[i] = (int64_t)number[BASES_KEY][i];
    d->words = words_of(d);
    for (int i = 0; i < d->words; i++) {
        d->largest[i] = (uint32_t)number[LARGEST][i];
        d->offset[i] = record->count[OFFSET] > 0 ? number[OFFSET][i] : 0.0;
        d->step[i] = record->count[STEP] == 0 ? 1.0 : number[STEP][record->count[STEP] == 1 ? 0 : i];
    }
}

#ifdef BSMDEC_WRITES
static int count_unless(const double *values, int count, double value) {
    for (int i = 0; i < count; i++)
        if (values[i] != value) return count;
    return 0;
}

Record declaration_record(const Declaration *d) {
    Record record = {
        .number = {[DOMAIN_KEY] = {d->domain}, [ORIGIN] = {d->origin}, [SEMANTIC] = {d->semantic}, [KIND] = {d->kind},
            [COMPONENTS] = {d->components}, [CODING] = {d->coding}, [ROWS] = {(double)d->rows}, [LEANS] = {d->leans},
            [SEAMS_OF] = {(double)d->seams_of}},
        .text = {(const uint8_t *)d->name, d->name_size},
    };
    for (int key = NAME; key <= SEAMS_OF; key++) record.count[key] = 1;
    record.count[BASES_KEY] = d->coding == TANGENTS ? 2 : 0;
    for (int i = 0; i < 2; i++) record.number[BASES_KEY][i] = (double)d->bases[i];
    record.count[LARGEST] = d->words;
    record.count[OFFSET] = count_unless(d->offset, d->words, 0.0);
    record.count[STEP] = count_unless(d->step, d->words, 1.0);
    if (record.count[STEP] > 0 && count_unless(d->step, d->words, d->step[0]) == 0) record.count[STEP] = 1;
    for (int i = 0; i < d->words; i++) {
        record.number[LARGEST][i] = d->largest[i];
        record.number[OFFSET][i] = d->offset[i];
        record.number[STEP][i] = d->step[i];
    }
    return record;
}
#endif

/* A 9.8, but for what the header and other attributes have to do with it. */
static bool are_tangents(const Record *record, const Declaration *d) {
    uint32_t turns = d->largest[0];
    return d->components == 4 && d->kind >= BSMDEC_FLOAT32 && d->leans && !d->moves
        && record->count[OFFSET] + record->count[STEP] == 0 && record->count[BASES_KEY] == 2 && turns >= 4
        && turns <= 4 * 65535 && turns % 4 == 0 && d->largest[1] <= 1;
}

/* D 1.4. */
static bool agrees_with_itself(const Record *record, const Declaration *d) {
    const int *count = record->count;
    bool unit = d->components == 3 && d->kind >= BSMDEC_FLOAT32, turned = d->coding == OCTAHEDRAL
        || d->coding == RECOMPUTED;
    uint32_t first = d->largest[0];
    if (d->domain == BSMDEC_FACE && d->origin != 0) return false;
    if (turned && (!unit || count[OFFSET] + count[STEP] > 0)) return false;
    if (d->coding == RECOMPUTED && (d->domain == BSMDEC_FACE || d->rows > 0 || d->leans)) return false;
    if (d->coding != RECOMPUTED && d->rows == 0) return false;
    if (d->coding == TANGENTS && !are_tangents(record, d)) return false;
    if (d->coding != TANGENTS && count[BASES_KEY] > 0) return false;
    if (d->coding == BITS && (d->kind < BSMDEC_FLOAT32 || count[STEP] > 0)) return false;
    if (count[LARGEST] != d->words || (count[OFFSET] != 0 && count[OFFSET] != d->words)) return false;
    if (count[STEP] > 1 && count[STEP] != d->words) return false;
    if (d->coding == OCTAHEDRAL && !(first == d->largest[1] && first >= 2 && first <= 65534 && first % 2 == 0))
        return false;
    if (d->domain == BSMDEC_FACE && d->leans) return false;
    if (d->moves && (d->domain != BSMDEC_VERTEX || d->origin != 0 || d->coding != LEVELS)) return false;
    return d->seams_of == 0 || d->domain == BSMDEC_CORNER;
}

static bool is_whole(double x) { return x >= -0x1p53 && x <= 0x1p53 && x == (double)(int64_t)x; }

/* Whether the values of the levels fit the kind. */
static bool in_kind(const Declaration *d) {
    for (int i = 0; i < d->words; i++) {
        double first = d->offset[i], last = first + d->step[i] * (double)d->largest[i];
        if (d->coding == BITS && !(first >= 0.0 && is_whole(first) && last <= UINT32_MAX)) return false;
        if (d->coding != LEVELS) continue;
        if (d->kind < BSMDEC_FLOAT32) {
            if (!(is_whole(first) && is_whole(d->step[i]) && first >= LEAST_OF[d->kind] && last <= UNIT_OF[d->kind]))
                return false;
        } else {
            double most = d->kind == BSMDEC_FLOAT32 ? 0x1.fffffep+127 : 1e308;
            if (!(first >= -most && first <= most && last >= -most && last <= most)) return false;
        }
    }
    return true;
}

bool parse_declaration(Context *context, Span payload, Arena *scratch, Declaration *declaration) {
    Record record;
    if (payload.size > MOST_DECLARATION)
        return FAIL(context, CORRUPT, "a declaration of # bytes is too long", payload.size);
    if (!parse_record(context, payload, DECLARATION_FIELDS, scratch, &record)) return false;
    set_declaration(&record, declaration);
    if (declaration->coding == UNKNOWN_CODING)
        return FAIL(context, UNSUPPORTED, "coding # is unknown to this decoder", declaration->coding);
    if (agrees_with_itself(&record, declaration) && in_kind(declaration)) return true;
    return FAIL(context, CORRUPT, "an attribute contradicts itself, or has values that are not of its kind");
}
