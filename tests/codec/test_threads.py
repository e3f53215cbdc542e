import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from bsm.codec.basis.laplacian import factorize, laplacian_of
from bsm.codec.basis.orthogonal_iteration import first_columns, orthogonal_iteration
from bsm.codec.blocks.overlap import derive_partition, grow_blocks
from bsm.codec.decoding import decode
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions, changed
from bsm.codec.threads import ordered_map
from tests.shapes import patch


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


@pytest.mark.parametrize("start", ["cosines", "svd"])
def test_threads_change_neither_bytes_nor_positions(start):
    mesh = patch(60, 60)
    options = changed(EncodeOptions(), block_size=200, key_interval=4, key_seed=start)
    streams = {encode(mesh, replace(options, threads=threads)) for threads in (1, 2, 7)}
    assert len(streams) == 1
    (data,) = streams
    once = decode(data, threads=1).positions
    for threads in (2, 7):
        assert np.array_equal(decode(data, threads=threads).positions, once)


def test_dictionaries_are_computed_without_the_interpreter_lock():
    """While one thread is inside the kernel, another one gets on in Python."""
    mesh = patch(45, 45)
    graph = graph_of_faces(mesh.faces, 2025)
    factor = factorize(laplacian_of(grow_blocks(graph, derive_partition(graph, 1), 2025).block(0)), 0.1)
    start = first_columns(2025, 200, noisy=False)
    orthogonal_iteration(factor, start[:, :2].copy(), power=1, iterations=1)
    running = threading.Thread(target=orthogonal_iteration, args=(factor, start), kwargs={"power": 9, "iterations": 4})
    running.start()
    steps = 0
    while running.is_alive():
        steps += 1
        time.sleep(0.0005)
    running.join()
    assert steps > 3
