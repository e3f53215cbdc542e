from typing import Annotated

import numpy
from numpy.typing import NDArray


def collect_edges(faces: Annotated[NDArray[numpy.int32], dict(shape=(None, None), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], filled: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], ends: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')]) -> int: ...
