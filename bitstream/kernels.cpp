// The kernels of `bitstream` as functions of Python: by their names in C.
#include "bitstream/kernel.hpp"

#include <map>
#include <string_view>

extern "C" {
#include "bitstream/attributes/attributes.h"
#include "bitstream/coefficients/coefficients.h"
#include "bitstream/connectivity/connectivity.h"
#include "bitstream/container/numbers.h"
#include "bitstream/entropy/entropy.h"
#include "bitstream/fields/twins.h"
}

using namespace nb::literals;

#define CONSTANT(name) {#name, name}
static const std::map<std::string_view, int> CONSTANTS = {CONSTANT(MAX_LEVEL),
    CONSTANT(MOST_COMPONENTS), CONSTANT(MAJOR), CONSTANT(SHORT_PAYLOAD), CONSTANT(MOST_NAME),
    CONSTANT(MOST_COPIES), CONSTANT(FREE_COPIES), CONSTANT(METHODS), CONSTANT(RUNS), CONSTANT(WITH_ATTRIBUTES)};

void bind_bitstream(nb::module_ &m) {
    // A number of the format by its name in the headers.
    m.def("constant", [](const char *name) { return CONSTANTS.at(name); }, "name"_a);

    m.def("priors", [] { return nb::bytes(PRIORS, PRIORS_BYTES); });
    m.def("start", [] { return nb::bytes(START, START_BYTES); });
}
