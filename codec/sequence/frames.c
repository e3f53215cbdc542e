/* GOPs to frames, and back to GOPs (specification, S 3.7 to S 7, S 10).
 *
 * A group of frames is a field, a matrix with a row for each vertex and few columns, times a temporal basis: frames
 * are sums of a few motions. The field is coded part by part like positions of a mesh, by the spectral dictionary of
 * each part, which follows from the first frame alone. One walk reads and writes: where a target is given (`wanted`),
 * the walk chooses levels and hands them to the coder, which otherwise reads them, and what comes after sees the same
 * numbers. So encoder and decoder cannot drift apart, whatever prediction is used. A basis is learnt from the frames
 * and sent as reflections (S 5), which are orthogonal whatever a payload says; low-delay frames use cosines, so that
 * no frame waits for a later one. Positions and moving attributes are tracks of one GOP; positions are coded last,
 * since attributes do not depend on them. Frames are shown in batches, so that a field is read once for several
 * frames. */
#include "codec/sequence/gops.h"

#include "bitstream/coefficients/coefficients.h"
#include "codec/signal/signal.h"

/* How much powers count beside positions; half and twice cost 0.2 to 0.5 %. */
static const double SQUARES = 0.5, CUBES = 0.3, SMALLEST_RADIUS = 0x1p-24;

/* Some columns of a matrix, in a matrix of their own or as part of one, from column `to` on. */
static void copy_columns(ConstDoubles2 from, int64_t first, int64_t count, Doubles2 into, int64_t to) {
    for (int64_t r = 0; count > 0 && r < from.rows; r++)
        memcpy(into.data + r * into.columns + to, from.data + r * from.columns + first,
            (size_t)count * sizeof *from.data);
}

static void gather_rows(ConstDoubles2 field, ConstInts vertices, Doubles2 rows) {
    for (int64_t r = 0; field.columns > 0 && r < vertices.size; r++)
        memcpy(rows.data + r * rows.columns, field.data + vertices.data[r] * field.columns,
            (size_t)field.columns * sizeof *field.data);
}

/* S 3.7. */
typedef struct {
    double center[3], radius;
} Bend;

static Bend bend_of(ConstDoubles2 x) {
    Bend bend = {{0, 0, 0}, 0};
    double n = (double)x.rows;
    for (int64_t r = 0; r < x.rows; r++)
        for (int d = 0; d < 3; d++) bend.center[d] += x.data[3 * r + d];
    for (int d = 0; d < 3; d++) bend.center[d] /= n;
    for (int64_t r = 0; r < x.rows; r++) {
        double a = x.data[3 * r] - bend.center[0], b = x.data[3 * r + 1] - bend.center[1],
               c = x.data[3 * r + 2] - bend.center[2];
        bend.radius += a * a + b * b + c * c;
    }
    bend.radius = __builtin_sqrt(bend.radius / n + SMALLEST_RADIUS);
    return bend;
}

static void fill_bends(Bend bend, ConstDoubles2 x, Doubles2 columns) {
    for (int64_t r = 0; r < x.rows; r++) {
        double own[3], *to = columns.data + r * columns.columns;
        for (int d = 0; d < 3; d++) {
            *to++ = x.data[3 * r + d];
            own[d] = (x.data[3 * r + d] - bend.center[d]) / bend.radius;
        }
        for (int a = 0; a < 3; a++)
            for (int b = a; b < 3; b++) *to++ = SQUARES * bend.radius * own[a] * own[b];
        for (int a = 0; a < 3; a++)
            for (int b = a; b < 3; b++)
                for (int c = b; c < 3; c++) *to++ = CUBES * bend.radius * own[a] * own[b] * own[c];
    }
}

/* Bends and first values at some vertices. */
static bool fill_known(Bend bend, ConstDoubles2 first_frame, const MovingAttribute *moving, int count,
    ConstInts vertices, Arena *scratch, Doubles2 known) {
    Doubles2 places;
    if (!take_doubles2(scratch, vertices.size, 3, &places)) return false;
    gather_rows(first_frame, vertices, places);
    fill_bends(bend, const_doubles2(places), known);
    for (int64_t r = 0; r < vertices.size; r++) {
        double *to = known.data + r * known.columns + BENDING;
        for (int k = 0; k < count; to += moving[k++].width)
            for (int64_t d = 0; d < moving[k].width; d++)
                to[d] = moving[k].start.rows > 0 ? moving[k].start.data[vertices.data[r] * moving[k].width + d] : 0.0;
    }
    return true;
}

