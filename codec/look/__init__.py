"""How much two meshes look alike, in pictures of both."""
