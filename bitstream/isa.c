/* The kernels of this room that are compiled for several levels of processors. */
#ifdef KERNEL_ISAS

#include "bitstream/fields/fields.h"

CHOOSE(int32_t, code_value, (RangeCoder *coder, const ValueModel *model, const Expectation *e, int32_t value),
       (coder, model, e, value))
CHOOSE(int64_t, code_grid,
       (RangeCoder *coder, ValueModel model, Corners corners, Grid grid, int64_t first, int64_t count),
       (coder, model, corners, grid, first, count))
CHOOSE(int64_t, code_levels,
       (RangeCoder *coder, const Bank *bank, Corners corners, Levels levels, int64_t first, int64_t count),
       (coder, bank, corners, levels, first, count))

#else

typedef int one_isa_needs_no_choice;

#endif
