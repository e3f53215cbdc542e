/* Which float of the cell of a grid each coordinate is (specification, V 16). */
#include "bitstream/fields/floats.h"

#include "bitstream/fields/value.h"

enum { AXES = 3, HISTORIES = 8, SLOTS = HISTORIES + 1, LATEST = 43 };
static const int64_t NO_FLOAT = (int64_t)1 << 40;

/* Code the numbers of floats, from `low` to below `high`, of so many values of a grid, as far as there is room (writing) or
 * sense (reading): each may be the latest of its value, or else, where the value is new, the `nearest` to its place. Returns of
 * how many vertices. */
int64_t code_floats(Coder given, Floats f, ConstInts2 values, ConstLongs2 low, ConstLongs2 nearest, ConstLongs2 high,
                    Longs2 chosen) {
    RangeCoder coder;
    int64_t rows = values.rows, done = 0;
    if (!open_coder(&coder, given) || values.columns != AXES || low.columns != AXES || nearest.columns != AXES || high.columns != AXES
        || chosen.columns != AXES || low.rows != rows || nearest.rows != rows || high.rows != rows || chosen.rows != rows
        || f.slots.size != AXES * SLOTS || f.latest.size != AXES || f.known.rows != AXES)
        return MISUSED;
    for (int64_t i = 0; i < AXES * rows; i++)
        if (values.data[i] < 0 || values.data[i] >= f.known.columns) return MISUSED;
    for (; done < rows && has_room(&coder, AXES * VALUE_BYTES) && !overran(&coder); done++) {
        for (int j = 0; j < AXES; j++) {
            int64_t at = AXES * done + j, count = high.data[at] - low.data[at], *float_ = chosen.data + at;
            if (count <= 0 || count > UINT32_MAX) goto end;
            int64_t *known = f.known.data + j * f.known.columns + values.data[at];
            int64_t *latest = f.latest.data + j;
            bool new = *known == NO_FLOAT;
            int64_t guess = new ? nearest.data[at] : *known;
            uint32_t *slot = f.slots.data + SLOTS * j + (new ? HISTORIES : *latest & (HISTORIES - 1));
            int same = code_bit(&coder, (uint32_t)largest(*slot >> (32 - ONE_BITS), 1), *float_ == guess);
            learn_slot(slot, same, LATEST);
            if (!new) *latest = (2 * *latest + same) & (HISTORIES - 1);
            *float_ = same ? guess : low.data[at] + code_uniform(&coder, *float_ - low.data[at], count);
            *known = *float_;
        }
    }
end:
    close_coder(&coder, given);
    return done;
}
