/* One zstd frame without its magic number, of a content whose size is known (specification, F 6.2; RFC 8878). */
#include "bitstream/payloads/payloads.h"

enum { MOST_WINDOW = 1 << 23, MOST_BLOCK = 1 << 17, MOST_BITS = 11, MOST_LOG = 9, MOST_SYMBOLS = 256 };
enum { RAW, RLE, PACKED, REPEAT };

/* A table of finite state entropy: the symbol of a state, and the base and number of bits of the next state. */
typedef struct {
    uint8_t symbol[1 << MOST_LOG], bits[1 << MOST_LOG];
    uint16_t base[1 << MOST_LOG];
    int log; /* -1: no table */
} StateTable;

typedef struct {
    uint8_t symbol[1 << MOST_BITS], bits[1 << MOST_BITS];
    int log; /* 0: no table */
} PrefixTable;

typedef struct {
    StateTable lengths, offsets, matches, weights;
    PrefixTable prefixes;
    uint8_t *literals, *content;
    int64_t literal_count, size, done;
    uint64_t latest[3];
} Unpacker;

/* Bits from the last one to the first, after a 1 that ends them; below the first they are 0. */
typedef struct {
    const uint8_t *data;
    int64_t left;
} Bits;

static bool open_bits(Span bytes, Bits *bits) {
    if (bytes.size == 0 || bytes.data[bytes.size - 1] == 0) return false;
    *bits = (Bits){bytes.data, 8 * bytes.size - __builtin_clz(bytes.data[bytes.size - 1]) + 23};
    return true;
}

/* `count` bits, at most 31, from bit `at` on. */
static uint64_t bits_at(const uint8_t *data, int64_t at, int count) {
    uint64_t value = 0;
    for (int k = 0; k < count; k++)
        if (at + k >= 0) value |= (uint64_t)(data[(at + k) >> 3] >> ((at + k) & 7) & 1) << k;
    return value;
}

static uint64_t take_bits(Bits *bits, int count) {
    bits->left -= count;
    return bits_at(bits->data, bits->left, count);
}

static int log_of(uint64_t x) { return 63 - __builtin_clzll(x); }

/* Of counts of symbols, -1 for less than one, that are 2^log together. */
static bool make_states(const int16_t *counts, int symbols, int log, StateTable *table) {
    int size = 1 << log, high = size - 1, place = 0, step = (size >> 1) + (size >> 3) + 3;
    uint16_t next[MOST_SYMBOLS];
    for (int s = 0; s < symbols; s++) {
        next[s] = (uint16_t)(counts[s] < 0 ? 1 : counts[s]);
        if (counts[s] < 0) table->symbol[high--] = (uint8_t)s;
    }
    for (int s = 0; s < symbols; s++)
        for (int i = 0; i < counts[s]; i++) {
            table->symbol[place] = (uint8_t)s;
            do place = (place + step) & (size - 1);
            while (place > high);
        }
    if (place != 0) return false;
    for (int state = 0; state < size; state++) {
        uint16_t number = next[table->symbol[state]]++;
        table->bits[state] = (uint8_t)(log - log_of(number));
        table->base[state] = (uint16_t)((number << table->bits[state]) - size);
    }
    table->log = log;
    return true;
}

/* A table that bytes describe, and how many bytes that takes; 0 for none. */
static int64_t read_states(Span bytes, int most_log, int most_symbol, StateTable *table) {
    int16_t counts[MOST_SYMBOLS] = {0};
    int64_t at = 4, end = 8 * bytes.size;
    if (bytes.size == 0) return 0;
    int log = 5 + (bytes.data[0] & 15), symbol = 0, left = 1 << log;
    if (log > most_log) return 0;
    while (left > 0 && symbol <= most_symbol) {
        int size = log_of((uint64_t)left + 1) + 1;
        uint64_t low = (UINT64_C(1) << (size - 1)) - 1, few = (UINT64_C(1) << size) - 1 - (uint64_t)(left + 1),
                 value = 0;
        for (int k = 0; k < size; k++)
            if (at + k < end) value |= bits_at(bytes.data, at + k, 1) << k;
        at += size;
        if ((value & low) < few) {
            at--;
            value &= low;
        } else if (value > low) {
            value -= few;
        }
        int count = (int)value - 1;
        left -= count < 0 ? 1 : count;
        counts[symbol++] = (int16_t)count;
        for (uint64_t more = 3; count == 0 && more == 3;) {
            if (at + 2 > end) return 0;
            more = bits_at(bytes.data, at, 2);
            at += 2;
            symbol += (int)more;
            if (symbol > most_symbol + 1) return 0;
        }
    }
    if (left != 0 || at > end || !make_states(counts, symbol, log, table)) return 0;
    return (at + 7) / 8;
}

