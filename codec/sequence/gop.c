/* What a GOP says (specification, S 2), and what it costs (S 8). */
#include "codec/sequence/gops.h"

#include <math.h>

enum { MOST_EXPONENT = 400 };

static int64_t zigzag(int64_t code) { return code % 2 == 0 ? code / 2 : -(code / 2) - 1; }

/* S 2.5. */
static bool parse_stretches(Cursor *cursor, Gop *gop) {
    int64_t pieces = take_varint(cursor), at = 0, due = 0;
    gop->coded = 0;
    for (int64_t t = 0; t < gop->frames; t++) gop->shown.data[t] = t;
    if (pieces == 0) {
        gop->coded = gop->frames;
        return !failed(cursor->context);
    }
    for (; pieces > 0; pieces--) {
        int64_t begin = take_varint(cursor), length = take_varint(cursor), way = 1 - begin % 3,
                first = due + zigzag(begin / 3);
        if (failed(cursor->context)) return false;
        if (length < 1 || length > gop->frames - at || first < 0 || first >= gop->frames
            || first + way * (length - 1) < 0 || first + way * (length - 1) >= gop->frames)
            return FAIL(cursor->context, CORRUPT, "a stretch of # frames from frame # on, of a GOP of #", length, first,
                gop->frames);
        for (; length > 0; length--, first += way) {
            gop->coded = largest(gop->coded, first + 1);
            gop->shown.data[at++] = first;
            due = first + 1;
        }
    }
    return at == gop->frames || FAIL(cursor->context, CORRUPT, "stretches of # frames in a GOP of #", at, gop->frames);
}

static bool parse_exponents(Cursor *cursor, int64_t count, Arena *arena, Ints *exponents) {
    int64_t exponent = 0;
    if (!take_ints(arena, count, exponents)) return false;
    for (int64_t i = 0; i < count; i++) {
        int64_t change = zigzag(take_varint(cursor));
        if (failed(cursor->context)) return false;
        if (change < -MOST_EXPONENT || change > MOST_EXPONENT || exponent + change < 0
            || exponent + change > MOST_EXPONENT)
            return FAIL(cursor->context, CORRUPT, "a basis with step exponents outside 0..#", MOST_EXPONENT);
        exponents->data[i] = (int32_t)(exponent += change);
    }
    return !failed(cursor->context);
}

/* S 2.1. */
static bool parse_field(Context *context, Span data, const Gop *gop, Arena *arena, GopField *field) {
    Cursor cursor = {context, data};
    Span bytes = take_span(&cursor, 4);
    if (failed(context)) return false;
    uint32_t word = (uint32_t)little_endian(bytes.data, 4);
    float step;
    memcpy(&step, &word, sizeof step);
    if (!(step > 0.0F && step < INFINITY)) return FAIL(context, CORRUPT, "GOP step is not positive");
    field->step = step;
    if (has_basis(gop)) {
        field->components = take_varint(&cursor);
        if (field->components > field->width * gop->coded)
            return FAIL(context, CORRUPT, "# components for # frames", field->components, gop->coded);
        if (!parse_exponents(&cursor, field->components, arena, &field->exponents)) return false;
        field->basis = take_span(&cursor, take_varint(&cursor));
    } else {
        field->back = gop->method == NEXT_FRAMES ? take_varint(&cursor) : 0;
        field->components = field->width * gop->frames;
        if (field->back > 0 && field->back < gop->frames)
            return FAIL(context, CORRUPT, "# frames that start from those # before them", gop->frames, field->back);
    }
    field->levels = take_rest(&cursor);
    return !failed(context);
}

/* Fields of attributes, which come before that of positions (S 10.2). */
static bool parse_attributes(Cursor *cursor, const MovingAttribute *moving, bool tolerant, Arena *arena, Gop *gop) {
    Context *context = cursor->context;
    int64_t fields = take_varint(cursor), before = -1;
    if (!failed(context) && fields == 0)
        return FAIL(context, CORRUPT, "a GOP announces attributes and codes none");
    for (; fields > 0; fields--) {
        int64_t number = take_varint(cursor);
        Span part = take_span(cursor, take_varint(cursor));
        if (failed(context)) return false;
        int k = 0;
        while (k < gop->count - 1 && moving[k].number != number) k++;
        bool moves = k < gop->count - 1;
        if (number <= before || !(tolerant || moves))
            return FAIL(context, CORRUPT, "a GOP codes attribute #, which does not move or is out of order",
                number);
        before = number;
        if (moves && !parse_field(context, part, gop, arena, gop->field + 1 + k)) return false;
    }
    return !failed(context);
}

