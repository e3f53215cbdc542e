// The kernels of `codec` as functions of Python: one line each.
#include "bitstream/kernel.hpp"

extern "C" {
#include "codec/geometry/graph.h"
}

using namespace nb::literals;

NB_MODULE(_kernels, m) {
    m.def("collect_edges", &collect_edges, "faces"_a, "offsets"_a, "filled"_a, "ends"_a, Unlocked());
}
