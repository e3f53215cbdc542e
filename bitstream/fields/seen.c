#include "bitstream/fields/seen.h"

enum { WORDS_SEARCHED = 4 };

int32_t nearest_seen(const int64_t *row, int64_t words, int32_t v) {
    const uint64_t *seen = (const uint64_t *)row;
    int32_t word = v >> 6, bit = v & 63, below = -1;
    uint64_t low = seen[word] & ((UINT64_C(2) << bit) - 1), high = seen[word] & ~((UINT64_C(1) << bit) - 1);
    for (int i = 0; i < WORDS_SEARCHED && below < 0; i++) {
        if (low != 0) below = ((word - i) << 6) + 63 - __builtin_clzll(low);
        if (word - i == 0) break;
        low = seen[word - i - 1];
    }
    for (int i = 0; i < WORDS_SEARCHED; i++) {
        if (high != 0) {
            int32_t above = ((word + i) << 6) + __builtin_ctzll(high);
            return below < 0 || above - v < v - below ? above : below;
        }
        if (word + i + 1 == words) break;
        high = seen[word + i + 1];
    }
    return below < 0 ? v : below;
}
