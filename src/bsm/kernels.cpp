// The kernels of `bsm` as functions of Python: one line each.
#include "bitstream/kernel.hpp"

extern "C" int64_t walk_rows(
    ConstBytes raw, int64_t offset, ConstLongs2 widths, int64_t place, bool big_endian, Longs starts, Longs sizes);
extern "C" int64_t simplify(Doubles2 positions, Ints2 faces, Bytes states, Doubles2 quadrics, Ints starts, Ints around,
    Ints ends, Ints marks, Ints owners, Singles costs, Ints buckets, int64_t target);

using namespace nb::literals;

void bind_bsm(nb::module_ &m) {
    m.def("walk_rows", checked<walk_rows>, "raw"_a, "offset"_a, "widths"_a, "place"_a, "big_endian"_a, "starts"_a,
        "sizes"_a, Unlocked());
    m.def("simplify", checked<simplify>, "positions"_a, "faces"_a, "states"_a, "quadrics"_a, "starts"_a, "around"_a,
        "ends"_a, "marks"_a, "owners"_a, "costs"_a, "buckets"_a, "target"_a, Unlocked());
}
