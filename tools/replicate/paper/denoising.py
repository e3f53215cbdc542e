"""Denoising: Tables 6 and 7, Figures 13, 14 and 16, and the dictionaries of a mesh of hundreds of thousands."""

import time
from collections.abc import Iterator
from functools import partial

import numpy as np
import scipy.linalg

from bsm.codec.blocks.overlap import Blend, Blocks
from bsm.codec.denoise.coarse import KEEP, CoarseFilter
from bsm.codec.denoise.paper import oi_rules
from bsm.codec.denoise.surface import bilateral_normal_filtering, guided_normal_filtering
from bsm.codec.geometry.metrics import decibel
from bsm.codec.signal.chain import Chain, ChainRules
from tools.laplacians import dense_laplacian
from tools.noise import gaussian_along_normals
from tools.replicate.paper.dictionaries import Floats, degree_weights, eigenvectors
from tools.replicate.paper.figures import save_surfaces
from tools.replicate.paper.models import SEGMENTS, Model, Study, fastest
from tools.replicate.paper.published import POWERS, TIMES, Line, claim, printed
from tools.replicate.paper.rivals import RIVALS, fleishman, sun
from tools.replicate.rates import Row

TIMED_BLOCKS = 40
"""Of a model with many blocks so many are solved exactly for their time, and taken for all."""
NOISES = (0.2, 0.3, 0.7)
FEW, MANY = 5, 20


