/* The best way through the trellis of a block, by dynamic programming (an encoder's choice, no part of the format).
 *
 * For each state of the trellis the best way there survives, by squared error and price times bits. Bits are those that
 * adaptive.c would spend with the model in its present state; each survivor has its own neighbors as contexts.
 */
#include "bitstream/coefficients/coefficients.h"

enum {
    STATES = TRELLIS_STATES,
    BIT_UNIT = 256,  /* bits are in 1 / BIT_UNIT */
    COST_SHIFT = 4,  /* a cost for each probability, less these bits */
    COSTS = (ONE >> COST_SHIFT) + 1,
    NEAR = 3 * (ABOVE + 1),
};

#define NEVER __builtin_inf()

typedef struct {
    double cost;
    int32_t near[NEAR]; /* magnitudes of the rows above and of the present row */
} Survivor;

/* What decisions of one coefficient would cost, looked up once for each node. */
typedef struct {
    const Mixer *mixer;
    const int64_t *costs;
    int64_t selector, contexts[EXPECTATIONS];
    uint32_t probability[NODES];
} Prices;

INLINE int64_t decision_cost(Prices *prices, int node, int bit) {
    if (prices->probability[node] == 0) {
        int32_t stretched[EXPECTATIONS];
        prices->probability[node] =
            mixed_probability(prices->mixer, EXPECTATIONS, prices->contexts, node, prices->selector, stretched);
    }
    uint32_t probability = prices->probability[node];
    return prices->costs[(bit ? probability : ONE - probability) >> COST_SHIFT];
}

/* What code_level would spend on a magnitude, with the sign. */
INLINE int64_t level_cost(Prices *prices, int grid, int32_t magnitude) {
    int size = 0;
    int64_t total = 0;
    for (; magnitude >> size > 0; size++) total += decision_cost(prices, size_node(size, grid), 1);
    total += decision_cost(prices, size_node(size, grid), 0);
    if (size > 0) total += BIT_UNIT;
    if (size > 1) {
        int first = magnitude >> (size - 2) & 1;
        total += decision_cost(prices, first_bit_node(size), first);
        if (size > 2) {
            int second = magnitude >> (size - 3) & 1;
            total += decision_cost(prices, second_bit_node(size, first), second) + BIT_UNIT * (size - 3);
        }
    }
    return total;
}

/* Follow the best way back from the last coefficient, and give levels the signs of their targets. */
static void trace_back(const Survivor *last, ConstLongs2 targets, Ints2 ways, Bytes2 origins, Ints2 levels) {
    int state = 0;
    for (int s = 1; s < STATES; s++)
        if (last[s].cost < last[state].cost) state = s;
    for (int64_t i = 3 * targets.rows; i-- > 0;) {
        int32_t level = ways.data[STATES * i + state];
        levels.data[i] = targets.data[i] >= 0 ? level : -level;
        state = origins.data[STATES * i + state];
    }
}

/* The best levels for all rows, and the least error and bits together up to each row.
 *
 * Targets are in 1 / TARGET_UNIT of a step. `costs` are of probabilities, see COST_SHIFT; `ways` and `origins` are
 * scratch with a row of STATES for each coefficient. */
KERNEL int64_t search_levels(Bank bank, Past past, ConstInts2 expectations, ConstLongs2 targets, double price,
    ConstLongs costs, Ints2 ways, Bytes2 origins, Ints2 levels, Doubles kept) {
    Mixer mixer;
    Chain chain;
    int64_t rows = targets.rows;
    if (!open_bank(&mixer, bank, LEVEL_SLOTS, SELECTORS * NODES, EXPECTATIONS) || targets.columns != 3
        || !open_past(&chain, past, rows) || !are_expectations(expectations) || costs.size != COSTS
        || ways.rows != 3 * rows || ways.columns != STATES || origins.rows != 3 * rows || origins.columns != STATES
        || levels.rows != rows || levels.columns != 3 || kept.size != rows)
        return MISUSED;
    for (int64_t i = 0; i < 3 * rows; i++)
        if (targets.data[i] > MAX_LEVEL * INT64_C(256) || targets.data[i] < -MAX_LEVEL * INT64_C(256)) return MISUSED;

    Prices prices = {&mixer, costs.data, level_selector(&chain), {0}, {0}};
    Survivor survivors[2][STATES], *old = survivors[1], *new = survivors[0];
    for (int s = 0; s < STATES; s++) new[s].cost = s == 0 ? 0.0 : NEVER;
    for (int k = 0; k < NEAR; k++) new[0].near[k] = 0;
    for (int64_t i = 0; i < 3 * rows; i++) {
        int64_t row = i / 3;
        int d = (int)(i - 3 * row);
        int64_t target = targets.data[i] < 0 ? -targets.data[i] : targets.data[i];
        int32_t *way = ways.data + STATES * i;
        uint8_t *origin = origins.data + STATES * i;
        Survivor *swap = old;
        old = new;
        new = swap;
        for (int s = 0; s < STATES; s++) new[s].cost = NEVER;
        for (int state = 0; state < STATES; state++) {
            if (old[state].cost == NEVER) continue;
            int32_t inputs[NEIGHBORS];
            gather_inputs(old[state].near + 3 * ABOVE, chain.before + 3 * row, chain.usual + 3 * row, row, d, inputs);
            set_contexts(expectations, situation(&chain, d), inputs, prices.contexts);
            for (int node = 0; node < NODES; node++) prices.probability[node] = 0;
            int grid = trellis_grid(state);
            int64_t below = (2 * target + TARGET_UNIT * grid) / (2 * TARGET_UNIT);
            int candidates = target > 0 ? 3 : 1; /* what is zero stays zero: flat meshes stay flat */
            for (int candidate = 0; candidate < candidates; candidate++) {
                int32_t level = candidate < 2 ? (int32_t)least(below + candidate, MAX_LEVEL) : 0;
                double error = (double)target - 0.5 * TARGET_UNIT * trellis_point(state, level);
                double cost = error * error + price * (double)level_cost(&prices, grid, level);
                int after = trellis_following(state, level);
                if (old[state].cost + cost < new[after].cost) {
                    new[after].cost = old[state].cost + cost;
                    way[after] = level;
                    origin[after] = (uint8_t)state;
                }
            }
        }
        double best = NEVER;
        for (int s = 0; s < STATES; s++) {
            if (new[s].cost == NEVER) continue;
            best = new[s].cost < best ? new[s].cost : best;
            const Survivor *from = old + origin[s];
            int shift = d == 2 ? 3 : 0; /* the next row begins */
            int32_t noted = remembered(way[s]);
            for (int k = 0; k < NEAR; k++) new[s].near[k] = k + shift < NEAR ? from->near[k + shift] : 0;
            new[s].near[3 * ABOVE + d - shift] = noted;
        }
        kept.data[row] = best;
    }
    if (rows > 0) trace_back(new, targets, ways, origins, levels);
    return 0;
}
