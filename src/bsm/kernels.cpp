// The kernels of `bsm` as functions of Python: by their names in C.
#include "bitstream/kernel.hpp"

extern "C" {
#include "src/bsm/encoding/simplification.h"
#include "src/bsm/files/formats/obj.h"

int64_t walk_rows(
    ConstBytes raw, int64_t offset, ConstLongs2 widths, int64_t place, bool big_endian, Longs starts, Longs sizes);
}

BSM_STRUCT(ObjLines, Doubles2, Doubles2, Doubles2, Longs, Longs, Longs, Longs, Longs2, Longs2)
BSM_STRUCT(WorkingRoom, Doubles2, Longs, Ints, Ints, Ints, Ints, Ints, Singles, Ints)

void bind_bsm(nb::module_ &m) {
    CHECKED(walk_rows) CHECKED(simplify) CHECKED(scan_obj)
    m.attr("OBJ_COUNTS") = static_cast<int>(OBJ_COUNTS);
    m.attr("NO_REFERENCE") = NO_REFERENCE;
}
