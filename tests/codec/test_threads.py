import sys
import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from bsm import (
    END_OF_STREAM,
    NEED_DATA,
    BlockEvent,
    Decoder,
    Encoder,
    Limits,
    TriangleMesh,
    decode,
    encode,
    encode_sequence,
)
from bsm._core import Decoder as Engine
from bsm.codec import threads as codec_threads
from bsm.codec.decoding import BLOCK, CONNECTIVITY
from bsm.codec.sequence import temporal
from bsm.codec.threads import Crew, ordered_map
from bsm.encoding.options import encode_options
from tests.shapes import patch, together, torus


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_results_come_in_order(threads):
    def work(number):
        time.sleep(0.002 * (number % 3))
        return number * number

    assert list(ordered_map(work, range(20), threads)) == [n * n for n in range(20)]


def test_a_map_stays_close_to_its_consumer():
    begun = []
    results = ordered_map(lambda n: begun.append(n), range(1000), 2)
    next(results)
    assert len(begun) < 20
    results.close()


def test_a_thread_whose_start_is_interrupted_ends(monkeypatch):
    """The interpreter does not know it yet, and waits for it when the program ends."""
    started, start = [], threading.Thread.start

    def interrupted(thread):
        start(thread)
        started.append(thread)
        raise KeyboardInterrupt

    crew = Crew(3)
    monkeypatch.setattr(threading.Thread, "start", interrupted)
    for run in (crew.map, lambda work, items: list(ordered_map(work, items, 3))):
        with pytest.raises(KeyboardInterrupt):
            run(abs, range(-9, 0))
    monkeypatch.undo()
    for thread in started:
        thread.join(60)
        assert not thread.is_alive()
    assert len(started) == 2 and crew.map(abs, range(-9, 0)) == [*range(9, 0, -1)]


@pytest.mark.parametrize("threads", [1, 3])
def test_errors_come_where_their_result_would(threads):
    def work(number):
        if number == 3:
            raise ValueError("three")
        return number

    results = ordered_map(work, range(6), threads)
    assert [next(results) for _ in range(3)] == [0, 1, 2]
    with pytest.raises(ValueError, match="three"):
        next(results)


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_a_crew_returns_results_in_order_again_and_again(threads):
    crew, workers = Crew(threads), set()

    def work(number):
        workers.add(threading.get_ident())
        time.sleep(0.002 * (number % 3))
        return number * number

    for count in (0, 1, 2, 20, 7):
        assert crew.map(work, range(count)) == [n * n for n in range(count)]
    assert len(workers) <= threads


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, MemoryError])
def test_an_error_ends_the_work_of_a_crew_which_can_work_again(threads, error):
    crew, done = Crew(threads), []

    def work(number):
        if number == 3:
            raise error
        done.append(number)

    with pytest.raises(error):
        crew.map(work, range(1000))
    ended = len(done)
    assert crew.map(abs, range(-9, 0)) == list(range(9, 0, -1))
    assert len(done) == ended < 1000


def test_a_crew_that_is_forgotten_leaves_no_threads():
    crew, workers = Crew(3), set()

    def work(number):
        workers.add(threading.current_thread())
        time.sleep(0.002)

    crew.map(work, range(9))
    del crew
    for thread in workers - {threading.current_thread()}:
        thread.join(60)
        assert not thread.is_alive()


@pytest.mark.parametrize("size", [5, 9, 30])
def test_threads_do_not_change_the_smallest_stream(size):
    mesh = patch(size, size)
    assert len({encode(mesh, encode_options(threads=threads)) for threads in (1, 2, 7)}) == 1


def test_threads_do_not_change_streams_of_congruent_parts():
    one = torus(8, 12)
    moved = TriangleMesh(one.positions[:, [1, 2, 0]] + (3.0 * one.diagonal, 0.1, 0.2), one.faces)
    mesh = together(one, moved)
    streams = {encode(mesh, encode_options(threads=threads)) for threads in (1, 2, 7)}
    assert len(streams) == 1
    assert Encoder(mesh).draft().header.transforms > 0, "two parts are one and its image"


