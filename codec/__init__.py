"""A streaming spectral codec for triangle meshes: static and animated, and the mathematics they share."""

from codec.geometry.mesh import TriangleMesh
from codec.sequence.decoder import FrameEvent, SequenceDecoder, decode_sequence
from codec.sequence.encoder import SequenceEncoder, encode_sequence
from codec.sequence.options import SequenceOptions
from codec.static.decoder import Decoder, decode
from codec.static.encoder import Encoder, encode
from codec.static.events import BlockEvent, ConnectivityEvent, EndEvent, HeaderEvent, LossEvent
from codec.static.options import PRESETS, EncodeOptions
from codec.static.targets import Target

__all__ = [
    "PRESETS",
    "BlockEvent",
    "ConnectivityEvent",
    "Decoder",
    "EncodeOptions",
    "Encoder",
    "EndEvent",
    "FrameEvent",
    "HeaderEvent",
    "LossEvent",
    "SequenceDecoder",
    "SequenceEncoder",
    "SequenceOptions",
    "Target",
    "TriangleMesh",
    "decode",
    "decode_sequence",
    "encode",
    "encode_sequence",
]
