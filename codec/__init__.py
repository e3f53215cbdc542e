"""A streaming spectral codec for triangle meshes: encoder, decoder, and the mathematics they share."""

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
from codec.targets import Target

__all__ = [
    "PRESETS",
    "BlockEvent",
    "ConnectivityEvent",
    "Decoder",
    "EncodeOptions",
    "Encoder",
    "EndEvent",
    "HeaderEvent",
    "LossEvent",
    "Target",
    "TriangleMesh",
    "decode",
    "encode",
    "encode_chunks",
]
