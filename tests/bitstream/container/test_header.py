import contextlib
import math
from dataclasses import fields, replace

import msgpack
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm.bitstream.container.header import FIRST_IGNORABLE_KEY, HEADER_DEFAULTS, HEADER_FIELDS, Header
from bsm.bitstream.container.layout import parse_header, write_header
from bsm.bitstream.container.maps import write_map
from bsm.bitstream.errors import BsmError, CorruptError, LimitError, OptionError, UnsupportedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from tests.bitstream.streams import SMALL_HEADER

SMALL = {1: 100, 2: 190, 3: 3, 4: 60, 5: 10}


def parse(payload: bytes, limits: Limits = DEFAULT_LIMITS) -> Header:
    return parse_header(payload, limits)


def small_with(changes: dict) -> bytes:
    return write_map(sorted((SMALL | changes).items()))


def test_known_bytes():
    # fixmap of 5; 1: 100, 2: uint8 190, 3: 3, 4: 60, 5: 10
    assert write_header(SMALL_HEADER).hex() == "85016402ccbe0303043c050a"
    # 12 (shift): 0.5 is exact in single precision; 18 (scale): 0.1 is not
    header = replace(SMALL_HEADER, shift=0.5, scale=0.1)
    assert write_header(header).hex() == "87016402ccbe0303043c050a0cca3f00000012cb3fb999999999999a"


def test_keys_are_unique_and_every_field_is_in_the_table():
    keys = [declared.key for declared in HEADER_FIELDS.values()]
    assert len(set(keys)) == len(keys) == len(fields(Header))
    assert all(0 < key < FIRST_IGNORABLE_KEY for key in keys)


def legal_value(name):
    declared = HEADER_FIELDS[name]
    if declared.type is int:
        return st.integers(int(declared.low), int(declared.high))
    if declared.type is tuple and declared.item is int:
        number = st.integers(int(declared.low), int(declared.high))
    else:
        number = st.floats(declared.low, declared.high)
    if declared.type is float:
        return number
    least, most = declared.lengths
    return st.lists(number, min_size=least, max_size=most).map(tuple)


NOT_ALONE = (
    "blocks",
    "block_size",
    "coefficients",
    "grid",
    "lattice",
    "refinements",
    "borders",
    "corner",
    "sections",
    "light",
    "again",
)


@given(st.fixed_dictionaries({}, optional={n: legal_value(n) for n in HEADER_DEFAULTS if n not in NOT_ALONE}))
def test_round_trip(changes):
    changes["details"] = min(changes.get("details", 0), SMALL_HEADER.block_size)
    if (changes["details"] > 0) != (changes.get("detail_step", 0.0) > 0):
        changes["details"], changes["detail_step"] = 0, 0.0
    if changes.get("frames") or changes.get("run"):
        changes["gop_frames"] = changes.get("gop_frames") or 1
    header = replace(SMALL_HEADER, **changes)
    assert parse(write_header(header), Limits(frames=2**31, gop_frames=2**31)) == header


GRID = Header(vertices=100, faces=190, grid=(1023, 7, 0), center=(1.0, 2.0, 3.0), scale=0.5, lattice=(4095, 1023))
LAYERS = st.tuples(st.floats(2.0**-40, 1.0), st.just(0.0) | st.floats(1 / 16, 64.0))


def test_a_mesh_that_a_run_has_again_comes_back():
    again = Header(vertices=100, faces=190, frames=300, gop_frames=9, run=4, again=3)
    # 21: uint16 300, 23: 9, 43: 4, 44: 3
    assert write_header(again).hex() == "86016402ccbe15cd012c17092b042c03"
    assert parse(write_header(again)) == again
    for wrong in ({"again": 5}, {"gop_frames": 0}, {"blocks": 1}, {"attributes": 1}, {"step": 0.5}):
        with pytest.raises(OptionError, match="contradicts itself"):
            replace(again, **wrong)
    with pytest.raises(OptionError, match="a run of a static mesh"):
        replace(SMALL_HEADER, run=1)


def test_a_light_grid_comes_back():
    light = replace(GRID, light=1)
    assert write_header(light) == b"\x87" + write_header(GRID)[1:] + b"\x2a\x01"
    assert parse(write_header(light)) == light


def test_known_bytes_of_a_grid():
    # 1: 100, 2: uint8 190, 28: [uint16 1023, 7, 0]
    assert write_header(Header(vertices=100, faces=190, grid=(1023, 7, 0))).hex() == "83016402ccbe1c93cd03ff0700"
    assert parse(write_header(GRID)) == GRID