/* The known columns of a part: around it, and its differences. */
static bool know_part(Gops *gops, int64_t index, ConstDoubles2 first_frame, const MovingAttribute *moving, int count,
    int64_t columns, Arena *scratch) {
    const Site *part = gops->parts.part + index;
    int64_t n = part->patch.size, ends = part->around.size;
    Singles2 dictionary;
    Doubles2 here, around, expected, differences, places;
    if (!take_doubles2(scratch, n, columns, &here) || !take_doubles2(scratch, ends, columns, &around)
        || !take_doubles2(scratch, n, columns, &expected) || !take_doubles2(scratch, part->width, columns, &differences)
        || !lend_dictionary(&gops->parts, index, scratch, &dictionary) || !take_doubles2(scratch, n, 3, &places))
        return false;
    gather_rows(first_frame, part->patch.vertices, places);
    Bend bend = bend_of(const_doubles2(places));
    if (!fill_known(bend, first_frame, moving, count, part->patch.vertices, scratch, here)
        || !fill_known(bend, first_frame, moving, count, const_ints(part->around), scratch, around)
        || !extend_part(part, const_doubles2(around), scratch, expected))
        return false;
    for (int64_t i = 0; i < n * columns; i++) here.data[i] -= expected.data[i];
    project(const_singles2(dictionary), const_doubles2(here), differences);
    int64_t place = 0;
    for (int k = 0; k < gops->tracks; k++) {
        Doubles2 known = gops->track[k].known;
        copy_columns(const_doubles2(around), place, known.columns, rows_from(known, part->first, ends), 0);
        copy_columns(const_doubles2(differences), place, known.columns,
            rows_from(known, part->first + ends, part->width), 0);
        place += known.columns;
    }
    return true;
}

bool begin_gops(Gops *gops, Context *context, const Header *header, const Graph *graph, const Blocks *blocks,
    ConstInts2 faces, ConstDoubles2 first_frame, int64_t given, const MovingAttribute *moving, int count,
    Arena *scratch) {
    const Arena none = arena_of(context);
    *gops = (Gops){.given = (double)given, .tracks = count + 1, .begun = true, .arena = none, .history = none,
        .levels = none, .frames = none};
    gops->parts = (Parts){.context = context, .header = header, .graph = graph, .blocks = blocks, .arena = &gops->arena,
        .dictionaries = none};
    double work, widths = 0, n = (double)graph->size;
    int64_t columns = BENDING;
    for (int k = 0; k < count; k++) widths += (double)moving[k].width;
    if (!find_parts(&gops->parts, faces, first_frame, scratch) || !reserve_dictionaries(&gops->parts, 0, 0, &work))
        return false;
    gops->memory = TRACK_MEMORY * n * widths + 8 * (BENDING + widths) * gops->parts.around;
    if (!reserve(context, gops->memory, 0) || !TAKE_ZEROS(&gops->arena, gops->tracks, gops->track)) return false;
    for (int k = 0; k <= count; k++) {
        Track *track = gops->track + k;
        track->width = k > 0 ? moving[k - 1].width : 3;
        track->kept = k > 0 ? LEAST_KEPT : frames_kept(graph->size);
        if (!take_doubles2(&gops->arena, gops->parts.rows, k > 0 ? track->width : BENDING, &track->known)) return false;
        track->starts_at_first = k == 0;
        columns += k > 0 ? track->width : 0;
    }
    bool done = true;
    for (int64_t i = 0; done && i < gops->parts.count; i++) {
        Mark mark = mark_of(scratch);
        done = know_part(gops, i, first_frame, moving, count, columns, scratch);
        release_to(scratch, mark);
    }
    return done;
}

void forget_frames(Gops *gops) { gops->can_follow = gops->can_inherit = false; }

void suspend_gops(Gops *gops) {
    if (!gops->begun) return;
    forget_frames(gops);
    release_all(&gops->history);
    release_all(&gops->levels);
    release_all(&gops->frames);
    release_dictionaries(&gops->parts);
}

void end_gops(Gops *gops) {
    if (!gops->begun) return;
    release_all(&gops->history);
    release_all(&gops->levels);
    release_all(&gops->frames);
    release_all(&gops->parts.dictionaries);
    release_all(&gops->arena);
    gops->begun = false;
}

bool time_cosines(int64_t frames, Arena *arena, Doubles2 *columns) {
    Doubles table;
    if (!take_doubles2(arena, frames, frames, columns) || !take_doubles(arena, frames + 8, &table)) return false;
    cosines(table, *columns);
    double scale = __builtin_sqrt(2.0 / (double)frames), first = __builtin_sqrt(1.0 / (double)frames);
    for (int64_t i = 0; i < frames * frames; i++) columns->data[i] = i % frames == 0 ? first : columns->data[i] * scale;
    return true;
}

/* One of the matrices of levels in a payload (S 4), and its reference, which may have no rows. With a lead row 0 has
 * `lead` columns, and each next one `stair` more. */
typedef struct {
    int64_t rows, lead;
    int32_t *levels;
    const int32_t *reference;
    int64_t reference_rows;
} Matrix;

/* Rows that have levels, of those from `from` on; and columns that have some there. */
static int64_t find_levels(ConstInts2 levels, int64_t from, int64_t *few) {
    int64_t rows = 0;
    *few = 0;
    for (int64_t i = from * levels.columns; i < levels.rows * levels.columns; i++) {
        if (levels.data[i] == 0) continue;
        rows = i / levels.columns + 1;
        *few = largest(*few, i % levels.columns + 1);
    }
    return rows;
}

