"""The Laplacian of a block, L = D - W, and the solver for R = (L + delta I)^-1 (paper, sections 3 and 4).

Equation 2 of the paper weighs edges by geometry; the decoder of a mesh has only connectivity, so all weights are one
there, while the frames of a sequence have a first one to weigh them by (weighted.c): decoders know that to
rounding, so that weights are smooth functions of it which make little of little: soft cotangents, whose denominators
stay away from zero, within soft bounds above zero (cotangents may be negative, and L indefinite, where a triangle is
obtuse; U. Pinkall, K. Polthier, "Computing discrete minimal surfaces and their conjugates", 1993, section 4).

The order of elimination is nested dissection along the bisection that ordered the rows. The rows before a cut that see
across it separate the two halves; they are eliminated after both. The rows of a separator, or of a half that is not cut
further, make a front: its own steps, and the later steps to which they lead, its border. A front is kept as a dense
matrix, one row for each of its own steps, own steps first and then the border; this costs some fill and buys vector
instructions (C. Ashcraft, R. Grimes, "The influence of relaxed supernode partitions on the multifrontal method", 1989).
"""

import numpy as np

from bsm._core import Solver
from bsm.codec.blocks.overlap import Block


def solver_of(block: Block, shift: float) -> Solver:
    """L + delta I of a block, factorised."""
    return Solver(block.offsets, block.neighbors, np.full(block.size, shift))
