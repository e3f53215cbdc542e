"""One target in one process: `python -m tools.fuzz.worker TARGET [options of libFuzzer]`."""

from __future__ import annotations

import logging
import resource
import sys
import time
from types import FunctionType, ModuleType

import atheris

from tools.copies import refuse_other_kernels
from tools.fuzz.mutate import mutate_stream
from tools.fuzz.targets import TARGETS, VECTORS, WHOLE_STREAMS, Finding, Target, run, seeds

SECONDS = 3.0
"""That one execution may take; instrumented kernels are about three times slower than others."""
SMALL = 1 << 16
GUIDING = ("bsm.bitstream.", "bsm.codec.", "bsm.files.")
"""Whose functions' coverage guides the fuzzer, beside that of the kernels."""
MEMORY = 256 << 20
"""Bytes that one execution may add to the highest memory use so far."""


def main() -> None:
    """Fuzz until libFuzzer's options say stop; the process ends inside."""
    refuse_other_kernels()
    name = sys.argv[1]
    target = TARGETS[name]
    for data in seeds(name, VECTORS):  # loads what is imported late
        run(target, data)
    instrument()

    def one(data: bytes) -> None:
        before = _peak()
        seconds = _seconds(target, data)
        if _peak() - before > MEMORY:
            raise Finding(f"{(_peak() - before) >> 20} MiB for {len(data)} bytes")
        # What had to be loaded on the way is not slow the second time.
        if seconds > SECONDS and len(data) < SMALL and (seconds := _seconds(target, data)) > SECONDS:
            raise Finding(f"{seconds:.1f} s for {len(data)} bytes")

    def mutate(data: bytes, max_size: int, seed: int) -> bytes:
        return mutate_stream(data, max_size, seed, atheris.Mutate)

    options = {"custom_mutator": mutate} if name in WHOLE_STREAMS else {}
    atheris.Setup([sys.argv[0], *sys.argv[2:]], one, **options)
    atheris.Fuzz()


def instrument() -> None:
    """Follow the coverage of every Python function of the decoders; the kernels report theirs themselves."""
    logging.disable(logging.WARNING)
    followed = sum(
        _instrument_module(module) for name, module in sorted(sys.modules.items()) if name.startswith(GUIDING)
    )
    if not followed:
        raise SystemExit(f"no function of {', '.join(GUIDING)} is followed: nothing would guide the fuzzer but kernels")


def _instrument_module(module: ModuleType) -> int:
    """Follow the functions of a module, and say how many there are."""
    followed = 0
    for item in vars(module).values():
        members = vars(item).values() if isinstance(item, type) else [item]
        for function in members:
            plain = function.fget if isinstance(function, property) else getattr(function, "__func__", function)
            if isinstance(plain, FunctionType) and plain.__module__ == module.__name__:
                atheris.instrument_func(plain)
                followed += 1
    return followed


def _seconds(target: Target, data: bytes) -> float:
    """Processor time of all threads."""
    begin = time.process_time()
    run(target, data)
    return time.process_time() - begin


def _peak() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


if __name__ == "__main__":
    main()