/* Read levels, or write those that are there. */
static bool code_matrices(Context *context, const Bank *bank, Span payload, const Matrix *matrices, int64_t count,
    int64_t columns, int64_t stair, Arena *scratch) {
    Coding coding = {0}; /* or gcc warns at -O3 */
    Longs slow;
    if (!take_longs(scratch, columns, &slow) || !begin_coding(context, payload, &coding)) return false;
    for (int64_t i = 0; i < count && !overran(&coding.coder); i++) {
        const Matrix *m = matrices + i;
        Ints2 levels = {m->levels, m->rows, columns};
        ConstInts2 reference = {m->reference, m->reference_rows, columns};
        int64_t few = 0, bend = (m->rows + 1) / 2, coded = CHOOSES ? find_levels(const_ints2(levels), 0, &few) : 0;
        if (CHOOSES) find_levels(const_ints2(levels), bend, &few);
        if (!room_to_write(&coding, 16 * m->rows * columns + 64)) return false;
        Stairs whole = {coded, columns, 0, bend, few};
        Stairs cut = {coded, least(m->lead, columns), least(stair, columns), m->rows, columns};
        code_matrix(&coding.coder, bank, levels, reference, m->lead > 0 ? &cut : &whole, slow);
    }
    return finish_coding(&coding);
}

/* to += scalar * from. */
static void add_row(double *to, double scalar, const double *from, int64_t count) {
    for (int64_t i = 0; i < count; i++) to[i] += scalar * from[i];
}

/* The basis of levels, d T rows of each, given cosines over time (S 5.2); there is room in all but these. */
static void basis_of_levels(ConstInts2 levels, ConstInts exponents, ConstDoubles2 time, Doubles2 turned, Doubles vector,
    Doubles shares, Doubles2 basis) {
    int64_t frames = time.rows, r = levels.columns, size = frames * r, width = levels.rows / frames;
    for (int64_t c = 0; c < width; c++) {
        int state = 0;
        for (int64_t i = 0; i < size; i++) {
            int32_t level = levels.data[c * size + i], exponent = exponents.data[i % r];
            double step = QUARTERS[exponent & 3];
            for (int32_t e = exponent >> 2; e > 0; e--) step *= 0.5;
            turned.data[(i / r * width + c) * r + i % r] = 0.5 * trellis_point(state, level) * step;
            state = trellis_following(state, level);
        }
    }
    for (int64_t i = 0; i < width * size; i++) basis.data[i] = 0.0;
    turn_columns(turned, vector, shares);
    for (int64_t c = 0; c < width; c++)
        for (int64_t t = 0; t < frames; t++)
            for (int64_t f = 0; f < frames; f++)
                add_row(basis.data + (c * frames + t) * r, time.data[t * frames + f],
                    turned.data + (f * width + c) * r, r);
}

/* The levels nearest to `targets` at the price of bits, from the known columns, and the values that they decode to. */
static bool choose_levels(Context *context, ConstDoubles2 known, ConstDoubles2 targets, ConstInts2 reference,
    int64_t lead, int64_t stair, double step, Doubles2 moments, Doubles2 factor, Arena *scratch, Ints2 levels,
    Doubles2 decoded) {
    const int64_t survivors = 2 * TRELLIS_STATES + 1, coded = targets.columns;
    Doubles row;
    Doubles2 expected, values;
    Ints2 ways;
    Bytes2 origins;
    Longs slow;
    if (!take_doubles(scratch, moments.columns, &row)
        || !take_doubles2(scratch, survivors, moments.columns, &expected)
        || !take_doubles2(scratch, coded, TRELLIS_STATES, &values)
        || !take_ints2(scratch, coded, TRELLIS_STATES, &ways) || !take_bytes2(scratch, coded, TRELLIS_STATES, &origins)
        || !take_longs(scratch, coded, &slow))
        return false;
    search_rows(known, targets, reference, lead, stair, levels, decoded, moments, step, factor, row, expected, values,
        ways, origins, slow);
    for (int64_t i = 0; i < levels.rows * coded; i++)
        if (levels.data[i] >= LARGEST_LEVEL || levels.data[i] <= -LARGEST_LEVEL)
            return FAIL(context, MISUSED, "the step is too fine for motion that far; choose a coarser one");
    return true;
}

/* B: number 0 of all frames, then number 1, and so on (S 5.2, S 5.3). An encoder gives its free parameters in
 * `spectrum`, in steps, stacked by number. */
