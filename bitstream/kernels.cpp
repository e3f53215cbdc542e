// The kernels of `bitstream` as functions of Python: by their names in C.
#include "bitstream/kernel.hpp"

#include <map>
#include <string_view>

extern "C" {
#include "bitstream/attributes/attributes.h"
#include "bitstream/coefficients/coefficients.h"
#include "bitstream/connectivity/connectivity.h"
#include "bitstream/container/container.h"
#include "bitstream/entropy/entropy.h"
#include "bitstream/fields/twins.h"
}

BSM_STRUCT(Coder, Longs, Bytes)
BSM_STRUCT(Bank, Words, Ints2, Longs)
BSM_STRUCT(Past, Ints2, Ints2, Ints2, Longs)

using namespace nb::literals;

static const std::map<std::string_view, BankPlan> PLANS = {{"code_labels", LABEL_BANK}, {"code_block", BLOCK_BANK},
    {"code_matrix", MATRIX_BANK}};

#define CONSTANT(name) {#name, name}
static const std::map<std::string_view, int> CONSTANTS = {CONSTANT(ABOVE), CONSTANT(BEYOND), CONSTANT(NEIGHBORS),
    CONSTANT(MAX_LEVEL), CONSTANT(TARGET_UNIT), CONSTANT(TRELLIS_STATES), CONSTANT(CODER_POSITION),
    CONSTANT(MOST_COMPONENTS), CONSTANT(MAJOR), CONSTANT(SHORT_PAYLOAD), CONSTANT(MOST_NAME),
    CONSTANT(MOST_COPIES), CONSTANT(FREE_COPIES), CONSTANT(METHODS), CONSTANT(RUNS), CONSTANT(WITH_ATTRIBUTES)};

void bind_bitstream(nb::module_ &m) {
    make_tables();

    m.def("code_uniform", checked<code_one_uniform>, "coder"_a, "value"_a, "count"_a);
    CHECKED(finish_coder)
    m.def("code_unsigned", checked<code_one_unsigned>, "coder"_a, "bank"_a, "contexts"_a, "selector"_a, "unary"_a,
        "value"_a, "node"_a = 0);

    // A number of the format by its name in the headers.
    m.def("constant", [](const char *name) { return CONSTANTS.at(name); }, "name"_a);

    m.def("priors", [] { return nb::bytes(PRIORS, PRIORS_BYTES); });
    m.def("start", [] { return nb::bytes(START, START_BYTES); });

    // Slots, selectors, inputs, limit and rate of the bank that a kernel needs; 0: what most have.
    m.def("bank_plan", [](const char *kernel) {
        const BankPlan &plan = PLANS.at(kernel);
        return nb::make_tuple(plan.slots, plan.selectors, plan.inputs, plan.limit, plan.rate);
    }, "kernel"_a, nb::sig("def bank_plan(kernel: str) -> tuple[int, int, int, int, int]"));

    CHECKED(code_labels)
    CHECKED(code_block) CHECKED(nearest_levels) CHECKED(code_matrix)
}
