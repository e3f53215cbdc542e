"""The start of models is learnt: the program codes grids as the encoder does, and a start saves bytes."""

import re

import pytest

from bsm.bitstream.container.wire import FrameType
from tools import train_start
from tools.surgery import scan
from tools.vectors.store import FOLDER

NAMES = "good-congruence-mirrors", "good-congruence-turned", "good-grid-knot"


@pytest.mark.slow  # compiles the library
def test_the_start_moves_to_the_grids_that_it_learns_from(tmp_path, capsys):
    streams = [FOLDER.parent / "1.1" / f"{name}.bsm" for name in NAMES]
    train_start.main([*map(str, streams), "--rounds", "3", "--output", str(tmp_path / "start.bin")])
    rounds = re.findall(r"round \d: (\d+) grids, (\d+) bytes", capsys.readouterr().out)
    assert {grids for grids, _ in rounds} == {"2"}, "the last has no congruent parts"
    sizes = [int(size) for _, size in rounds]
    packets = [
        packet for path in streams[:2] for packet, span in scan(path.read_bytes()) if span.type == FrameType.GRID
    ]
    bytes_of_streams = sum(len(packet.data) for packet in packets)
    assert bytes_of_streams <= sizes[0] <= 1.1 * bytes_of_streams, "hit rates count as if they had been learnt already"
    assert sizes[0] > sizes[1] > sizes[2]
    assert (tmp_path / "start.bin").stat().st_size == 1750