static bool code_basis(Context *context, const GopField *field, int64_t frames, ConstDoubles2 spectrum, Arena *arena,
    Arena *scratch, Doubles2 *basis) {
    int64_t width = field->width, r = field->components, size = frames * r;
    Mark mark = mark_of(scratch);
    Bank bank;
    Matrix *matrices;
    Ints levels;
    Doubles2 turned, time;
    Doubles vector, shares;
    bool done = take_doubles2(arena, width * frames, r, basis) && make_bank(scratch, MATRIX_BANK, &bank)
        && TAKE(scratch, width, matrices) && zero_ints(scratch, width * size, &levels)
        && take_doubles2(scratch, width * frames, r, &turned) && time_cosines(frames, scratch, &time)
        && take_doubles(scratch, width * frames, &vector) && take_doubles(scratch, r, &shares);
    for (int64_t c = 0; done && c < width; c++)
        matrices[c] = (Matrix){
            frames, c + 1, levels.data + c * size, levels.data + (c > 0 ? c - 1 : 0) * size, c > 0 ? frames : 0};
    for (int64_t c = 0; done && CHOOSES && c < width && spectrum.rows > 0; c++)
        done = choose_levels(context, (ConstDoubles2){NULL, frames, 0},
            (ConstDoubles2){spectrum.data + c * size, frames, r},
            (ConstInts2){matrices[c].reference, matrices[c].reference_rows, r}, c + 1, width, 1.0,
            (Doubles2){NULL, 0, r}, (Doubles2){NULL, 0, r}, scratch, (Ints2){matrices[c].levels, frames, r},
            rows_from(turned, c * frames, frames));
    done = done && code_matrices(context, &bank, field->basis, matrices, width, r, width, scratch);
    if (done)
        basis_of_levels((ConstInts2){levels.data, width * frames, r}, const_ints(field->exponents),
            const_doubles2(time), turned, vector, shares, *basis);
    release_to(scratch, mark);
    return done;
}

/* The targets of an encoder for a part, without rows for a decoder; and the levels that its levels refer to. */
typedef struct {
    Doubles2 targets;
    ConstInts2 reference;
} Goal;

/* A closed loop over the rows of a part (S 6): `decoded` from levels, from the known columns around it and in it. */
static bool follow_loop(Context *context, ConstDoubles2 around, ConstDoubles2 ends, ConstDoubles2 known,
    const Goal *goal, Ints2 levels, double step, Arena *scratch, Doubles2 decoded) {
    int64_t width = known.columns + levels.columns, rows = known.columns + least(levels.columns, INHERITED);
    Mark mark = mark_of(scratch);
    Doubles2 moments, factor;
    Doubles row, expected;
    double spoiled = 0.0;
    bool done = take_doubles2(scratch, rows, width, &moments) && zero_doubles2(scratch, rows, width, &factor)
        && take_doubles(scratch, width, &row) && take_doubles(scratch, width, &expected);
    if (done) learn_around(around, ends, moments, step, expected, row);
    if (done && CHOOSES && goal->targets.rows > 0)
        done = choose_levels(context, known, const_doubles2(goal->targets), goal->reference, levels.columns, 0, step,
            moments, factor, scratch, levels, decoded);
    else if (done) follow_rows(known, const_ints2(levels), decoded, moments, step, factor, row, expected);
    for (int64_t i = 0; done && i < decoded.rows * decoded.columns; i++) spoiled += decoded.data[i] * 0.0;
    release_to(scratch, mark);
    return done
        && (spoiled == 0.0 || FAIL(context, NUMERIC, "the levels reconstruct to coefficients that are not finite"));
}

/* Columns of two matrices side by side. */
static bool join_columns(Doubles2 one, Doubles2 other, Arena *scratch, Doubles2 *both) {
    *both = one;
    if (other.columns == 0) return true;
    if (!take_doubles2(scratch, one.rows, one.columns + other.columns, both)) return false;
    copy_columns(const_doubles2(one), 0, one.columns, *both, 0);
    copy_columns(const_doubles2(other), 0, other.columns, *both, one.columns);
    return true;
}

/* The coded values of each part, in turn. */
typedef struct {
    const Gop *gop;
    Ints *levels;        /* of each track */
    Doubles2 *found;     /* of each track: what is inherited, or what low-delay frames are; stacked rows */
    Doubles2 time;
} GopContext;

/* Differences of a part in a learned field (S 7.1), which is `ends` around it. */
static bool code_learned_part(Gops *gops, const GopContext *decoding, int k, const Site *part, ConstDoubles2 ends,
    const Goal *goal, Ints2 levels, Arena *scratch, Doubles2 differences) {
    const GopField *field = decoding->gop->field + k;
    Track *track = gops->track + k;
    int64_t m = ends.rows, c = part->width;
    Doubles2 before = decoding->gop->method == LEARNED_NEXT ? track->inherited : (Doubles2){NULL, gops->parts.rows, 0};
    Doubles2 known, found = decoding->found[k];
    if (!join_columns(rows_from(track->known, part->first, m + c), rows_from(before, part->first, m + c), scratch,
            &known))
        return false;
    if (field->components > 0
        && !follow_loop(gops->parts.context, const_doubles2(rows_from(known, 0, m)), ends,
            const_doubles2(rows_from(known, m, c)), goal, levels, field->step, scratch, differences))
        return false;
    copy_columns(ends, 0, found.columns, rows_from(found, part->first, m), 0);
    copy_columns(const_doubles2(differences), 0, found.columns, rows_from(found, part->first + m, c), 0);
    return true;
}

/* The frame that is `age` before the GOP, and the first one before all. */
static const double *kept_frame(const Track *track, int64_t age) {
    return track->ring[(track->latest + least(age, track->count - 1)) % track->kept].data;
}