def chosen(blocks: Blocks) -> tuple[list[int], float]:
    """The blocks that are timed, and how many each stands for."""
    step = max(1, blocks.count // TIMED_BLOCKS)
    numbers = list(range(0, blocks.count, step))
    return numbers, blocks.count / len(numbers)


def cut(model: Model, segments: float) -> tuple[Blocks, float]:
    """The blocks that grow from the parts that METIS finds, and seconds for them and for the order of their rows."""
    begin = time.thread_time()
    blocks = model.blocks(segments)
    for index in range(blocks.count):
        blocks.block(index)
    return blocks, time.thread_time() - begin


def svd_seconds(blocks: Blocks) -> float:
    """Time of the full dense SVD of every block: the paper's yardstick."""
    numbers, share = chosen(blocks)
    laplacians = (dense_laplacian(blocks.block(index)) for index in numbers)
    return share * sum(fastest(partial(np.linalg.svd, laplacian), 1) for laplacian in laplacians)


def subset_seconds(blocks: Blocks, keep: float) -> float:
    """Time of LAPACK's solver for just the lowest eigenvectors of every block."""
    numbers, share = chosen(blocks)
    total = 0.0
    for index in numbers:
        laplacian = dense_laplacian(blocks.block(index))
        span = [0, max(0, round(keep * len(laplacian)) - 1)]
        total += fastest(partial(scipy.linalg.eigh, laplacian, subset_by_index=span), 1)
    return share * total


def dictionary_seconds(blocks: Blocks, keep: float, rules: ChainRules, repeats: int = 1) -> float:
    """Least time of the dictionaries of one chain over all blocks, without cutting them.

    Blocks with an exact basis, the first one among them, count as much as others in the mean.
    """
    width, totals = max(1, round(keep * int(np.diff(blocks.starts).max()))), []
    for _ in range(repeats):
        chain, total, counted = Chain(rules, blocks), 0.0, 0
        for index in range(blocks.count):
            vertices = chain.begin(index)[0]
            begin = time.thread_time()
            dictionary = chain.dictionary(width)
            seconds = time.thread_time() - begin
            if not chain.is_exact:
                total, counted = total + seconds, counted + 1
            chain.commit(dictionary.shape[1], np.zeros((len(vertices), 3)))
        totals.append(total * blocks.count / max(1, counted))
    return min(totals)


def exact_steps(model: Model, blocks: Blocks, widths: list[int]) -> list[Floats]:
    """The coarse step with exact bases, for several widths."""
    blends = [Blend(len(model.noisy)) for _ in widths]
    for index in range(blocks.count):
        block = blocks.block(index)
        basis, values = eigenvectors(block, max(widths)), model.noisy[block.vertices]
        center = values.mean(axis=0)
        for width, blend in zip(widths, blends):
            kept = basis[:, :width] @ (basis[:, :width].T @ (values - center)) + center
            blend.add(block.vertices, kept, degree_weights(block.degrees))
    return [blend.all_positions() for blend in blends]


TWICE, ONCE = oi_rules(power=3, rounds=2), oi_rules(power=3, rounds=1)
"""Iterations of R^3 for each block, in one chain: the scheme of `bsm denoise --method oi`."""


def times(study: Study) -> Iterator[Row]:
    """NMSVE and seconds of a thread for dictionaries (Table 6), without and with what comes before both kinds."""
    for role, published in TIMES.items():
        model, shares = study.model(role), study.some(published)
        blocks, before = cut(model, SEGMENTS[role])
        size, repeats = (
            int(np.diff(blocks.starts).max()),
            study.repeats if blocks.count < 100 else 1,
        )
        exact = exact_steps(model, blocks, [round(share / 100 * size) for share in shares])
        svd, rows, once = svd_seconds(blocks), list[Line](), []

        def level(positions: Floats, model: Model = model) -> float:
            return decibel(model.reference.nmsve(positions) * model.reference.scale)

        for share, solved in zip(shares, exact, strict=True):
            keep = share / 100
            seconds, single = (
                dictionary_seconds(blocks, keep, rules, repeats) for rules in (TWICE, ONCE)
            )
            once.append(svd / single)
            filters = (
                model.coarse(SEGMENTS[role], keep=keep, rules=rules) for rules in (TWICE, ONCE)
            )
            errors = [level(solved), *(level(filtered(model.noisy, keep)) for filtered in filters)]
            ours = (*errors[:2], errors[1] - errors[0], svd, seconds, svd / seconds)
            there = published[share]
            more = once[-1], errors[2] - errors[0], subset_seconds(blocks, keep) / seconds
            numbers = (*ours, (svd + before) / (seconds + before), *more)
            rows.append((f"{share} %", numbers, (*there[:2], there[1] - there[0], *there[2:])))
        gaps, speeds, whole, apart = ([own[k] for _, own, _ in rows] for k in (2, 5, 6, 8))
        yield printed(
            f"The paper, 8.2 (Table 6): NMSVE and times, {role}",
            (
                *(
                    "SVD, dB",
                    "OI, dB",
                    "OI less SVD, dB",
                    "SVD, s",
                    "OI, s",
                    "speed-up",
                    "with cutting",
                ),
                *("of R^3 once, one Onorm", "R^3 once less SVD, dB", "against eigh of c vectors"),
            ),
            rows,
            f"{model.name} in {blocks.count} blocks of {size}; the coarse step of denoising, R^3 twice, NMSVE as "
            "printed. Seconds of one thread for the dictionaries; OI's first block has the exact one, and counts like "
            "the mean of the others. METIS, growth and the order of rows "
            f'take {before:.2f} s more on both sides: "with cutting" has them in both sums. Machine, libraries, files '
            "and samples of noise are others: ratios and distances in a row compare.",
            claim(
                "OI is close to SVD",
                max(*gaps, *apart) < 0.2,
                f"within {max(map(abs, gaps)):.2f} dB, with R^3 once within {max(map(abs, apart)):.2f} dB.",
                model,
                value=max(*gaps, *apart),
                unit="dB worse at most, R^3 once",
            ),
            claim(
                f"OI is {published[25][4]} to {published[10][4]} times faster",
                min(once) >= published[25][4],
                f"one iteration of R^3 with one Onorm is {min(once):.0f} to {max(once):.0f} times faster. R^3 twice is "
                f"{min(speeds):.0f} to {max(speeds):.0f} times faster, with cutting in "
                f"both sums {min(whole):.0f} to {max(whole):.0f} times.",
                model,
                value=min(once),
                unit="times at least, R^3 once",
            ),
            numbers={
                f"{role} gap": f"{max(map(abs, gaps)):.2f}",
                f"{role} apart": f"{max(map(abs, apart)):.2f}",
                f"{role} ends": f"{apart[0]:.2f} and {apart[-1]:.2f}",
                f"{role}": f"{min(speeds):.0f} to {max(speeds):.0f}",
                f"{role} whole": f"{min(whole):.0f} to {max(whole):.0f}",
                f"{role} once": f"{min(once):.0f} to {max(once):.0f}",
            },
        )


def large(study: Study) -> Iterator[Row]:
    """The dictionaries of all blocks of a large mesh, and the coarse step with them, beside SVD's."""
    model = study.model("hand")
    blocks, before = cut(model, SEGMENTS["hand"])
    filtered = CoarseFilter(
        model.faces, len(model.clean), block=model.block(SEGMENTS["hand"]), rules=TWICE
    )
    begin = time.thread_time()
    smooth = filtered(model.noisy)
    applied = time.thread_time() - begin
    made, once = (dictionary_seconds(blocks, KEEP, rules) for rules in (TWICE, ONCE))
    svd = svd_seconds(blocks)
    noisy, after = (model.reference.theta(positions) for positions in (model.noisy, smooth))
    yield printed(
        "Dictionaries of a large mesh",
        ("s", "with cutting, s"),
        [
            ("dictionaries of all blocks, OI, R^3, two iterations", (made, made + before), ()),
            ("one iteration, one Onorm", (once, once + before), ()),
            (
                f"SVD of all blocks (of {len(chosen(blocks)[0])} blocks, taken for all)",
                (svd, svd + before),
                (),
            ),
            ("coarse step with them", (applied,), ()),
        ],
        f"{model.name}, {len(model.clean):,} vertices in {blocks.count} blocks, c = {100 * KEEP:g} %, seconds of one "
        f"thread. Cutting: METIS, growth and order of rows. The coarse step lowers the mean angle from {noisy:.1f} to "
        f"{after:.1f} degrees.",
        numbers={
            "vertices": f"{len(model.clean):,}",
            "blocks": str(blocks.count),
            "made": f"{made:.2f}",
            "once": f"{once:.2f}",
            "svd": f"{svd:.0f}",
        },
    )


def powers(study: Study) -> Iterator[Row]:
    """Theta and time by the power of R (Table 7, Figure 16)."""
    for role, published in POWERS.items():
        model, rows, pictures = study.model(role), list[Line](), {}
        blocks, before = cut(model, 10)
        for name, there in study.some(published.items()):
            exact = name == "SVD"
            if exact:
                width = max(1, round(KEEP * int(np.diff(blocks.starts).max())))
                (positions,), seconds = exact_steps(model, blocks, [width]), svd_seconds(blocks)
            else:
                rules = oi_rules(int(name[2:]), 1)
                seconds = dictionary_seconds(blocks, KEEP, rules, study.repeats)
                positions = model.coarse(10, rules=rules)(model.noisy)
            pictures[name] = positions
            rows.append(
                (name, (seconds, model.reference.theta(positions), seconds + before), there)
            )
        if role == "fandisk":
            every = list(pictures.items())
            half = (len(every) + 1) // 2
            save_surfaces(
                study.output, "figure-16", model.faces, [dict(every[:half]), dict(every[half:])]
            )
        angles = {name: own[1] for name, own, _ in rows}
        high = [angle for name, angle in angles.items() if name != "SVD" and int(name[2:]) > 4]
        apart = max((abs(angle - angles["SVD"]) for angle in high), default=0.0)
        yield printed(
            f"The paper, 8.2 (Table 7): powers of R, {role}",
            ("t, s", "theta, degrees", "t with cutting, s"),
            rows,
            f"{model.name}, {model.counted(10)}, c = 10 %. Seconds of one thread for the dictionaries, with an Onorm "
            "after each R^z, or each third R; the first block's is exact and not timed. Cutting is METIS, growth and "
            "the order of rows.",
            claim(
                "For z > 4 the result is that of SVD",
                apart < 0.25,
                f"within {apart:.2f} degrees.",
                model,
                value=apart,
                unit="degrees apart at most",
            ),
            numbers={f"{role} apart": f"{apart:.2f}"},
        )


def rivals(study: Study) -> Iterator[Row]:
    """Other methods with and without the coarse step (Figure 14)."""
    fandisk = study.model("fandisk 0.3")
    every = [fandisk] if study.quick else [fandisk, study.model("twelve"), study.model("armadillo")]
    helps: dict[float, list[bool]] = {}
    rows: list[Line] = []
    pictures: dict[str, tuple[Floats, Floats]] = {}
    for model in every:
        for noise in NOISES[1:] if study.quick else NOISES:
            noisy = gaussian_along_normals(model.clean, model.faces, noise, seed=1)
            coarse = CoarseFilter(model.faces, len(noisy))(noisy)
            for name, rival in RIVALS.items():
                alone, after = rival(noisy, model.faces), rival(coarse, model.faces)
                angles = model.reference.theta(alone), model.reference.theta(after)
                helps.setdefault(noise, []).append(angles[1] < angles[0])
                angle = model.reference.theta(noisy), model.reference.theta(coarse)
                rows.append((f"{model.name}, {noise:g}, {name}", (*angle, *angles), ()))
                if model is fandisk and noise == NOISES[-1]:
                    pictures[name] = alone, after
    if pictures:
        rows_of = [{name: pair[k] for name, pair in pictures.items()} for k in (0, 1)]
        save_surfaces(
            study.output, "figure-14", fandisk.faces, rows_of, ("alone", "after the coarse step")
        )
    counts = {noise: (sum(own), len(own)) for noise, own in helps.items()}
    words = ", ".join(
        f"in {right} of {of} cases at {noise:g}" for noise, (right, of) in counts.items()
    )
    yield printed(
        "The paper, 8.2 (Figure 14): other methods after the coarse step",
        ("noisy", "coarse", "method alone", "after the coarse step"),
        rows,
        "Mean angles to the clean normals, degrees; noise in mean edges along normals. Each method with the settings "
        "of its program: 5 iterations (Fleishman), once (Jones), 20 of the normals (Sun, Zheng, Zhang). L0 has those "
        "of its paper: its program's leave 26.9 degrees on fandisk at 0.3. Tests compare the angles with those of the "
        "program of Zhang and others.",
        claim(
            "The coarse step improves other methods",
            all(right == of for right, of in counts.values()),
            f"it lowers the angle {words}.",
            *every,
            value=100
            * sum(right for right, _ in counts.values())
            / sum(of for _, of in counts.values()),
            unit="% of the cases",
        ),
        numbers={f"{noise:g}": f"{right} of {of}" for noise, (right, of) in counts.items()},
    )


FILTERS = {
    "bilateral (Fleishman)": fleishman,
    "fast and effective (Sun)": sun,
    "bilateral normal (Zheng)": bilateral_normal_filtering,
    "guided normal (Zhang)": guided_normal_filtering,
}
"""Those that iterate, and may be stopped early."""


def fewer_iterations(study: Study) -> Iterator[Row]:
    """Whether a few iterations after the coarse step do as well as many without it."""
    model, rows, right = study.model("fandisk 0.3"), list[Line](), 0
    for noise in (0.3, 0.7):
        noisy = gaussian_along_normals(model.clean, model.faces, noise, seed=1)
        coarse = CoarseFilter(model.faces, len(noisy))(noisy)
        for name, step in FILTERS.items():
            ways = (noisy, FEW), (noisy, MANY), (coarse, FEW), (coarse, MANY)
            angles = [
                model.reference.theta(step(start, model.faces, count)) for start, count in ways
            ]
            right += angles[2] <= angles[1]
            rows.append((f"{noise:g}, {name}", tuple(angles), ()))
    yield printed(
        "The paper, 8.2: iterations after the coarse step",
        (f"alone, {FEW}", f"alone, {MANY}", f"after, {FEW}", f"after, {MANY}"),
        rows,
        f"{model.name}, mean angles in degrees after {FEW} and {MANY} iterations.",
        claim(
            "The coarse step reduces the iterations for a given quality",
            right == len(rows),
            f"{FEW} after it do at least as well as {MANY} without in {right} of {len(rows)} cases.",
            model,
            value=100 * right / len(rows),
            unit="% of the cases",
        ),
        numbers={"right": f"{right} of {len(rows)}"},
    )


def coarse_to_fine(study: Study) -> Iterator[Row]:
    """The Armadillo in 20 segments: coarse, then fine (Figure 13)."""
    model = study.model("armadillo")
    noisy = gaussian_along_normals(model.clean, model.faces, 0.2, seed=1)
    coarse = model.coarse(20)(noisy)
    stages = {
        "original": model.clean,
        "noisy": noisy,
        "coarse": coarse,
        "coarse, then fine": guided_normal_filtering(coarse, model.faces, FEW),
        "fine alone": guided_normal_filtering(noisy, model.faces, FEW),
    }
    save_surfaces(study.output, "figure-13", model.faces, [stages])
    angles = {name: model.reference.theta(positions) for name, positions in stages.items()}
    better = angles["coarse, then fine"] < angles["fine alone"]
    yield printed(
        "The paper, 8.2 (Figure 13): coarse to fine",
        ("theta, degrees",),
        [(name, (angle,), ()) for name, angle in angles.items() if name != "original"],
        f"{model.name}, {model.counted(20)}, noise of 0.2 mean edges; fine: guided normals, {FEW} iterations.",
        claim(
            "Coarse, then fine is better than fine alone",
            better,
            f"{angles['coarse, then fine']:.1f} and {angles['fine alone']:.1f} degrees.",
            model,
            value=angles["coarse, then fine"] - angles["fine alone"],
            unit="degrees more than fine alone",
        ),
        numbers={"angles": f"{angles['coarse, then fine']:.1f}, not {angles['fine alone']:.1f}"},
    )
