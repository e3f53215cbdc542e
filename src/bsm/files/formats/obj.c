/* OBJ files as nearly all programs write them, in one pass over their bytes; others are left to a slower reader. */
#include "src/bsm/files/formats/obj.h"

/* Powers of ten that are doubles, digits of a number that 64 bits hold, and the whole numbers that are doubles. */
enum { POWERS = 23, DIGITS = 19, REFERENCE_DIGITS = 15, MOST_POWER = 10000 };
static const double TENS[POWERS] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14,
    1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
static const uint64_t EXACT = (uint64_t)1 << 53;

typedef struct {
    const uint8_t *at, *end; /* the rest of a line */
} Line;

INLINE bool is_space(uint8_t c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

INLINE bool is_digit(uint8_t c) { return c >= '0' && c <= '9'; }

INLINE bool skip_spaces(Line *line) {
    while (line->at < line->end && is_space(*line->at)) line->at++;
    return line->at < line->end;
}

/* Passes over a sign; whether it was a minus. */
INLINE bool skip_sign(Line *line) {
    bool is_minus = line->at < line->end && *line->at == '-';
    if (line->at < line->end && (*line->at == '-' || *line->at == '+')) line->at++;
    return is_minus;
}

/* Whether a word is a decimal number. It is `hard` if one product or quotient may not be the nearest double. */
static bool read_number(Line *line, double *number, bool *hard) {
    bool is_minus = skip_sign(line), is_after = false, has_digits = false;
    uint64_t whole = 0;
    int64_t power = 0, digits = 0;
    for (; line->at < line->end; line->at++) {
        uint8_t c = *line->at;
        if (c == '.' && !is_after) {
            is_after = true;
            continue;
        }
        if (!is_digit(c)) break;
        has_digits = true;
        digits += whole || c != '0';
        if (digits <= DIGITS) whole = 10 * whole + (uint64_t)(c - '0');
        power -= is_after;
    }
    if (!has_digits) return false;
    if (line->at < line->end && (*line->at == 'e' || *line->at == 'E')) {
        line->at++;
        bool is_small = skip_sign(line);
        int64_t written = 0;
        if (line->at >= line->end || !is_digit(*line->at)) return false;
        for (; line->at < line->end && is_digit(*line->at); line->at++)
            if (written < MOST_POWER) written = 10 * written + (*line->at - '0');
        power += is_small ? -written : written;
    }
    if (line->at < line->end && !is_space(*line->at)) return false;
    *hard = whole && (digits > DIGITS || whole > EXACT || power >= POWERS || power <= -POWERS);
    double value = (double)whole;
    if (whole && !*hard) value = power < 0 ? value / TENS[-power] : value * TENS[power];
    *number = is_minus ? -value : value;
    return true;
}

/* The numbers of a line; whether there are as many as in the first one of its kind. */
static bool read_row(Line *line, const uint8_t *text, int kind, bool fills, int64_t *counts, ObjLines *lines) {
    Doubles2 tables[3] = {lines->points, lines->texcoords, lines->normals}, table = tables[kind];
    int64_t row = counts[2 * kind], columns = counts[2 * kind + 1], count = 0;
    for (; skip_spaces(line); count++) {
        const uint8_t *begin = line->at;
        double number;
        bool hard;
        if ((row && count >= columns) || !read_number(line, &number, &hard)) return false;
        if (fills) {
            if (row >= table.rows || count >= table.columns) return false;
            table.data[row * table.columns + count] = number;
        }
        if (!hard) continue;
        if (fills) {
            if (counts[WORDS] >= lines->words.rows) return false;
            int64_t *word = lines->words.data + 4 * counts[WORDS];
            word[0] = kind, word[1] = row * table.columns + count, word[2] = begin - text, word[3] = line->at - text;
        }
        counts[WORDS]++;
    }
    if (!count || (row && count != columns)) return false;
    counts[2 * kind]++, counts[2 * kind + 1] = count;
    return true;
}

/* A whole number of a reference, which ends at a slash or at the end of a word. */
static bool read_reference(Line *line, int64_t *number) {
    bool is_minus = skip_sign(line);
    int64_t digits = 0, whole = 0;
    for (; line->at < line->end && is_digit(*line->at) && digits < REFERENCE_DIGITS; digits++)
        whole = 10 * whole + (*line->at++ - '0');
    *number = is_minus ? -whole : whole;
    return digits > 0 && (line->at == line->end || is_space(*line->at) || *line->at == '/');
}

/* The corners of a face, each written v, v/vt, v//vn or v/vt/vn; a negative number counts back from here. */
static bool read_face(Line *line, ConstLongs seen, bool fills, int64_t *counts, ObjLines *lines) {
    int64_t count = 0, present[3];
    Longs places[3] = {lines->point, lines->texcoord, lines->normal};
    for (int k = 0; k < 3; k++) present[k] = counts[2 * k] + seen.data[k];
    for (; skip_spaces(line); count++) {
        for (int k = 0; k < 3; k++) {
            int64_t written = 0;
            if (k && line->at < line->end && *line->at == '/') {
                line->at++;
                bool is_empty = line->at == line->end || is_space(*line->at) || *line->at == '/';
                if (!is_empty && !read_reference(line, &written)) return false;
            } else if (!k && (!read_reference(line, &written) || !written)) {
                return false;
            }
            if (k && written) counts[k == 1 ? WITH_TEXCOORDS : WITH_NORMALS]++;
            if (!fills || !places[k].size) continue;
            if (counts[CORNERS] >= places[k].size) return false;
            int64_t place = written > 0 ? written - 1 : written + present[k];
            places[k].data[counts[CORNERS]] = written ? place : NO_REFERENCE;
        }
        if (line->at < line->end && !is_space(*line->at)) return false;
        counts[CORNERS]++;
    }
    if (fills) {
        if (counts[FACES] >= lines->sizes.size) return false;
        lines->sizes.data[counts[FACES]] = count;
    }
    counts[FACES]++;
    return true;
}

/* Counts the lines of a text, and what they hold; or `fills` arrays that are as large as an earlier call counted.
 * `seen`: points, texture coordinates and normals before the text. Returns 0, or 1 if a line is not plain. */
int64_t scan_obj(ConstBytes text, ConstLongs seen, bool fills, Longs counts, ObjLines lines) {
    if (seen.size != 3 || counts.size != OBJ_COUNTS) return MISUSED;
    if (fills && (lines.others.columns != 3 || lines.words.columns != 4)) return MISUSED;
    int64_t *counted = counts.data;
    for (int k = 0; k < OBJ_COUNTS; k++) counted[k] = 0;
    const uint8_t *end = text.data + text.size;
    for (const uint8_t *begin = text.data; begin < end;) {
        Line line = {begin, begin};
        while (line.end < end && *line.end != '\n' && *line.end != '\r') line.end++;
        const uint8_t *next = line.end + 1, *start = begin;
        begin = next;
        if (!skip_spaces(&line) || *line.at == '#') continue;
        const uint8_t *word = line.at;
        while (line.at < line.end && !is_space(*line.at)) line.at++;
        int64_t letters = line.at - word;
        bool is_plain = true;
        if (word[0] == 'v' && letters == 1)
            is_plain = read_row(&line, text.data, 0, fills, counted, &lines);
        else if (word[0] == 'v' && letters == 2 && (word[1] == 't' || word[1] == 'n'))
            is_plain = read_row(&line, text.data, word[1] == 't' ? 1 : 2, fills, counted, &lines);
        else if (word[0] == 'f' && letters == 1)
            is_plain = read_face(&line, seen, fills, counted, &lines);
        else {
            if (fills) {
                if (counted[OTHERS] >= lines.others.rows) return 1;
                int64_t *other = lines.others.data + 3 * counted[OTHERS];
                other[0] = counted[FACES], other[1] = start - text.data, other[2] = line.end - text.data;
            }
            counted[OTHERS]++;
        }
        if (!is_plain) return 1;
    }
    return 0;
}