/* The values that low-delay frames start from, in stacked rows from `first` on (S 7.2). */
static void fill_base(const Track *track, const GopField *field, ConstDoubles2 time, int64_t first, Doubles2 base) {
    int64_t width = track->width;
    for (int64_t i = 0; i < base.rows * base.columns; i++) base.data[i] = 0.0;
    for (int64_t t = 0; t < time.rows; t++) {
        const double *begun = kept_frame(track, field->back > 0 ? field->back - 1 - t : 0) + first * width;
        for (int64_t r = 0; r < base.rows; r++)
            for (int64_t f = 0; f < time.rows; f++)
                for (int64_t d = 0; d < width; d++)
                    base.data[r * base.columns + f * width + d] += begun[r * width + d] * time.data[t * time.rows + f];
    }
}

/* The known columns of low-delay frames, in some stacked rows (S 7.2). */
static void fill_references(const Track *track, const GopField *field, int64_t first, Doubles2 known) {
    int64_t width = track->width, lags = lags_of(track->kept);
    const double *latest = kept_frame(track, 0);
    for (int64_t r = 0; r < known.rows; r++) {
        double *to = known.data + r * known.columns;
        int64_t row = first + r;
        for (int64_t d = 0; d < width; d++) *to++ = track->known.data[row * track->known.columns + d];
        for (int64_t d = 0; d < width; d++) *to++ = latest[row * width + d];
        for (int64_t i = 0; i < lags; i++) {
            const double *late = kept_frame(track, i > 0 ? LAG[i - 1] : 0), *early = kept_frame(track, LAG[i]);
            for (int64_t d = 0; d < width; d++) *to++ = late[row * width + d] - early[row * width + d];
        }
        if (field->back == 0) continue;
        const double *back = kept_frame(track, field->back - 1);
        for (int64_t d = 0; d < width; d++) *to++ = back[row * width + d] - latest[row * width + d];
    }
}

/* Code a part of low-delay frames, as cosines over time. */
static bool code_next_part(Gops *gops, const GopContext *decoding, int k, const Site *part, ConstDoubles2 ends,
    const Goal *goal, Ints2 levels, Arena *scratch, Doubles2 differences) {
    const GopField *field = decoding->gop->field + k;
    Track *track = gops->track + k;
    int64_t m = ends.rows, c = part->width, columns = ends.columns;
    Doubles2 own = rows_from(decoding->found[k], part->first, m + c), inside = rows_from(own, m, c);
    fill_base(track, field, const_doubles2(decoding->time), part->first, own);
    if (field->components > 0) {
        int64_t wide = track->width * (2 + lags_of(track->kept) + (field->back > 0));
        Doubles2 known, changes;
        if (!take_doubles2(scratch, m + c, wide, &known) || !take_doubles2(scratch, m, columns, &changes)) return false;
        fill_references(track, field, part->first, known);
        for (int64_t i = 0; i < m * columns; i++) changes.data[i] = ends.data[i] - own.data[i];
        for (int64_t i = 0; CHOOSES && i < goal->targets.rows * columns; i++) goal->targets.data[i] -= inside.data[i];
        if (!follow_loop(gops->parts.context, const_doubles2(rows_from(known, 0, m)), const_doubles2(changes),
                const_doubles2(rows_from(known, m, c)), goal, levels, field->step, scratch, differences))
            return false;
        for (int64_t i = 0; i < c * columns; i++) inside.data[i] += differences.data[i];
        copy_columns(ends, 0, columns, own, 0);
    }
    copy_columns(const_doubles2(inside), 0, columns, differences, 0);
    return true;
}

/* The levels that those of a part refer to, which begin at row `begin`: of the part before, or there before. */
static ConstInts2 reference_of(const Gops *gops, const GopContext *decoding, int64_t index, int64_t begin) {
    int64_t columns = gops->basis->columns, rows = gops->parts.part[index].width;
    if (!has_basis(decoding->gop)) return (ConstInts2){gops->track->levels.data + begin * columns, rows, columns};
    rows = index > 0 ? gops->parts.part[index - 1].width : 0;
    return (ConstInts2){decoding->levels->data + (begin - rows) * columns, rows, columns};
}

