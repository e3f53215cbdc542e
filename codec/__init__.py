"""A streaming spectral codec for triangle meshes: static and animated, and the mathematics they share."""

from codec.decoder import (
    BlockEvent,
    ConnectivityEvent,
    Decoder,
    EndEvent,
    HeaderEvent,
    LossEvent,
    decode,
)
from codec.encoder import Encoder, encode, encode_chunks
from codec.mesh import TriangleMesh
from codec.options import PRESETS, EncodeOptions
from codec.sequence_decoder import FrameEvent, GopLost, SequenceDecoder, decode_sequence
from codec.sequence_encoder import SequenceEncoder, encode_sequence
from codec.sequence_options import SequenceOptions
from codec.targets import Target

__all__ = [
    "PRESETS",
    "BlockEvent",
    "ConnectivityEvent",
    "Decoder",
    "EncodeOptions",
    "Encoder",
    "EndEvent",
    "FrameEvent",
    "GopLost",
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
    "encode_chunks",
    "encode_sequence",
]
