// The kernels of `bitstream` as functions of Python: one line each.
#include "bitstream/kernel.hpp"

extern "C" {
#include "bitstream/coefficients/trellis.h"
}

using namespace nb::literals;

NB_MODULE(_kernels, m) {
    m.def("points_of_levels", &points_of_levels, "levels"_a, "points"_a, Unlocked());
}