/* Fill a part of the field from its coded values, or from those that an encoder chooses. */
static bool place_part(Gops *gops, const GopContext *decoding, int64_t index, int64_t *begin, Arena *scratch) {
    const Site *part = gops->parts.part + index;
    int64_t n = part->patch.size, m = part->around.size, c = part->width, total = gops->field.columns, place = 0;
    Singles2 dictionary;
    Doubles2 around, differences, positions, extension;
    Goal goal = {.targets = {NULL, 0, total}};
    if (!lend_dictionary(&gops->parts, index, scratch, &dictionary) || !take_doubles2(scratch, m, total, &around)
        || !take_doubles2(scratch, c, total, &differences) || !take_doubles2(scratch, n, total, &positions)
        || !take_doubles2(scratch, n, total, &extension))
        return false;
    gather_rows(const_doubles2(gops->field), const_ints(part->around), around);
    if (total > 0 && !extend_part(part, const_doubles2(around), scratch, extension)) return false;
    if (chooses(gops)) {
        if (!take_doubles2(scratch, c, total, &goal.targets)) return false;
        gather_rows(gops->wanted, part->patch.vertices, positions);
        for (int64_t i = 0; i < n * total; i++) positions.data[i] -= extension.data[i];
        project(const_singles2(dictionary), const_doubles2(positions), goal.targets);
        goal.reference = reference_of(gops, decoding, index, *begin);
    }
    for (int k = 0; k < gops->tracks; k++) {
        int64_t columns = gops->basis[k].columns;
        Mark mark = mark_of(scratch);
        Doubles2 ends, own;
        if (!take_doubles2(scratch, m, columns, &ends) || !take_doubles2(scratch, c, columns, &own)) return false;
        copy_columns(const_doubles2(around), place, columns, ends, 0);
        Ints2 levels = {decoding->levels[k].data + *begin * columns, c, columns};
        bool done = (has_basis(decoding->gop) ? code_learned_part : code_next_part)(gops, decoding, k, part,
            const_doubles2(ends), &goal, levels, scratch, own);
        if (!done) return false;
        copy_columns(const_doubles2(own), 0, columns, differences, place);
        place += columns;
        release_to(scratch, mark);
    }
    *begin += c;
    if (total == 0) return true;
    reconstruct(const_singles2(dictionary), const_doubles2(differences), positions);
    for (int64_t r = 0; r < n; r++)
        for (int64_t j = 0; j < total; j++)
            gops->field.data[part->patch.vertices.data[r] * total + j] =
                positions.data[r * total + j] + extension.data[r * total + j];
    return true;
}

static bool place_parts(Gops *gops, const GopContext *decoding, Arena *scratch) {
    int64_t begin = 0;
    bool done = true;
    for (int64_t i = 0; done && i < gops->parts.count; i++) {
        Mark mark = mark_of(scratch);
        done = place_part(gops, decoding, i, &begin, scratch);
        release_to(scratch, mark);
    }
    return done;
}

static int64_t coded_rows(const Gops *gops) {
    int64_t rows = 0;
    for (int64_t i = 0; i < gops->parts.count; i++) rows += gops->parts.part[i].width;
    return rows;
}

/* The levels of all parts in a field, whose references are the parts before, or the same parts of frames before. */
static bool code_levels_of(Gops *gops, const GopContext *decoding, int k, Arena *scratch) {
    Track *track = gops->track + k;
    bool learned = has_basis(decoding->gop);
    int64_t begin = 0, columns = gops->basis[k].columns;
    Mark mark = mark_of(scratch);
    Matrix *matrices;
    Bank bank = track->bank;
    if (!TAKE(scratch, gops->parts.count, matrices) || (learned && !make_bank(scratch, MATRIX_BANK, &bank)))
        return false;
    for (int64_t i = 0; i < gops->parts.count; i++) {
        int64_t rows = gops->parts.part[i].width, earlier = i > 0 ? gops->parts.part[i - 1].width : 0;
        int32_t *own = decoding->levels[k].data + begin * columns;
        matrices[i] = learned ? (Matrix){rows, 0, own, own - earlier * columns, earlier}
                              : (Matrix){rows, 0, own, track->levels.data + begin * columns, rows};
        begin += rows;
    }
    bool done = code_matrices(gops->parts.context, &bank, decoding->gop->field[k].levels, matrices, gops->parts.count,
        columns, 0, scratch);
    release_to(scratch, mark);
    return done;
}

/* Make room for the field of a GOP, and for batches of its frames. */
static bool begin_field(Gops *gops, const Gop *gop) {
    int64_t columns = 0, n = gops->parts.graph->size, shown = least(gop->frames, BATCH);
    for (int k = 0; k < gops->tracks; k++) columns += gops->basis[k].columns;
    gops->batched = -1;
    if (!zero_doubles2(&gops->frames, n, columns, &gops->field) || !TAKE(&gops->frames, gops->tracks, gops->batch))
        return false;
    for (int k = 0; k < gops->tracks; k++)
        if (!take_doubles2(&gops->frames, shown * n, gops->track[k].width, gops->batch + k)) return false;
    return true;
}

/* The basis of low-delay frames: each cosine by itself in one number after the other. */
static bool hold_cosines(int64_t width, ConstDoubles2 time, Arena *arena, Doubles2 *basis) {
    if (!zero_doubles2(arena, width * time.rows, width * time.rows, basis)) return false;
    for (int64_t d = 0; d < width; d++)
        for (int64_t t = 0; t < time.rows; t++)
            for (int64_t f = 0; f < time.rows; f++)
                basis->data[(d * time.rows + t) * basis->columns + f * width + d] = time.data[t * time.rows + f];
    return true;
}

static bool find_basis(Gops *gops, const GopContext *decoding, int k, Arena *scratch) {
    const Gop *gop = decoding->gop;
    const GopField *field = gop->field + k;
    Doubles2 *basis = gops->basis + k;
    if (!has_basis(gop)) return hold_cosines(field->width, const_doubles2(decoding->time), &gops->frames, basis);
    *basis = (Doubles2){NULL, field->width * gop->coded, field->components};
    return field->step == 0 || chooses(gops)
        || code_basis(gops->parts.context, field, gop->coded, (ConstDoubles2){NULL, 0, 0}, &gops->frames, scratch,
            basis);
}