@given(st.lists(LAYERS, max_size=4))
def test_layers_round_trip(layers):
    header = replace(SMALL_HEADER, refinements=tuple(x for layer in layers for x in layer))
    assert [(layer.step, layer.ratio) for layer in parse(write_header(header)).layers] == layers
    assert [layer.axes for layer in header.layers] == [3 if ratio else 1 for _, ratio in layers]


@given(st.lists(st.tuples(st.integers(1, 27), st.integers(1, 3)), max_size=7))
def test_sections_round_trip(pairs):
    header = replace(SMALL_HEADER, blocks=30, sections=tuple(x for pair in pairs for x in pair))
    assert parse(write_header(header)) == header
    assert [(len(span.faces), len(span.blocks)) for span in header.spans[:-1]] == pairs
    assert [face for span in header.spans for face in span.faces] == list(range(header.faces))
    assert [block for span in header.spans for block in span.blocks] == list(range(header.blocks))


def test_known_bytes_of_sections():
    # 41: [60, 2]
    assert write_header(replace(SMALL_HEADER, sections=(60, 2))).hex() == "86016402ccbe0303043c050a29923c02"


@pytest.mark.parametrize(
    "changes",
    [
        {"sections": (60,)},
        {"sections": (60, 2, 60)},
        {"sections": (0, 1)},
        {"sections": (60, 0)},
        {"sections": (190, 1)},
        {"sections": (100, 1, 90, 1)},
        {"sections": (60, 3)},
        {"sections": (60, 1, 60, 2)},
        {"sections": (1, 1) * 8, "blocks": 20},
        {"sections": (60, 1), "gop_frames": 1},
    ],
)
def test_contradictions_of_sections(changes):
    with pytest.raises(OptionError):
        replace(SMALL_HEADER, **changes)


@pytest.mark.parametrize(
    "changes",
    [
        {"grid": (1, 2)},
        {"grid": (1, 2, 2**20)},
        {"lattice": (9,)},
        {"corner": (1, 2)},
        {"corner": (1, 2, 3)},  # and a center
        {"lattice": (2000, 1022)},  # fewer points than values
        {"lattice": (1022, 1023)},  # more points than cells
        {"grid": ()},  # a lattice, but no grid and no blocks
        {"blocks": 3},
        {"step": 0.5},
        {"smoothing": 1.0},
        {"gop_frames": 1},
        {"refinements": (0.5, 0.0)},
        {"sections": (60, 1)},
        {"light": 2},
    ],
)
def test_contradictions_of_a_grid(changes):
    with pytest.raises(OptionError):
        replace(GRID, **changes)


@pytest.mark.parametrize(
    "changes",
    [
        {"refinements": (0.5,)},
        {"refinements": (0.0, 0.0)},
        {"refinements": (1.5, 0.0)},
        {"refinements": (0.5, 0.01)},
        {"refinements": (0.5, 65.0)},
        {"refinements": (0.5, 0.0) * 5},
        {"refinements": (0.5, 1.0), "gop_frames": 1},
        {"borders": 1},
        {"refinements": (0.5, 1.0), "borders": 2},
        {"lattice": (9, 3)},
        {"light": 1},
    ],
)
def test_contradictions_of_refinements(changes):
    with pytest.raises(OptionError):
        replace(SMALL_HEADER, **changes)


@given(st.binary(max_size=60))
def test_noise_is_a_typed_error_or_a_header(noise):
    try:
        header = parse(noise)
    except BsmError:
        return
    assert parse(write_header(header), Limits(frames=2**31, gop_frames=2**31)) == header


@given(st.data())
def test_a_changed_byte_is_a_typed_error_or_another_header(data):
    payload = bytearray(
        write_header(replace(SMALL_HEADER, center=(0.1, 0.2, 0.3), stiffness=2.0, frames=7, gop_frames=7))
    )
    index = data.draw(st.integers(0, len(payload) - 1))
    payload[index] ^= data.draw(st.integers(1, 255))
    with contextlib.suppress(BsmError):
        parse(bytes(payload))


