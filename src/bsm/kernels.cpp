// The kernels of `bsm` as functions of Python: one line each.
#include "bitstream/kernel.hpp"

extern "C" int64_t walk_rows(
    ConstBytes raw, int64_t offset, ConstLongs2 widths, int64_t place, bool big_endian, Longs starts, Longs sizes);

using namespace nb::literals;

NB_MODULE(_kernels, m) {
    m.attr("version") = BSM_VERSION;
    m.def("walk_rows", checked<walk_rows>, "raw"_a, "offset"_a, "widths"_a, "place"_a, "big_endian"_a, "starts"_a,
        "sizes"_a, Unlocked());
}