static int next_state(const StateTable *table, int state, Bits *bits) {
    return table->base[state] + (int)take_bits(bits, table->bits[state]);
}

/* Weights of prefixes, as two states take turns to say; how many, -1 for nonsense. */
static int read_weights(Unpacker *own, Span bytes, uint8_t *weights) {
    int64_t head = read_states(bytes, 6, 12, &own->weights);
    Bits bits;
    if (head == 0 || !open_bits((Span){bytes.data + head, bytes.size - head}, &bits)) return -1;
    int state[2] = {(int)take_bits(&bits, own->weights.log)};
    state[1] = (int)take_bits(&bits, own->weights.log);
    if (bits.left < 0) return -1;
    for (int count = 0, turn = 0; count < MOST_SYMBOLS - 2; turn = !turn) {
        weights[count++] = own->weights.symbol[state[turn]];
        state[turn] = next_state(&own->weights, state[turn], &bits);
        if (bits.left < 0) {
            weights[count++] = own->weights.symbol[state[!turn]];
            return count;
        }
    }
    return -1;
}

static bool make_prefixes(uint8_t *weights, int count, PrefixTable *table) {
    uint32_t sum = 0, place = 0;
    for (int s = 0; s < count; s++) {
        if (weights[s] > MOST_BITS) return false;
        sum += weights[s] > 0 ? 1u << (weights[s] - 1) : 0;
    }
    if (sum == 0) return false;
    int log = log_of(sum) + 1;
    uint32_t rest = (1u << log) - sum;
    if (log > MOST_BITS || (rest & (rest - 1)) != 0) return false;
    weights[count++] = (uint8_t)(log_of(rest) + 1);
    for (int weight = 1; weight <= log; weight++)
        for (int s = 0; s < count; s++) {
            if (weights[s] != weight) continue;
            for (uint32_t i = 0; i < 1u << (weight - 1); i++, place++) {
                table->symbol[place] = (uint8_t)s;
                table->bits[place] = (uint8_t)(log + 1 - weight);
            }
        }
    table->log = log;
    return place == 1u << log;
}

/* A description of prefixes, and how many bytes it takes; 0 for none. */
static int64_t read_prefixes(Unpacker *own, Span bytes) {
    uint8_t weights[MOST_SYMBOLS];
    if (bytes.size == 0) return 0;
    int head = bytes.data[0], count = head - 127;
    int64_t size = head < 128 ? head : (count + 1) / 2;
    if (size > bytes.size - 1) return 0;
    for (int i = 0; i < count; i++) weights[i] = bytes.data[1 + i / 2] >> (i % 2 ? 0 : 4) & 15;
    if (head < 128) count = read_weights(own, (Span){bytes.data + 1, size}, weights);
    return count > 0 && make_prefixes(weights, count, &own->prefixes) ? 1 + size : 0;
}

static bool read_stream(const PrefixTable *table, Span bytes, uint8_t *to, int64_t count) {
    Bits bits;
    if (!open_bits(bytes, &bits)) return false;
    for (int64_t i = 0; i < count; i++) {
        uint64_t code = bits_at(bits.data, bits.left - table->log, table->log);
        to[i] = table->symbol[code];
        bits.left -= table->bits[code];
        if (bits.left < 0) return false;
    }
    return bits.left == 0;
}

static bool read_streams(Unpacker *own, Span bytes, int64_t count, bool four) {
    if (!four) return read_stream(&own->prefixes, bytes, own->literals, count);
    int64_t each = (count + 3) / 4, at = 6;
    if (bytes.size < at || count < 6) return false;
    for (int k = 0; k < 4; k++) {
        int64_t size = k < 3 ? (int64_t)little_endian(bytes.data + 2 * k, 2) : bytes.size - at;
        int64_t own_count = k < 3 ? each : count - 3 * each;
        if (size > bytes.size - at || own_count < 0) return false;
        if (!read_stream(&own->prefixes, (Span){bytes.data + at, size}, own->literals + k * each, own_count))
            return false;
        at += size;
    }
    return true;
}

/* The literals of a block, and the bytes that they take; 0 for nonsense. */
static int64_t read_literals(Unpacker *own, Span block, int64_t most) {
    if (block.size == 0) return 0;
    int type = block.data[0] & 3, format = block.data[0] >> 2 & 3;
    bool packed = type == PACKED || type == REPEAT;
    int head = packed ? (format < 2 ? 3 : format + 2) : format == 1 ? 2 : format == 3 ? 3 : 1;
    if (block.size < head) return 0;
    uint64_t fields = little_endian(block.data, head);
    int width = format < 2 ? 10 : format == 2 ? 14 : 18;
    int64_t count = (int64_t)(packed ? fields >> 4 & ((1u << width) - 1) : head == 1 ? fields >> 3 : fields >> 4);
    int64_t size = packed ? (int64_t)(fields >> (4 + width)) : type == RLE ? 1 : count;
    if (count > most || size > block.size - head) return 0;
    Span bytes = {block.data + head, size};
    own->literal_count = count;
    if (type == RAW) memcpy(own->literals, bytes.data, (size_t)count);
    if (type == RLE) memset(own->literals, bytes.data[0], (size_t)count);
    if (packed) {
        int64_t table = type == PACKED ? read_prefixes(own, bytes) : 0;
        if (type == PACKED ? table == 0 : own->prefixes.log == 0) return 0;
        if (!read_streams(own, (Span){bytes.data + table, size - table}, count, format > 0)) return 0;
    }
    return head + size;
}

