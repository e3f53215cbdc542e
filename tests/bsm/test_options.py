"""Options by keyword: what Python and the command line share."""

from dataclasses import replace

import numpy as np
import pytest

import bsm
from bsm.codec.sequence.options import PROMISES
from bsm.codec.static.options import BALANCED
from bsm.commands import flags
from bsm.encoding.options import (
    BOUNDS,
    SEQUENCE_STEPS,
    TARGETS,
    denoise_options,
    encode_options,
    sequence_options,
)
from bsm.ground.lengths import Length


def test_without_keywords_everything_is_the_default():
    assert encode_options() == bsm.EncodeOptions()
    assert sequence_options() == bsm.SequenceOptions(promise=PROMISES["balanced"])
    assert denoise_options() is None


@pytest.mark.parametrize("preset", bsm.PRESETS)
def test_presets(preset):
    assert encode_options(preset=preset) == bsm.PRESETS[preset]


@pytest.mark.parametrize("preset", SEQUENCE_STEPS)
def test_presets_of_sequences(preset):
    assert sequence_options(preset=preset).promise == PROMISES[preset]
    low_delay = sequence_options(preset=preset, low_delay=1)
    assert low_delay.step == SEQUENCE_STEPS[preset] and low_delay.promise is None
    for other in ({"kg": 1}, {"step": 0.01}):
        assert sequence_options(**other).promise is None
        with pytest.raises(bsm.OptionError, match=f"replaces the preset {preset}"):
            sequence_options(preset=preset, **other)


def test_targets_and_bounds_of_sequences():
    options = sequence_options(kg=0.1, low_delay=4, overlap=1.2)
    assert (options.target, options.low_delay, options.overlap) == (
        bsm.SequenceTarget("kg", 0.1),
        4,
        1.2,
    )
    assert sequence_options(max_error="0.2%").promise == bsm.Contract(0.002, look=1.0)
    assert sequence_options(max_error=Length(3.0, True), look=2).promise == bsm.Contract(
        3.0, look=2.0, absolute=True
    )
    assert sequence_options(preset="fine", look=2).promise == bsm.Contract(
        PROMISES["fine"].farthest, look=2.0
    )
    assert sequence_options(max_error=0.001, low_delay=4).promise == bsm.Contract(0.001)
    for others in ({"kg": 1}, {"step": 0.01}):
        with pytest.raises(bsm.OptionError):
            sequence_options(max_error=0.01, **others)


def test_keywords_are_put_on_top_of_a_preset():
    options = encode_options(
        preset="fine", step=np.float32(0.5), block_size=np.int64(300), keep_order=True
    )
    assert (options.step, options.block_size, options.keep_order) == (0.5, 300, True)
    assert options.paper == bsm.PRESETS["fine"].paper
    assert encode_options(doi=[1, 2]).paper.doi == (1.0, 2.0)
    assert denoise_options(fine="bilateral-normal", iterations=3) == bsm.DenoiseOptions(
        fine="bilateral-normal", iterations=3
    )


@pytest.mark.parametrize(("keyword", "kind"), TARGETS.items())
def test_targets(keyword, kind):
    assert encode_options(**{keyword: 7}).target == bsm.Target(kind, 7.0)
    assert encode_options(target=bsm.Target(kind, 7.0)).target == bsm.Target(kind, 7.0)


def test_the_command_line_has_the_same_targets():
    assert [target.field for target in flags.FLAGS["targets"]] == list(TARGETS)
    assert [target.field for target in flags.FLAGS["bounds"]] == list(BOUNDS)


@pytest.mark.parametrize(
    ("keywords", "error", "words"),
    [
        ({"stepp": 1}, bsm.ArgumentError, "did you mean step?"),
        ({"thetta": 1}, bsm.ArgumentError, "did you mean theta?"),
        ({"elephant": 1}, bsm.ArgumentError, "there are attributes, bits"),
        ({"kg": 1}, bsm.ArgumentError, "kg is for sequences, not for a mesh"),
        ({"bits": 2.5}, bsm.ArgumentError, "a whole number or None, not 2.5"),
        ({"grid_origin": 1}, TypeError, "grid_origin must be .*, not 1"),
        ({"step": True}, bsm.ArgumentError, "a number or None, not True"),
        ({"predict": 1}, bsm.ArgumentError, "True or False"),
        ({"doi": (1, 2, 3)}, bsm.ArgumentError, "doi"),
        ({"step": 2.0}, bsm.OptionError, "outside"),
        (
            {"exact": True, "effort": "quick"},
            bsm.OptionError,
            "exact, grid and effort quick exclude",
        ),
        ({"grid_cell": 1e300}, bsm.OptionError, "outside 1e-290..1e[+]290"),
        ({"grid_cell": 1.0, "grid_origin": (0, 1e300, 0)}, bsm.OptionError, "within 1e290"),
        ({"effort": "more"}, bsm.OptionError, "effort must be one of"),
        (
            {"preset": "fine", "grid": 4},
            bsm.OptionError,
            "grid fixes .* combined with the preset fine",
        ),
        ({"preset": "best"}, bsm.OptionError, ", ".join(bsm.PRESETS)),
        ({"theta": 5, "size": 100}, bsm.OptionError, "give one target only"),
        ({"theta": 5, "target": bsm.Target("bpv", 2)}, bsm.OptionError, "give one target only"),
    ],
)
def test_what_is_refused(keywords, error, words):
    with pytest.raises(error, match=words):
        encode_options(**keywords)


