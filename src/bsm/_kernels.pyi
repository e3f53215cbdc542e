from typing import Annotated

import numpy
from numpy.typing import NDArray


version: str = '1.0.0'

def walk_rows(raw: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], offset: int, widths: Annotated[NDArray[numpy.int64], dict(shape=(None, None), order='C', device='cpu', writable=False)], place: int, big_endian: bool, starts: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu')], sizes: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu')]) -> int: ...

def simplify(positions: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], faces: Annotated[NDArray[numpy.int32], dict(shape=(None, None), order='C', device='cpu')], states: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu')], quadrics: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], starts: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], around: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], ends: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], marks: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], owners: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], costs: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu')], buckets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], target: int) -> int: ...