bool parse_beginning(Cursor *cursor, int64_t longest, int64_t run, Gop *gop) {
    Span first = take_span(cursor, 1);
    if (failed(cursor->context)) return false;
    *gop = (Gop){.method = first.data[0] % WITH_ATTRIBUTES};
    if (first.data[0] / METHODS != run % RUNS)
        return FAIL(cursor->context, CORRUPT, "GOP of a different run, expected #", run);
    gop->frames = gop->coded = take_varint(cursor);
    return !failed(cursor->context) && ((gop->frames >= 1 && gop->frames <= longest)
        || FAIL(cursor->context, CORRUPT, "a GOP of # frames where 1 to # are legal", gop->frames, longest));
}

bool parse_gop(Context *context, Span data, int64_t longest, int64_t run, const MovingAttribute *moving, int count,
    bool tolerant, Arena *arena, Gop *gop) {
    Cursor cursor = {context, data};
    if (!parse_beginning(&cursor, longest, run, gop)) return false;
    gop->count = count + 1;
    if (!take_longs(arena, gop->frames, &gop->shown) || !TAKE_ZEROS(arena, count + 1, gop->field)) return false;
    for (int64_t t = 0; t < gop->frames; t++) gop->shown.data[t] = t;
    for (int k = 0; k <= count; k++) gop->field[k].width = k > 0 ? moving[k - 1].width : 3;
    if (has_basis(gop) && !parse_stretches(&cursor, gop)) return false;
    if (data.data[0] % METHODS >= WITH_ATTRIBUTES && !parse_attributes(&cursor, moving, tolerant, arena, gop))
        return false;
    return parse_field(context, take_rest(&cursor), gop, arena, gop->field);
}

static double columns_of_gop(const Gop *gop) {
    double columns = 0;
    for (int k = 0; k < gop->count; k++)
        columns += (double)(has_basis(gop) ? gop->field[k].components : gop->field[k].width * gop->frames);
    return columns;
}

double gop_memory(int64_t vertices, const Gop *gop, double around) {
    double n = (double)vertices, t = (double)gop->frames, width = 0, bases = 0, kept = 0;
    for (int k = 0; k < gop->count; k++) {
        double own = (double)gop->field[k].width, r = (double)gop->field[k].components;
        width += own;
        bases += r * (40 * own * t + 24 * r);
        kept += (r < INHERITED ? r : INHERITED) + (gop->method == LEARNED_NEXT ? INHERITED : 0);
    }
    double left = has_basis(gop) ? 8 * kept * (n + around)
        : 24 * (double)frames_kept(vertices) * (n + around) + width * (4 * t * n + 8 * (t + 4) * around);
    return n * (12 * columns_of_gop(gop) + (16 * (t < BATCH ? t : BATCH) + 32) * width) + bases + left;
}

double memory_in_use(const Parts *parts, const Gop *gop) { return 48 * (double)parts->largest * columns_of_gop(gop); }

static const double FRAME_WORK = 2.5e4, SHOWN_WORK = 11.0 / 3, PART_WORK = 6e4, ANOTHER_WORK = 2.5e4, LEVEL_WORK = 90;
static const double LOOP_WORK = 66, AROUND_WORK = 10, INHERITED_LOOP = 90, INHERITED_AROUND = 10, REFERRED = 1.1;

static double part_work(const Site *part, double columns, double loop, double around) {
    double rows = (double)part->patch.size, width = (double)part->width;
    return columns * (width * (LEVEL_WORK + loop) + (double)part->around.size * around)
        + solve_work(&part->patch.fronts, (int64_t)columns) + rows * (width * (1 + 0.1 * columns) + 20 * columns);
}

static double gop_work(const Gops *gops, const Gop *gop) {
    bool more = gop->method == LEARNED_NEXT, learned = has_basis(gop);
    double t = (double)gop->frames, columns = columns_of_gop(gop), work = t * FRAME_WORK * gop->count,
           rows = gops->parts.around, others = 0;
    for (int k = 1; k < gop->count; k++) others += !learned || gop->field[k].components > 0;
    work += (PART_WORK + ANOTHER_WORK * others) * (double)gops->parts.count;
    for (int64_t i = 0; i < gops->parts.count; i++) {
        rows += (double)gops->parts.part[i].width;
        work += part_work(gops->parts.part + i, columns, LOOP_WORK + (more ? INHERITED_LOOP : 0),
            AROUND_WORK + (more ? INHERITED_AROUND : 0));
    }
    for (int k = 0; k < gop->count; k++) {
        const GopField *field = gop->field + k;
        double width = (double)field->width, r = (double)field->components;
        double known = width * (double)(2 + lags_of(gops->track[k].kept) + (field->back > 0));
        work += learned ? t * width * r * (10 + 2 * r) : REFERRED * rows * known * known;
        work += t * width * (gops->given * SHOWN_WORK + (double)gops->parts.graph->size * r / 15);
    }
    return work;
}

bool reserve_gop(Gops *gops, const Gop *gop, double received) {
    double work, memory = gop_memory(gops->parts.graph->size, gop, gops->parts.around);
    return reserve_dictionaries(&gops->parts, memory, memory_in_use(&gops->parts, gop), &work)
        && charge(gops->parts.context, work + gop_work(gops, gop), received);
}
