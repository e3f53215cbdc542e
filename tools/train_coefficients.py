"""Learn what the coefficient coder knows beforehand (`spec/priors.bin`) from a folder of meshes.

    python -m tools.train_coefficients MESHES [--output spec/priors.bin] [--rounds 2]

The meshes are encoded with several steps and block sizes; the levels are taken from these streams. Meshes that serve
to evaluate the codec are left out, see `TRAINING_MESHES`. The result replaces a part of the format: streams of the
old one can no longer be decoded. Numbers are rounded as far as that costs about a thousandth of the bytes: pages
fetch them with the decoder.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize

from bsm.bitstream.coefficients.adaptive import (
    BINS,
    EXPECTATIONS,
    NEIGHBOURS,
    NODES,
    SELECTORS,
    SITUATIONS,
    UNIT,
    WEIGHT_BITS,
    CoefficientModel,
    Experience,
    Levels,
    Past,
    decode_coefficients,
    encode_coefficients,
    look_at_block,
    make_past,
    shipped_experience,
)
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.reader import Reader, Signal
from bsm.bitstream.entropy.range_coder import Bank, make_bank
from bsm.codec.static.coding import chain_rules
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from bsm.files.mesh import read_mesh

TRAINING_MESHES = (
    "c3d_spot",
    "cgal_elephant_with_holes",
    "dragon_22998",
    "fr_casting",
    "gargoyle_10002",
    "scan_angel",
    "sharpsphere",
    "trim_star",
)
SETTINGS = tuple(
    EncodeOptions(step=step, block_size=size, key_interval=interval)
    for size, interval, steps in (
        (500, 0, (0.0025, 0.005)),
        (500, 16, (0.0004, 0.0018, 0.0035, 0.007)),
        (1000, 0, (0.0025, 0.005)),
    )
    for step in steps
)
MAX_SEEN = 60
_SEEN_UNIT = 4
_SEEN = np.array([0, 1, 2, 2, 4, 4, 4, 8, 8, 8, 8, 8, 15, 15, 15, 15])
_MIXING_UNIT = 256
_OWN = np.array([0, 1, 2, 3, 4, 5, 6, 7, 8, 17, 18, 19])
_EARLIER = np.arange(9, NEIGHBOURS)

ChainLevels = list[Levels]


def chains_of_stream(data: bytes) -> Iterator[ChainLevels]:
    """Levels of a static stream, chain by chain."""
    reader = Reader()
    reader.receive_data(data)
    reader.receive_eof()
    chain: ChainLevels = []
    while not isinstance(packet := reader.next_packet(), Signal):
        if isinstance(packet, Header):
            header, starts = packet, chain_rules(packet).chain_starts(packet.blocks)
        elif isinstance(packet, packets.Block):
            if packet.index in starts:
                if chain:
                    yield chain
                chain, model = [], CoefficientModel(header.coefficients)
            chain.append(decode_coefficients(model, packet.data, packet.coefficients))
    yield chain


def fit_expectations(chains: list[ChainLevels]) -> npt.NDArray[np.uint16]:
    """Weights of the expectations, of the greatest likelihood for geometrically distributed magnitudes."""
    inputs, kinds, magnitudes = (np.concatenate(parts) for parts in zip(*map(_surroundings, chains)))
    weights = np.zeros((EXPECTATIONS, SITUATIONS, NEIGHBOURS), np.uint16)
    for expectation, used in enumerate((np.arange(NEIGHBOURS), _OWN, _EARLIER)):
        for kind in range(SITUATIONS):
            here = kinds == kind
            known = used[inputs[here][:, used].any(axis=0)]
            fitted = _fit_geometric(inputs[here][:, known] / UNIT, np.minimum(magnitudes[here], 300))
            weights[expectation, kind, known] = np.rint(fitted * (1 << WEIGHT_BITS))
    return weights


def learn(chains: list[ChainLevels], expectations: npt.NDArray[np.uint16], seed: int = 0) -> Experience:
    """Probabilities and mixing weights after coding all chains in one go, twice, in random orders."""
    bank = make_bank(EXPECTATIONS * BINS * NODES, SELECTORS * NODES, EXPECTATIONS, limit=1023, rate=2)
    random = np.random.default_rng(seed)
    for _ in range(2):
        for number in random.permutation(len(chains)):
            model = CoefficientModel(max(map(len, chains[number])), _experience(bank, expectations))
            model.bank = bank
            for levels in chains[number]:
                encode_coefficients(model, levels)
    return _experience(bank, expectations)


def coded_size(chains: list[ChainLevels], experience: Experience) -> int:
    """Bytes of the payloads that code `chains`."""
    total = 0
    for chain in chains:
        model = CoefficientModel(max(map(len, chain)), experience)
        total += sum(len(encode_coefficients(model, levels)) for levels in chain)
    return total


def _experience(bank: Bank, expectations: npt.NDArray[np.uint16]) -> Experience:
    seen = np.minimum(bank.slots & 1023, MAX_SEEN) // _SEEN_UNIT
    mixing = np.clip(np.rint(bank.weights / 16), -(1 << 15), (1 << 15) - 1)
    return Experience(expectations, mixing.astype(np.int16), ((bank.slots >> 20 << 4) | seen).astype(np.uint16))


def rounded(experience: Experience) -> Experience:
    """Learnt numbers with few different ones among them; what is round stays as it is."""
    probability, seen = experience.slots.astype(np.int64) >> 4, experience.slots & 15
    rarer = np.minimum(probability, 4096 - probability)
    kept = np.where(seen == 0, rarer, _leading(rarer, 2))
    slots = np.where(probability <= 2048, kept, 4096 - kept) << 4 | _SEEN[seen]
    mixing = np.rint(experience.mixing / _MIXING_UNIT) * _MIXING_UNIT
    expectations = _leading(experience.expectations.astype(np.int64), 3)
    return Experience(expectations.astype(np.uint16), mixing.astype(np.int16), slots.astype(np.uint16))


def _leading(values: npt.NDArray[np.int64], digits: int) -> npt.NDArray[np.int64]:
    """Numbers >= 0 of any shape, rounded to so many binary digits."""
    unit = np.maximum(np.frexp(values)[1].astype(np.int64) - digits, 0)
    leading: npt.NDArray[np.int64] = values + (1 << unit >> 1) >> unit << unit
    return leading


def _surroundings(chain: ChainLevels) -> tuple[npt.NDArray[np.int32], ...]:
    """Inputs, situation and magnitude of every coefficient of a chain."""
    past = make_past(max(map(len, chain)))
    parts = [_look_at_block(past, levels) for levels in chain]
    inputs, kinds, magnitudes = (np.concatenate(part) for part in zip(*parts))
    return inputs, kinds, magnitudes


def _look_at_block(past: Past, levels: Levels) -> tuple[npt.NDArray[np.int32], ...]:
    kinds = np.tile(np.arange(3, dtype=np.int32) + (3 if past.blocks[0] == 0 else 0), len(levels))
    return look_at_block(past, levels), kinds, np.abs(levels.reshape(-1))


def _fit_geometric(inputs: npt.NDArray[np.float64], values: npt.NDArray[np.int32]) -> npt.NDArray[np.float64]:
    """Weights w >= 0 for which geometric distributions of mean `inputs @ w` make `values` most likely."""

    def cost(weights: npt.NDArray[np.float64]) -> tuple[float, npt.NDArray[np.float64]]:
        mean = inputs @ weights + 1e-3
        slope = (values + 1) / (1 + mean) - values / mean
        likelihood = (values + 1) * np.log1p(mean) - values * np.log(mean)
        return float(likelihood.mean()), inputs.T @ slope / len(values)

    start = np.full(inputs.shape[1], 0.03)
    found = minimize(cost, start, jac=True, method="L-BFGS-B", bounds=[(0, 60)] * len(start))
    weights: npt.NDArray[np.float64] = found.x
    return weights


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", type=Path, help="folder with the training meshes")
    parser.add_argument("--output", type=Path, default=Path("spec/priors.bin"))
    arguments = parser.parse_args()
    meshes = [read_mesh(arguments.meshes / f"{name}.ply").mesh for name in TRAINING_MESHES]
    streams = (encode(mesh, options) for mesh in meshes for options in SETTINGS)
    taught = [chain for stream in streams for chain in chains_of_stream(stream)]
    shipped, experience = shipped_experience(), rounded(learn(taught, fit_expectations(taught)))
    print(f"{len(taught)} chains: {coded_size(taught, shipped)} -> {coded_size(taught, experience)} bytes")
    arguments.output.write_bytes(experience.to_bytes())


if __name__ == "__main__":
    main()