@pytest.mark.parametrize(
    "changes",
    [
        {1: 0},  # below the range
        {1: -1},
        {1: 2**31},  # above it
        {1: 100.0},  # a float for an integer
        {1: "100"},
        {12: 1},  # an integer for a float
        {12: 1e-30},
        {17: [0.0, 0.0, 1]},
        {17: [0.5, 0.5]},  # too short
        {19: [0.5]},  # an array for a float
        {41: [1] * 16},  # too long
        {31: 256},  # not even a reserved method
        {12: 0.0078125},  # the default, stored
        {27: 0},
        {-1: 0},
        {2: 33},  # more vertices than corners
        {3: 101, 1: 100},  # more blocks than vertices
        {4: 101},
        {4: 33},  # blocks that do not cover the mesh
        {5: 61},  # more coefficients than vertices in a block
        {21: 7},  # frames of a static mesh
        {FIRST_IGNORABLE_KEY: [[1]]},
        {FIRST_IGNORABLE_KEY: math.inf},
    ],
)
def test_corrupt_fields(changes):
    with pytest.raises(CorruptError):
        parse(small_with(changes))


@pytest.mark.parametrize("key", [1, 2, 3, 4, 5])
def test_required_fields(key):
    with pytest.raises(CorruptError, match="lacks" if key < 3 else "neither blocks nor a grid"):
        parse(write_map((k, v) for k, v in SMALL.items() if k != key))


def test_unknown_keys_and_methods():
    with pytest.raises(UnsupportedError):
        parse(small_with({FIRST_IGNORABLE_KEY - 1: 0}))
    with pytest.raises(UnsupportedError):
        parse(small_with({0: 0}))
    with pytest.raises(UnsupportedError):
        parse(small_with({6: 2}))
    assert parse(small_with({FIRST_IGNORABLE_KEY: [1, "x", b"y"], 1000: 0.5})) == SMALL_HEADER


@pytest.mark.parametrize(
    "payload",
    [
        b"",
        b"\x80",  # an empty map
        b"\x90",
        b"\xc0",
        write_map([(2, 190), (1, 100), (3, 3), (4, 60), (5, 10)]),  # not ascending
        write_map([(1, 100), (1, 100), (2, 190), (3, 3), (4, 60), (5, 10)]),  # twice
        write_map(SMALL.items()) + b"\x00",  # trailing
        write_map(SMALL.items())[:-1],
        b"\xde\x00\x05" + write_map(SMALL.items())[1:],  # a longer form of the map
        write_map(SMALL.items()).replace(b"\x01\x64", b"\x01\xcc\x64"),  # a longer form of 100
        msgpack.packb(SMALL | {16: 0.5}),  # a double where a single is exact
        msgpack.packb({True: 1}),
        msgpack.packb({1: {2: 3}}),
        msgpack.packb({1: None}),
        msgpack.packb({1: msgpack.ExtType(1, b"")}),
        msgpack.packb({1: msgpack.Timestamp(1)}),
        b"\x81\x01" + b"\x91" * 2000,  # deep nesting
        b"\xdf\xff\xff\xff\xff",  # four billion entries
        b"\x81\x01\xdd\xff\xff\xff\xff",
        b"\x81\x01\xdb\xff\xff\xff\xff",
        b"\x81\xa1\xff\x01",  # not UTF-8
    ],
)
def test_corrupt_maps(payload):
    with pytest.raises(CorruptError):
        parse(payload)


def test_limits():
    # two billion vertices are legal, but more than anybody granted
    claim = write_map({1: 2_000_000_000, 2: 2_000_000_000, 3: 3_000_000, 4: 1000, 5: 10}.items())
    with pytest.raises(LimitError, match=r"vertices"):
        parse(claim)
    with pytest.raises(CorruptError, match=r"legal range"):
        parse(small_with({1: 4_000_000_000, 2: 4_000_000_000}))
    for name in ("vertices", "faces", "blocks", "block_size", "coefficients"):
        exact = replace(DEFAULT_LIMITS, **{name: getattr(SMALL_HEADER, name)})
        assert parse(write_header(SMALL_HEADER), exact) == SMALL_HEADER
        with pytest.raises(LimitError, match=name):
            parse(write_header(SMALL_HEADER), replace(exact, **{name: getattr(SMALL_HEADER, name) - 1}))


@pytest.mark.parametrize(
    "changes",
    [{"vertices": 0}, {"vertices": 1.5}, {"shift": math.nan}, {"shift": "x"}, {"key_seed": 2}, {"center": (1, 2)}],
)
def test_a_header_cannot_be_made_of_illegal_values(changes):
    with pytest.raises(OptionError):
        replace(SMALL_HEADER, **changes)


def test_a_header_takes_any_number_type():
    header = replace(SMALL_HEADER, center=[1, 2, 3], step=1)
    assert header.center == (1.0, 2.0, 3.0)
    assert type(header.step) is float
    assert parse(write_header(header), Limits(frames=2**31, gop_frames=2**31)) == header
