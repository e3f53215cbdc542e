"""Fine filters: surfaces that follow filtered normals, and relatives."""
