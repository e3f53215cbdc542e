"""Scenes of glTF that stay scenes: geometry as BSM streams, by an extension (`spec/EXT_bsm_compression.md`)."""
