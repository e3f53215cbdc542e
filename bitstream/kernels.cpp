// The kernels of `bitstream` as functions of Python: by their names in C.
#include "bitstream/kernel.hpp"

#include <map>
#include <string_view>
#include <vector>

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

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
static const std::map<std::string_view, int> CONSTANTS = {CONSTANT(MAX_LEVEL), CONSTANT(MAJOR),
    CONSTANT(SHORT_PAYLOAD), CONSTANT(MOST_COPIES), CONSTANT(FREE_COPIES), CONSTANT(METHODS), CONSTANT(RUNS),
    CONSTANT(WITH_ATTRIBUTES), CONSTANT(MOST_TRANSFORMS), CONSTANT(AXIS_KINDS), CONSTANT(MOST_FINENESS)};

void bind_bitstream(nb::module_ &m) {
    // A number of the format by its name in the headers.
    m.def("constant", [](const char *name) { return CONSTANTS.at(name); }, "name"_a);

    // Fields of a header, or of a declaration: key, type, range, lengths of a list, default, whether there is none.
    m.def("fields", [](bool declares) {
        const Fields &fields = declares ? DECLARATION_FIELDS : HEADER_FIELDS;
        std::vector<std::tuple<int, int, double, double, int, int, double, bool>> rows;
        for (const Field *f = fields.field; f < fields.field + fields.count; f++)
            rows.emplace_back(f->key, f->type, f->low, f->high, f->least, f->most, f->fallback, f->required);
        return rows;
    }, "declares"_a);

    m.def("priors", [] { return nb::bytes(PRIORS, PRIORS_BYTES); });
    m.def("start", [] { return nb::bytes(START, START_BYTES); });
}