static const int16_t LENGTH_COUNTS[] = {
    4, 3, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 3, 2, 1, 1, 1, 1, 1, -1, -1, -1, -1};
static const int16_t OFFSET_COUNTS[] = {
    1, 1, 1, 1, 1, 1, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1};
static const int16_t MATCH_COUNTS[] = {1, 4, 3, 2, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
    1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1, -1, -1};
/* Extra bits of a code, from the first code that has some. */
static const uint8_t LENGTH_BITS[] = {1, 1, 1, 1, 2, 2, 3, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
static const uint8_t MATCH_BITS[] = {1, 1, 1, 1, 2, 2, 3, 3, 4, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};

static uint64_t read_length(Bits *bits, int code, int plain, const uint8_t *widths) {
    if (code < plain) return (uint64_t)code;
    uint64_t first = (uint64_t)plain;
    for (int k = 0; k < code - plain; k++) first += UINT64_C(1) << widths[k];
    return first + take_bits(bits, widths[code - plain]);
}

typedef struct {
    const int16_t *counts;
    int symbols, log, most_log, most_symbol;
} TablePlan;

/* The table of a kind of codes, by the mode that a block says; false for nonsense. */
static bool choose_table(int mode, TablePlan plan, Span *bytes, StateTable *table) {
    if (mode == RAW) return make_states(plan.counts, plan.symbols, plan.log, table);
    if (mode == REPEAT) return table->log >= 0;
    int64_t size = 1;
    if (mode == RLE) {
        if (bytes->size < 1 || bytes->data[0] > plan.most_symbol) return false;
        table->symbol[0] = bytes->data[0];
        table->bits[0] = table->base[0] = 0;
        table->log = 0;
    } else {
        size = read_states(*bytes, plan.most_log, plan.most_symbol, table);
    }
    if (size == 0) return false;
    *bytes = (Span){bytes->data + size, bytes->size - size};
    return true;
}

/* How far back a match begins, by the code of its offset. */
static uint64_t offset_of(Unpacker *own, uint64_t value, bool no_literals) {
    uint64_t *latest = own->latest, offset;
    if (value > 3) {
        offset = value - 3;
    } else {
        int which = (int)value - 1 + no_literals;
        if (which == 0) return latest[0];
        offset = which < 3 ? latest[which] : latest[0] - 1;
        if (which == 1) {
            latest[1] = latest[0];
            return latest[0] = offset;
        }
    }
    latest[2] = latest[1];
    latest[1] = latest[0];
    return latest[0] = offset;
}

/* Literals, then a match with earlier bytes; false if there is no room, or too few earlier bytes. */
static bool append(Unpacker *own, int64_t *used, uint64_t literals, uint64_t length, uint64_t offset, int64_t end) {
    if (literals > (uint64_t)(own->literal_count - *used) || literals + length > (uint64_t)(end - own->done))
        return false;
    memcpy(own->content + own->done, own->literals + *used, (size_t)literals);
    own->done += (int64_t)literals;
    *used += (int64_t)literals;
    if (length > 0 && (offset == 0 || offset > (uint64_t)own->done)) return false;
    for (; length > 0; length--, own->done++) own->content[own->done] = own->content[own->done - (int64_t)offset];
    return true;
}

static bool run_sequences(Unpacker *own, Span bytes, int64_t count, int64_t *used, int64_t end) {
    Bits bits;
    if (!open_bits(bytes, &bits)) return false;
    int length = (int)take_bits(&bits, own->lengths.log), offset = (int)take_bits(&bits, own->offsets.log);
    int match = (int)take_bits(&bits, own->matches.log);
    for (int64_t i = 0; i < count; i++) {
        int code = own->offsets.symbol[offset];
        uint64_t back = (UINT64_C(1) << code) + take_bits(&bits, code);
        uint64_t matched = 3 + read_length(&bits, own->matches.symbol[match], 32, MATCH_BITS);
        uint64_t literals = read_length(&bits, own->lengths.symbol[length], 16, LENGTH_BITS);
        if (bits.left < 0 || !append(own, used, literals, matched, offset_of(own, back, literals == 0), end))
            return false;
        if (i == count - 1) break;
        length = next_state(&own->lengths, length, &bits);
        match = next_state(&own->matches, match, &bits);
        offset = next_state(&own->offsets, offset, &bits);
        if (bits.left < 0) return false;
    }
    return bits.left == 0;
}

static bool unpack_block(Unpacker *own, Span block, int64_t most) {
    int64_t used = 0, end = own->done + least(most, own->size - own->done), head = read_literals(own, block, most);
    Span bytes = {block.data + head, block.size - head};
    if (head == 0 || bytes.size == 0) return false;
    int64_t count = bytes.data[0];
    int size = count < 128 ? 1 : count < 255 ? 2 : 3;
    if (bytes.size < size) return false;
    if (size == 2) count = (count - 128) << 8 | bytes.data[1];
    if (size == 3) count = (int64_t)little_endian(bytes.data + 1, 2) + 0x7f00;
    bytes = (Span){bytes.data + size, bytes.size - size};
    if (count > 0) {
        if (bytes.size == 0 || bytes.data[0] & 3) return false;
        int modes = bytes.data[0];
        bytes = (Span){bytes.data + 1, bytes.size - 1};
        if (!choose_table(modes >> 6, (TablePlan){LENGTH_COUNTS, 36, 6, 9, 35}, &bytes, &own->lengths)
            || !choose_table(modes >> 4 & 3, (TablePlan){OFFSET_COUNTS, 29, 5, 8, 31}, &bytes, &own->offsets)
            || !choose_table(modes >> 2 & 3, (TablePlan){MATCH_COUNTS, 53, 6, 9, 52}, &bytes, &own->matches)
            || !run_sequences(own, bytes, count, &used, end))
            return false;
    } else if (bytes.size > 0) {
        return false;
    }
    return append(own, &used, (uint64_t)(own->literal_count - used), 0, 0, end);
}

/* What a frame says of itself; the bytes that takes, 0 for nonsense (RFC 8878, 3.1.1.1). */
static int64_t read_header(Span frame, int64_t size, int64_t *window) {
    if (frame.size == 0) return 0;
    int descriptor = frame.data[0], flag = descriptor >> 6, single = descriptor >> 5 & 1;
    int bytes = flag == 0 ? 1 : 1 << flag, at = 2 - single;
    if ((descriptor & 15) != 0 || (!single && flag == 0) || frame.size < at + bytes)
        return 0; /* reserved bit, checksum, dictionary */
    uint64_t stated = little_endian(frame.data + at, bytes) + (flag == 1 ? 256 : 0);
    *window = size;
    if (!single) *window = (INT64_C(1) << (10 + (frame.data[1] >> 3))) / 8 * (8 + (frame.data[1] & 7));
    return stated == (uint64_t)size && *window <= MOST_WINDOW ? at + bytes : 0;
}

static bool unpack_blocks(Unpacker *own, Span frame, int64_t at, int64_t most) {
    for (bool last = false; !last;) {
        if (frame.size - at < 3) return false;
        uint64_t head = little_endian(frame.data + at, 3);
        int type = head >> 1 & 3;
        int64_t size = (int64_t)(head >> 3), taken = type == RLE ? 1 : size;
        last = head & 1;
        at += 3;
        if (size > most || taken > frame.size - at || type == REPEAT) return false;
        if (type != PACKED && size > own->size - own->done) return false;
        if (type == RAW) memcpy(own->content + own->done, frame.data + at, (size_t)size);
        if (type == RLE) memset(own->content + own->done, frame.data[at], (size_t)size);
        if (type != PACKED) own->done += size;
        else if (!unpack_block(own, (Span){frame.data + at, size}, most)) return false;
        at += taken;
    }
    return at == frame.size && own->done == own->size;
}

bool unpack_zstd(Context *context, Span frame, uint8_t *content, int64_t size, Arena *scratch) {
    int64_t window, head;
    if (frame.size > size) return FAIL(context, CORRUPT, "# compressed bytes for # bytes of content", frame.size, size);
    if (frame.size == size) {
        memcpy(content, frame.data, (size_t)size);
        return true;
    }
    head = read_header(frame, size, &window);
    if (head == 0) return FAIL(context, CORRUPT, "a zstd frame that is not of # bytes of content", size);
    Unpacker *own;
    int64_t most = least(window, MOST_BLOCK);
    if (!TAKE_ZEROS(scratch, 1, own) || !TAKE(scratch, most + 1, own->literals)) return false;
    own->content = content;
    own->size = size;
    own->lengths.log = own->offsets.log = own->matches.log = -1;
    own->latest[0] = 1;
    own->latest[1] = 4;
    own->latest[2] = 8;
    return unpack_blocks(own, frame, head, most) || FAIL(context, CORRUPT, "a zstd frame is damaged");
}
