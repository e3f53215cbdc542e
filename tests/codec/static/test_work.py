"""What a decoder spends is bounded, whatever the faces are, and counted before it is spent."""

import numpy as np
import pytest

from bsm import (
    PRESETS,
    Decoder,
    EncodeOptions,
    LimitError,
    Limits,
    OptionError,
    TriangleMesh,
    decode,
    encode,
)
from bsm._core import Decoder as Engine
from bsm.codec.decoding import BLOCK, mask_of
from bsm.encoding.options import encode_options
from tests.blocks import blocks_of, chain_of
from tests.shapes import patch
from tools.vectors.meshes import torus

NOTHING_ELSE = {"work_per_vertex": 0.0, "work_per_byte": 0.0}


def soup(vertices, faces):
    """Triangles between vertices at random: everything is beside everything."""
    random = np.random.default_rng(0)
    corners = random.integers(0, vertices, (faces, 3))
    corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
    return TriangleMesh(random.normal(size=(vertices, 3)), corners).without_isolated_vertices()[0]


def dictionary_work(mesh, width):
    """What decoders count for a dictionary of the whole of a mesh as one block."""
    chain = chain_of(blocks_of(mesh), power=3, key_iterations=4)
    chain.begin(0)
    return chain.costs(width)[0]


def work_of(stream, limits=None):
    """What decoding costs by the decoder's own count."""
    with Decoder(limits or Limits()) as decoder:
        decoder.receive_data(stream)
        decoder.decode_rest()
        return decoder.work


def test_where_everything_is_beside_everything_a_block_costs_more():
    mesh = soup(250, 500)
    size = len(mesh.positions)
    stream = encode(
        mesh, EncodeOptions(block_size=size, overlap=1.0, coefficients=4, smoothing=0.0)
    )
    assert len(decode(stream).positions) == size
    tangled = work_of(stream)
    with pytest.raises(LimitError, match="work"):
        decode(stream, limits=Limits(work=0.99 * tangled, **NOTHING_ELSE))
    assert len(decode(stream, limits=Limits(work=1.01 * tangled, **NOTHING_ELSE)).positions) == size
    assert dictionary_work(mesh, 4) > 2 * dictionary_work(torus(10, 25), 4)


@pytest.mark.parametrize("preset", sorted({*PRESETS} - {"none", "paper"}))
def test_every_preset_is_within_the_limits_of_a_service(preset):
    assert work_of(encode(torus(60, 50), PRESETS[preset]), Limits.service()) < 1e4 * 3000


def test_an_encoder_makes_nothing_that_decoders_refuse():
    wide = {"coefficients": 900, "block_size": 4000, "bits": 12, "power": 1, "key_iterations": 1}
    with pytest.raises(OptionError, match="memory"):
        encode(torus(64, 64), encode_options(**wide, key_seed="cosines"))
    exact = {"coefficients": 400, "block_size": 800, "bits": 12, "key_interval": 1}
    with pytest.raises(OptionError, match="work"):
        encode(torus(40, 40), encode_options(**exact, limits="service"))
    with pytest.raises(OptionError, match="refuse"):
        encode(soup(1500, 6000), EncodeOptions(block_size=1500, coefficients=4))


@pytest.mark.slow
def test_a_promise_is_kept_by_a_grid_where_blocks_would_be_refused():
    stream = encode(soup(1500, 6000))
    assert len(decode(stream).faces) > 5000


def test_a_mesh_that_was_made_on_a_grid_is_sent_on_it_where_blocks_would_be_refused():
    mesh = torus(100, 80)
    made = TriangleMesh(np.rint(300.0 * mesh.positions), mesh.faces)
    stream = encode(made, EncodeOptions(block_size=8192, limits="service"))
    assert len(decode(stream, limits=Limits.service()).positions) == 8000


def test_asking_what_changed_is_not_work_of_the_stream():
    """However often a host asks, the verdict is the same; where answers take too long, the end makes vertices final."""
    mesh = patch(60, 60)
    stream = encode(mesh, encode_options(threads=1, step=1e-3, block_size=100))

    def asked(times, **limits):
        engine = Engine(Limits(**limits))
        engine.push(np.frombuffer(stream, np.uint8))
        engine.finish()
        final, positions = [], np.full((3600, 3), np.nan)
        while engine.next(mask_of(BLOCK))[0] == BLOCK:
            for _ in range(times):
                vertices, places, ended = engine.changes()
                positions[vertices] = places
                final.append(vertices[ended])
        return engine.state().work, final, positions

    work, final, positions = asked(1)
    assert asked(0)[0] == asked(3)[0] == work
    assert sum(map(len, final[:-1])) > 3000
    assert np.array_equal(np.sort(np.concatenate(final)), np.arange(3600))
    assert np.array_equal(positions, decode(stream).positions)
    below, enough = 0.0, work
    while enough > 1.001 * below:
        middle = (below + enough) / 2
        try:
            asked(0, work=middle, work_per_vertex=0.0)
            enough = middle
        except LimitError:
            below = middle
    scarce, late, same = asked(2, work=enough, work_per_vertex=0.0)
    assert scarce == work and sum(map(len, late[:-2])) < 2500
    assert np.array_equal(np.sort(np.concatenate(late)), np.arange(3600)) and np.array_equal(
        same, positions
    )
