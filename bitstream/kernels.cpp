// The kernels of `bitstream` as functions of Python: one line each.
#include "bitstream/kernel.hpp"

#include <string_view>

extern "C" {
#include "bitstream/attributes/attributes.h"
#include "bitstream/coefficients/coefficients.h"
#include "bitstream/connectivity/connectivity.h"
#include "bitstream/entropy/entropy.h"
#include "bitstream/fields/fields.h"
}

BSM_STRUCT(Coder, Longs, Bytes)
BSM_STRUCT(Bank, Words, Ints2, Longs)
BSM_STRUCT(Past, Ints2, Ints2, Ints2, Longs)
BSM_STRUCT(Corners, ConstInts2, Ints, Ints, Ints, Ints)

using namespace nb::literals;

static const struct {
    const char *kernel;
    const BankPlan &plan;
} PLANS[] = {{"code_steps", STEP_BANK}, {"code_turns", TURN_BANK}, {"code_labels", LABEL_BANK},
    {"code_block", BLOCK_BANK}, {"code_matrix", MATRIX_BANK}, {"code_edges", EDGE_BANK}};

NB_MODULE(_kernels, m) {
    make_tables();

    m.def("code_uniform", checked<code_one_uniform>, "coder"_a, "value"_a, "count"_a);
    m.def("code_unsigned", checked<code_one_unsigned>, "coder"_a, "bank"_a, "contexts"_a, "selector"_a, "unary"_a,
        "value"_a, "node"_a = 0);

    m.def("priors", [] { return nb::bytes(PRIORS, PRIORS_BYTES); });

    // Slots, selectors, inputs, limit and rate of the bank that a kernel needs; 0: what most have.
    m.def("bank_plan", [](const char *kernel) {
        for (const auto &[name, plan] : PLANS)
            if (name == std::string_view(kernel))
                return nb::make_tuple(plan.slots, plan.selectors, plan.inputs, plan.limit, plan.rate);
        throw nb::key_error(kernel);
    }, "kernel"_a, nb::sig("def bank_plan(kernel: str) -> tuple[int, int, int, int, int]"));

    m.def("code_steps", checked<code_steps>, "coder"_a, "bank"_a, "values"_a, "tree"_a, Unlocked());
    m.def("code_turns", checked<code_turns>, "coder"_a, "bank"_a, "values"_a, Unlocked());
    m.def("code_labels", checked<code_labels>, "coder"_a, "bank"_a, "offsets"_a, "neighbors"_a, "labels"_a, "parts"_a,
        Unlocked());

    m.def("points_of_levels", &points_of_levels, "levels"_a, "points"_a, Unlocked());
    m.def("code_block", checked<code_block>, "coder"_a, "bank"_a, "past"_a, "expectations"_a, "levels"_a, Unlocked());
    m.def("search_levels", checked<search_levels>, "bank"_a, "past"_a, "expectations"_a, "targets"_a, "price"_a,
        "costs"_a, "ways"_a, "origins"_a, "levels"_a, "kept"_a, Unlocked());
    m.def("code_matrix", checked<code_matrix>, "coder"_a, "bank"_a, "levels"_a, "reference"_a, "rows"_a, "lead"_a,
        "stair"_a, "turn"_a, "few"_a, "slow"_a, Unlocked());
    m.def("price_matrix", checked<price_matrix>, "coder"_a, "bank"_a, "levels"_a, "reference"_a, "rows"_a, "lead"_a,
        "stair"_a, "turn"_a, "few"_a, "slow"_a, "costs"_a, "prices"_a, Unlocked());

    m.def("link_corners", checked<link_corners>, "corners"_a, "scratch"_a, Unlocked());
    m.def("code_edges", checked<code_edges>, "coder"_a, "bank"_a, "corners"_a, "seams"_a, "others"_a, "ends"_a,
        Unlocked());
    m.def("join_corners", checked<join_corners>, "corners"_a, "seams"_a, "joined"_a, "first"_a, Unlocked());
}
