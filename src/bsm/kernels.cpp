// The kernels of `bsm` as functions of Python: one line each.
#include "bitstream/kernel.hpp"

extern "C" {
#include "bsm/files/formats/walk.h"
}

using namespace nb::literals;

NB_MODULE(_kernels, m) {
    m.attr("version") = BSM_VERSION;
    m.def("walk_rows", checked<walk_rows>, "raw"_a, "offset"_a, "widths"_a, "place"_a, "big_endian"_a, "starts"_a,
        "sizes"_a, Unlocked());
}
