"""Mathematics on arrays: meshes, blocks, dictionaries, signals, and the encoders and decoders made of them."""