/* Code the fields of a GOP: the positions come last in the payload. */
static bool code_fields(Gops *gops, GopContext *decoding, Arena *scratch) {
    const Gop *gop = decoding->gop;
    bool learned = has_basis(gop), choosing = chooses(gops);
    if (!TAKE(scratch, gops->tracks, decoding->levels) || !TAKE(scratch, gops->tracks, decoding->found)) return false;
    for (int i = 1; i <= gops->tracks; i++) {
        int k = i % gops->tracks;
        if (!find_basis(gops, decoding, k, scratch)) return false;
        int64_t columns = gops->basis[k].columns;
        if (!zero_ints(scratch, coded_rows(gops) * columns, decoding->levels + k)
            || !take_doubles2(scratch, gops->parts.rows, learned ? least(columns, INHERITED) : columns,
                decoding->found + k)
            || (gop->field[k].step > 0 && !choosing && !code_levels_of(gops, decoding, k, scratch)))
            return false;
    }
    return begin_field(gops, gop) && place_parts(gops, decoding, scratch)
        && (!choosing || code_levels_of(gops, decoding, 0, scratch));
}

static bool code_learned(Gops *gops, const Gop *gop, Arena *scratch) {
    GopContext decoding = {.gop = gop};
    if (gop->method == LEARNED_NEXT && !gops->can_inherit)
        return FAIL(gops->parts.context, CORRUPT, "a GOP refers to a missing GOP");
    forget_frames(gops);
    if (!code_fields(gops, &decoding, scratch)) return false;
    release_all(&gops->history);
    for (int k = 0; k < gops->tracks; k++) {
        Doubles2 found = decoding.found[k], *inherited = &gops->track[k].inherited;
        if (!take_doubles2(&gops->history, gops->parts.rows, found.columns, inherited)) return false;
        copy_columns(const_doubles2(found), 0, found.columns, *inherited, 0);
    }
    gops->can_inherit = true;
    return true;
}

/* Key frames begin a history of their own, with the first frame (S 7.3, S 10.3). */
static bool begin_history(Gops *gops) {
    release_all(&gops->history);
    gops->together = 0;
    for (int k = 0; k < gops->tracks; k++) {
        Track *track = gops->track + k;
        memset(track->ring, 0, sizeof track->ring);
        track->latest = 0;
        track->count = 1;
        if (!make_bank(&gops->history, MATRIX_BANK, &track->bank)
            || !zero_doubles(&gops->history, gops->parts.rows * track->width, track->ring))
            return false;
        if (track->starts_at_first)
            copy_columns(const_doubles2(track->known), 0, track->width,
                (Doubles2){track->ring[0].data, gops->parts.rows, track->width}, 0);
    }
    return true;
}

/* Make frames the latest (S 7.2): `spectra` are of all stacked rows, as cosines over time. */
static bool keep_frames(Gops *gops, Track *track, ConstDoubles2 time, ConstDoubles2 spectra) {
    int64_t width = track->width, frames = time.rows;
    for (int64_t t = largest(0, frames - track->kept); t < frames; t++) {
        track->latest = (track->latest + track->kept - 1) % track->kept;
        Doubles *frame = track->ring + track->latest;
        if (frame->data == NULL && !take_doubles(&gops->history, gops->parts.rows * width, frame)) return false;
        for (int64_t r = 0; r < gops->parts.rows; r++)
            for (int64_t d = 0; d < width; d++) {
                double sum = 0.0;
                for (int64_t f = 0; f < frames; f++)
                    sum += spectra.data[r * spectra.columns + f * width + d] * time.data[t * frames + f];
                frame->data[r * width + d] = sum;
            }
        track->count = least(track->count + 1, track->kept);
    }
    return true;
}

static bool code_next(Gops *gops, const Gop *gop, Arena *scratch) {
    Context *context = gops->parts.context;
    GopContext decoding = {.gop = gop};
    if (gop->method == KEY_FRAMES) {
        if (!begin_history(gops)) return false;
    } else if (!gops->can_follow) {
        forget_frames(gops);
        return FAIL(context, CORRUPT, "a frame refers to a missing frame");
    }
    forget_frames(gops);
    if (gops->together != gop->frames) release_all(&gops->levels);
    for (int k = 0; k < gops->tracks; k++) {
        Track *track = gops->track + k;
        int64_t back = gop->field[k].back, size = coded_rows(gops) * track->width * gop->frames;
        if (back > track->count)
            return FAIL(context, CORRUPT, "a frame refers # frames back, where # are kept", back, track->count);
        if (gops->together != gop->frames && !zero_ints(&gops->levels, size, &track->levels)) return false;
    }
    if (!time_cosines(gop->frames, &gops->frames, &decoding.time) || !code_fields(gops, &decoding, scratch))
        return false;
    gops->together = gop->frames;
    for (int k = 0; k < gops->tracks; k++) {
        Track *track = gops->track + k;
        memcpy(track->levels.data, decoding.levels[k].data, (size_t)track->levels.size * sizeof *track->levels.data);
        if (!keep_frames(gops, track, const_doubles2(decoding.time), const_doubles2(decoding.found[k]))) return false;
    }
    gops->can_follow = true;
    return true;
}

