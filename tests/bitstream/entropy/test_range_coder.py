"""The entropy coder refuses what does not fit."""

from collections.abc import Callable

import numpy as np
import pytest

from bsm import OptionError
from bsm._core.bitstream import code_uniform, code_unsigned
from bsm.bitstream.entropy import range_coder as entropy
from bsm.bitstream.entropy.range_coder import finish_writing, make_bank, start_writing


def test_a_full_buffer_is_an_error_and_not_a_crash() -> None:
    coder = start_writing(10)
    for _ in range(20):
        code_uniform(coder, 0, 256)
    with pytest.raises(OptionError, match="10 bytes"):
        finish_writing(coder)


@pytest.mark.parametrize(
    "call",
    [
        lambda coder: code_uniform(coder, 0, 0),
        lambda coder: code_uniform(coder, 0, (1 << 32) + 1),
        lambda coder: code_unsigned(coder, make_bank(40, 40, 1), np.array([40]), 0, 0, 7),
        lambda coder: code_unsigned(coder, make_bank(40, 40, 1), np.array([-1]), 0, 0, 7),
        lambda coder: code_unsigned(coder, make_bank(40, 40, 1), np.array([15]), 0, 0, 7),
        lambda coder: code_unsigned(coder, make_bank(40, 40, 1), np.array([0]), 15, 0, 7),
        lambda coder: code_unsigned(coder, make_bank(40, 40, 1), np.array([0]), 0, 15, 7),
        lambda coder: code_unsigned(coder, make_bank(40, 40, 1, limit=1024), np.array([0]), 0, 0, 7),
        lambda coder: code_unsigned(coder, make_bank(40, 40, 1, rate=0), np.array([0]), 0, 0, 7),
        lambda coder: code_unsigned(coder, make_bank(40, 40, 2), np.array([0]), 0, 0, 7),
        lambda coder: code_uniform(coder._replace(state=coder.state[:4]), 5, 1),
        lambda coder: code_uniform(coder._replace(state=np.zeros(5, np.int64)), 5, 1),
        lambda coder: code_uniform(coder._replace(state=coder.state + np.array([0, 0, 999, 0, 0])), 5, 1),
    ],
)
def test_what_is_outside_a_bank_or_a_coder_is_refused(call: Callable[[entropy.Coder], int]) -> None:
    with pytest.raises(ValueError, match="do not fit together"):
        call(start_writing(100))


def test_arrays_of_another_type_or_layout_are_refused() -> None:
    for state in (np.zeros(5), np.zeros(10, np.int64)[::2], np.zeros((5, 1), np.int64)):
        with pytest.raises(TypeError):
            code_uniform(entropy.Coder(state, np.empty(9, np.uint8)), 5, 1)
