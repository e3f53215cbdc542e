"""What is learnt of coefficients is rounded before it becomes a part of the format."""

import numpy as np

from bsm.bitstream.coefficients.adaptive import Experience, shipped_experience
from tools.train_coefficients import rounded


def test_what_ships_is_round():
    experience = shipped_experience()
    assert rounded(experience).to_bytes() == experience.to_bytes()


def test_rounding_keeps_two_digits_and_what_nothing_was_learnt_for():
    shipped = shipped_experience()
    slots = np.zeros_like(shipped.slots)
    slots[:5] = [2048 << 4, 409 << 4, 1000 << 4 | 7, 4095 << 4 | 1, 3686 << 4 | 15]
    round_slots = rounded(Experience(shipped.expectations, shipped.mixing, slots)).slots
    assert round_slots[:5].tolist() == [2048 << 4, 409 << 4, 1024 << 4 | 8, 4095 << 4 | 1, 3712 << 4 | 15]