bool decode_gop(Gops *gops, const Gop *gop, Arena *scratch) {
    release_all(&gops->frames);
    gops->gop = *gop;
    Longs shown;
    if (!TAKE(&gops->frames, gops->tracks, gops->basis) || !take_longs(&gops->frames, gop->frames, &shown))
        return false;
    memcpy(shown.data, gop->shown.data, (size_t)gop->frames * sizeof *shown.data);
    gops->gop.shown = shown;
    Mark mark = mark_of(scratch);
    bool done = (has_basis(gop) ? code_learned : code_next)(gops, gop, scratch);
    release_to(scratch, mark);
    return done;
}

static bool show_batch(Gops *gops, int64_t first, Arena *scratch) {
    int64_t shown = least(BATCH, gops->gop.frames - first), n = gops->parts.graph->size, place = 0;
    for (int k = 0; k < gops->tracks; k++) {
        Doubles2 basis = gops->basis[k], weights;
        int64_t width = gops->track[k].width, coded = basis.rows / width;
        Mark mark = mark_of(scratch);
        if (!zero_doubles2(scratch, basis.columns, width * BATCH, &weights)) return false;
        for (int64_t i = 0; i < basis.columns; i++)
            for (int64_t d = 0; d < width; d++)
                for (int64_t t = 0; t < shown; t++)
                    weights.data[i * weights.columns + d * BATCH + t] =
                        basis.data[(d * coded + gops->gop.shown.data[first + t]) * basis.columns + i];
        show_frames(const_doubles2(gops->field), place, const_doubles2(weights),
            (Doubles2){gops->batch[k].data, shown * n, width});
        release_to(scratch, mark);
        place += basis.columns;
    }
    gops->batched = first;
    return true;
}

bool show_frame(Gops *gops, int64_t t, Arena *scratch, int track, ConstDoubles2 *frame) {
    if (gops->batched != t - t % BATCH && !show_batch(gops, t - t % BATCH, scratch)) return false;
    *frame =
        const_doubles2(rows_from(gops->batch[track], t % BATCH * gops->parts.graph->size, gops->parts.graph->size));
    return true;
}

#ifdef BSMDEC_WRITES
bool copy_gops(const Gops *from, int k, Context *context, Arena *arena, Gops *copy) {
    const Track *given = from->track + k;
    Track *own;
    *copy = *from;
    copy->parts.context = context;
    copy->arena = copy->parts.dictionaries = copy->history = copy->levels = copy->frames = arena_of(context);
    copy->tracks = 1;
    if (!TAKE(arena, 1, own)) return false;
    copy->track = own;
    *own = *given;
    int64_t size = from->parts.rows * given->width;
    if (from->can_inherit) {
        Doubles2 known = given->inherited;
        if (!take_doubles2(&copy->history, known.rows, known.columns, &own->inherited)) return false;
        copy_columns(const_doubles2(known), 0, known.columns, own->inherited, 0);
    }
    if (!from->can_follow) return true;
    if (!make_bank(&copy->history, MATRIX_BANK, &own->bank)
        || !take_ints(&copy->levels, given->levels.size, &own->levels))
        return false;
    const BankPlan *plan = &MATRIX_BANK;
    memcpy(own->bank.slots, given->bank.slots, (size_t)plan->slots * sizeof(uint32_t));
    memcpy(own->bank.weights, given->bank.weights, (size_t)(plan->selectors * plan->inputs) * sizeof(int32_t));
    memcpy(own->levels.data, given->levels.data, (size_t)own->levels.size * sizeof(int32_t));
    for (int64_t t = 0; t < MOST_KEPT; t++) {
        if (given->ring[t].data == NULL) continue;
        if (!take_doubles(&copy->history, size, own->ring + t)) return false;
        memcpy(own->ring[t].data, given->ring[t].data, (size_t)size * sizeof(double));
    }
    return true;
}

bool write_basis(Gops *gops, GopField field, int64_t frames, ConstDoubles2 spectrum, Payload *writing, Arena *scratch,
    Doubles2 *basis) {
    gops->parts.context->writing = writing;
    release_all(&gops->frames);
    bool done = code_basis(gops->parts.context, &field, frames, spectrum, &gops->frames, scratch, basis);
    gops->parts.context->writing = NULL;
    return done;
}

bool write_gop(Gops *gops, int method, int64_t frames, GopField field, ConstDoubles2 wanted, Payload *writing,
    Arena *scratch) {
    Gop gop = {.method = method, .frames = frames, .coded = frames, .count = 1, .field = &field};
    if (!take_longs(scratch, frames, &gop.shown)) return false;
    for (int64_t t = 0; t < frames; t++) gop.shown.data[t] = t;
    gops->wanted = wanted;
    gops->parts.context->writing = writing;
    bool done = decode_gop(gops, &gop, scratch);
    gops->parts.context->writing = NULL;
    gops->wanted = (ConstDoubles2){NULL, 0, 0};
    return done;
}
#endif