def test_a_sequence_has_fewer_options():
    for name in ("power", "grid", "bpv"):
        with pytest.raises(
            bsm.ArgumentError, match=f"^{name} is for single meshes, not for a sequence"
        ):
            sequence_options(**{name: 3})


def test_a_largest_error_may_have_a_unit():
    assert encode_options(max_error="0.1%").contract == replace(BALANCED, farthest=0.001)
    assert encode_options(max_error=Length(0.05, True)).contract == replace(
        BALANCED, farthest=0.05, absolute=True
    )
    assert encode_options(preset="none", max_error="0.002").contract == bsm.Contract(0.002)
    assert encode_options(max_error="0.002").contract == encode_options(max_error=0.002).contract
    assert encode_options(max_error=0.002).target is None
    with pytest.raises(bsm.OptionError, match=r"at most 10% of .* a share of the diagonal"):
        encode_options(max_error=2)
    with pytest.raises(bsm.ArgumentError, match="with a unit"):
        encode_options(max_error="wide")
    with pytest.raises(bsm.OptionError, match="needs a mesh with a unit"):
        encode_options(max_error="1mm")
    options = encode_options(max_error=Length(1.0, True), theta=3)
    assert options.contract == replace(BALANCED, farthest=1.0, absolute=True)
    assert options.target == bsm.Target("theta_deg", 3.0)


def test_what_is_asked_for_holds_together_with_a_preset_that_is_named():
    fine = bsm.PRESETS["fine"].contract
    assert encode_options(preset="fine", theta=5).contract == fine
    assert encode_options(theta=5).promise == BALANCED
    assert encode_options(preset="none", theta=5).promise is None
    assert encode_options(look=2).contract == replace(BALANCED, look=2.0)
    assert encode_options(look=2, max_error=0.02).contract == replace(
        BALANCED, farthest=0.02, look=2.0
    )
    assert encode_options(preset="fine", look=2).contract == fine
    assert encode_options(preset="fine", look=0.3, max_error="5%").contract == replace(
        fine, look=0.3
    )
    assert encode_options(preset="near-lossless", max_error="0.2%") == bsm.PRESETS["near-lossless"]
    for look in (0, -1.0, float("nan")):
        with pytest.raises(bsm.OptionError, match="1 looks the same"):
            encode_options(look=look)
    with pytest.raises(bsm.OptionError, match="a contract says all"):
        encode_options(look=1, contract=bsm.Contract(0.1))
    with pytest.raises(bsm.ArgumentError, match="look must be a number"):
        encode_options(look="good")


@pytest.mark.parametrize(
    "more",
    [{"theta": 3}, {"look": 2}, {"max_error": 0.01}, {"size": 99}, {"grid": 9}, {"keep": 0.1}],
)
@pytest.mark.parametrize("preset", ["grid14", "lossless"])
def test_a_preset_that_is_a_grid_excludes_what_would_change_it(preset, more):
    with pytest.raises(
        bsm.OptionError, match=f"preset {preset} .* combined with {next(iter(more))}"
    ):
        encode_options(preset=preset, **more)


@pytest.mark.parametrize(
    "fixed", [{"grid": 4}, {"grid_cell": 0.1}, {"step": 0.1}, {"coefficients": 5}, {"bits": 12}]
)
def test_what_is_fixed_excludes_bounds(fixed):
    for bound in ({"look": 2}, {"max_error": "1%"}, {"contract": bsm.Contract(0.1)}):
        with pytest.raises(bsm.OptionError, match="fixes the output and cannot be combined with"):
            encode_options(**fixed, **bound)
    assert (
        encode_options(**fixed).promise is None
        and encode_options(preset="none", **fixed).promise is None
    )


def test_quick_sequences_search_for_nothing() -> None:
    assert (
        sequence_options().promise is not None
        and sequence_options(effort="best").promise is not None
    )
    assert sequence_options(look=None, max_error=None) == sequence_options()
    assert sequence_options(effort="quick").promise is None
    assert sequence_options(effort="quick", preset="fine").step < 0.002
    with pytest.raises(bsm.OptionError, match="unknown effort"):
        sequence_options(effort="more")
    for keywords in ({"look": 1.0}, {"kg": 0.1}):
        with pytest.raises(bsm.OptionError, match="does not search for a step"):
            sequence_options(effort="quick", **keywords)