@pytest.mark.parametrize("start", ["cosines", "svd"])
def test_threads_change_neither_bytes_nor_positions(start):
    mesh = patch(60, 60)
    options = encode_options(block_size=200, key_interval=4, key_seed=start)
    streams = {encode(mesh, replace(options, threads=threads)) for threads in (1, 2, 7)}
    assert len(streams) == 1
    (data,) = streams
    once = decode(data, threads=1).positions
    for threads in (2, 7):
        assert np.array_equal(decode(data, threads=threads).positions, once)


def test_threads_that_share_a_decoder_take_turns():
    """Each event reaches one thread, with the arrays that belong to it."""
    data = encode(patch(100, 100), encode_options(threads=1, step=1e-3, block_size=100))

    def blocks_of(workers):
        found, errors = [], []
        with Decoder(threads=1) as decoder:

            def run():
                try:
                    while (
                        event := decoder.next_event()
                    ) is not END_OF_STREAM and event is not NEED_DATA:
                        if isinstance(event, BlockEvent):
                            arrays = event.vertices, event.positions, event.final
                            found.append((event.index, *(array.tobytes() for array in arrays)))
                except BaseException as error:
                    errors.append(error)

            decoder.receive_data(data)
            decoder.receive_eof()
            threads = [threading.Thread(target=run) for _ in range(workers)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            assert not errors, errors
            return sorted(found), decoder.decode_rest().positions

    alone, positions = blocks_of(1)
    assert len(alone) == 100
    for _ in range(3):
        shared, same = blocks_of(6)
        assert shared == alone and np.array_equal(same, positions)


def test_what_a_shared_engine_returns_stays_as_it_was():
    """Arrays are copied before another thread can have the decoder that they come from."""
    mesh, apart = patch(60, 60), np.random.default_rng(1).random((5000, 3))
    mesh = replace(mesh, positions=np.concatenate([mesh.positions, apart]))
    engine = Engine(Limits(), 1, True)
    options = encode_options(threads=1, step=1e-3, keep_order=True, block_size=100)
    engine.push(np.frombuffer(encode(mesh, options), np.uint8))
    engine.finish()
    while engine.next(1 << CONNECTIVITY)[0] != CONNECTIVITY:
        pass
    loose, bad, moved, over = engine.loose(), [], [], threading.Event()

    def ask_for_loose():
        while not over.is_set():
            bad.extend(
                [
                    array
                    for array, known in zip(engine.loose(), loose, strict=True)
                    if not (array == known).all()
                ]
            )

    def ask_for_changes():
        while not over.is_set():
            vertices, _, final = engine.changes()
            moved.append(vertices[final])

    threads = [threading.Thread(target=ask) for ask in (ask_for_loose, ask_for_changes) * 2]
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    for thread in threads:
        thread.start()
    while engine.next(1 << BLOCK)[0] == BLOCK:
        pass
    over.set()
    for thread in threads:
        thread.join()
    sys.setswitchinterval(interval)
    vertices, _, final = engine.changes()
    moved.append(vertices[final])
    assert len(loose[0]) == 5000 and not bad
    assert np.array_equal(np.sort(np.concatenate(moved)), np.arange(3600))


def test_matrices_take_one_thread_until_the_last_user_has_left():
    blas = codec_threads._blas()
    if blas is None:
        pytest.skip("numpy has no OpenBLAS of its own here")
    before = blas._read()
    blas._write(2)
    try:
        first, second = codec_threads.one_blas_thread(), codec_threads.one_blas_thread()
        with pytest.raises(KeyError), first:
            assert blas._read() == 1
            second.__enter__()
            raise KeyError
        assert blas._read() == 1, "another user is still at work"
        second.__exit__(None, None, None)
        assert blas._read() == 2
    finally:
        blas._write(before)


def test_a_sequence_is_encoded_without_the_threads_of_blas(monkeypatch):
    blas = codec_threads._blas()
    if blas is None:
        pytest.skip("numpy has no OpenBLAS of its own here")
    numbers, learn_basis = [], temporal.learn_basis

    def watched(*given):
        numbers.append(blas._read())
        return learn_basis(*given)

    monkeypatch.setattr(temporal, "learn_basis", watched)
    mesh = torus(6, 8)
    frames = [mesh.positions * (1.0 + 0.02 * t) for t in range(6)]
    encode_sequence(np.array(frames), mesh.faces, threads=1)
    assert numbers and set(numbers) == {1}
