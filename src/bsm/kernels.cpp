// The kernels of `bsm` as functions of Python: by their names in C.
#include "bitstream/kernel.hpp"

extern "C" int64_t walk_rows(
    ConstBytes raw, int64_t offset, ConstLongs2 widths, int64_t place, bool big_endian, Longs starts, Longs sizes);
extern "C" int64_t simplify(Doubles2 positions, Ints2 faces, Ints2 wedges, Bytes states, Doubles2 quadrics,
    Longs starts, Ints around, Ints ends, Ints marks, Ints joins, Ints owners, Singles costs, Ints buckets,
    int64_t target, double along, double uneven);

void bind_bsm(nb::module_ &m) {
    CHECKED(walk_rows) CHECKED(simplify)
}
