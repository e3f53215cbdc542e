"""Everything that attacks decoders and readers: `python -m tools.attack WHAT ...`, and `WHAT --help` for what it asks.

sweep    every decoder's function on mutants, for kernels that check themselves (tools/sanitize.sh)
bombs    streams that cost as much as they can, held against what they may take
charges  many small and few large of all that can be many: time by what was charged
walk     every frame type and field as large as its bytes allow, held against the law
readers  every reader of files, with every number as large as it can be, held against the law
calls    what reading asks of the kernel, by a recorder
uses     files that say something once and use it many times, held against the law
growth   files that are large in one place, read at four times the size
costly   small files of meshes that take long to encode, found by a search
doors    files of others, read by other libraries and compared with what comes back from a stream
meshes   random meshes by the encoder in C, with sanitizers
threads  damaged streams by one thread and by four, strict and tolerant
figures  odd meshes, whose figures in results `bsm compare` must find as they were stated
proof    mutants and random streams by all decoders, on all processors, in all environments
"""

from tools.command import dispatch

ALIKE = "sweep readers calls growth proof costly uses doors meshes figures threads"
COMMANDS = {name: f"{name}:main" for name in ALIKE.split()}
COMMANDS |= {name: f"bombs:{name}" for name in ("bombs", "charges", "walk")}

if __name__ == "__main__":
    dispatch("tools.attack", COMMANDS, __doc__)
