"""The first frame of a run, which all others build upon; the twin of `codec.sequence.first_frame_decoding`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from bsm.bitstream.container.gop import GopBody
from bsm.bitstream.container.header import Header
from bsm.bitstream.errors import OptionError
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.arrays import Matrix
from bsm.codec.sequence.cost import gop_cost, gop_memory, loop_memory
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.tracks import Setting, make_setting
from bsm.codec.signal.chain import ChainRules
from bsm.codec.signal.transform import smallest_step
from bsm.codec.static.admission import admit, as_of_decoders
from bsm.codec.static.assembly import blended
from bsm.codec.static.coding import Adaptive
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.rules import STIFFNESS, Scheme
from bsm.codec.static.units import single
from bsm.codec.static.ways.block_coder import FRAME, CodedBlock, Progress, encode_blocks
from bsm.codec.static.work import Allowance

FIRST_STEP = 0.3
"""Of the first frame, in steps of the others, which follow from it; 0.4 costs 0.5 % more, with low delay 1 to 3 %."""

FIRST_FRAME = ChainRules(
    exact=False,
    key_interval=0,
    power=3,
    iterations=2,
    key_iterations=2,
    shift=2.0**-5,
    stiffness=STIFFNESS,
)
"""The first frame is one chain; the dictionaries of its key block and those of all parts start from cosines alike."""


@dataclass(frozen=True, eq=False)
class Opening:
    """Everything before the GOPs but the connectivity: the first frame, coded as a static mesh is."""

    header: Header
    blocks: list[CodedBlock]
    setting: Setting
    allowance: Allowance
    limits: str

    def has_room(self, body: GopBody) -> bool:
        """Whether decoders have the memory for a GOP, with attributes that move about as positions do."""
        (positions,) = body.fields
        others = (
            replace(positions, width=track.width, components=-(-positions.components * track.width // 3))
            for track in self.setting.tracks[1:]
        )
        body = replace(body, fields=(positions, *others))
        dictionaries = self.setting.dictionaries
        beside = loop_memory(dictionaries.largest, body)
        return dictionaries.fits(gop_memory(self.setting.vertices, body, self.setting.sites), beside, _received(body))

    def admit(self, body: GopBody, number: int) -> None:
        """Do the sums of decoders for a GOP from frame `number` on, or raise `OptionError` if they would refuse it."""
        vertices, allowance, dictionaries = self.setting.vertices, self.allowance, self.setting.dictionaries
        received = _received(body)
        allowance.keep(0.0, received)
        allowance.show(vertices * (body.frames if number else body.frames - 1))
        with as_of_decoders(self.limits):
            allowance.limits.check("sequence_bytes", gop_memory(vertices, body))
            again = dictionaries.reserve(
                gop_memory(vertices, body, dictionaries.sites), loop_memory(dictionaries.largest, body)
            )
            allowance.spend(again + gop_cost(dictionaries.sites, vertices, self.setting.given, body), received)


def _received(body: GopBody) -> int:
    return sum(field.size for field in body.fields)


def open_sequence(
    prepared: Prepared,
    options: SequenceOptions,
    frames: int,
    progress: Progress,
    before: Allowance,
    moving: Sequence[Matrix] = (),
) -> Opening:
    """Code the first frame, which all others of a run build upon; `frames` as for `SequenceEncoder`."""
    finest = smallest_step(prepared.size)
    step = options.first_step or max(FIRST_STEP * options.step, finest)
    if step < finest:
        raise OptionError(f"first_step = {step:g} is too fine for blocks of {prepared.size}, try {finest:.1e}")
    width = max(1, round(options.keep * prepared.size))
    scheme = Scheme(prepared.blocks, replace(FIRST_FRAME, whole=width), Adaptive(width, single(step)))
    blocks = encode_blocks(scheme, prepared.positions, threads=options.threads, progress=progress)
    header = Header(
        vertices=prepared.graph.size,
        faces=len(prepared.mesh.faces),
        block_size=prepared.size,
        coefficients=width,
        center=prepared.units.center,
        scale=prepared.units.scale,
        sequence=(frames, options.together(prepared.graph.size)),
        **scheme.fields(),
    )
    positions = blended(prepared.graph.size, (block.decoded for block in blocks))
    allowance = Allowance(NAMED_LIMITS[options.limits]())
    allowance.follow(before)
    allowance.show(header.vertices)  # the first GOP does, at least
    with as_of_decoders(options.limits):
        admit(allowance, prepared, blocks)
        allowance.keep(0.0, sum(len(block.packet.data) + FRAME for block in blocks))
        allowance.limits.check("sequence_bytes", 8.0 * header.vertices * header.coefficients)
        setting = make_setting(
            scheme,
            prepared.mesh.faces,
            positions,
            given=prepared.given,
            width=width,
            threads=options.threads,
            allowance=allowance,
            moving=moving,
        )
    return Opening(header, blocks, setting, allowance, options.limits)
