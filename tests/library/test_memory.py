"""Memory that ends: no function of the decoder goes on without the memory that it asked for."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import bsm
from tests.library.conftest import linked
from tests.shapes import knot
from tools.amalgamate import ROOT, sources
from tools.bsmdec import compiled

FOUND = r"\b(?:find_memory|find_zeros|host_memory)\("
LIBRARY = [ROOT / path for path in sources(encodes=True)]
AGAIN = """#include <bsmdec.h>
#include <stdio.h>

int main(int count, char **names) {
    static unsigned char bytes[1 << 16];
    FILE *file = fopen(names[count - 1], "rb");
    size_t size = fread(bytes, 1, sizeof bytes, file);
    for (int i = 1; i <= 12; i++) {
        bsmdec_mesh *mesh;
        if (bsmdec_decode(bytes, size, NULL, &mesh) != BSMDEC_OK) return 1;
        bsmdec_release(mesh);
        if (i != 2 && i != 12) continue;
        FILE *status = fopen("/proc/self/status", "r");
        long most = 0;
        for (char line[256]; fgets(line, sizeof line, status);) sscanf(line, "VmHWM: %ld", &most);
        fclose(status);
        printf("%ld\\n", most);
    }
}
"""
CARELESS = '#include "bitstream/context.h"\nvoid go_on(Arena *arena, Ints *values) { take_ints(arena, 3, values); }\n'
SAMPLE = (
    "exact-tiny",
    "packed-zstd",
    "pieces-follow",
    "attribute-colors",
    "exact-splits",
    "sequence-learnt",
)


def test_a_host_without_memory_gets_an_error_and_nothing_else(tmp_path: Path) -> None:
    """Each allocation fails once, and 64 heaps are too small; tools/sanitize.sh does that to more, with sanitizers."""
    streams = [ROOT / f"spec/vectors/1.0/good-{name}.bsm" for name in SAMPLE]
    starve = linked(compiled(), ROOT / "tools/attack/starve.c", tmp_path / "starve", "-w")
    run = subprocess.run([starve, "1", *streams], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert run.stdout.startswith(f"{len(SAMPLE)} streams")


def test_memory_is_taken_by_what_says_whether_it_is_there() -> None:
    """Only context.c sees a pointer that may be NULL, and is_there, whose answer compilers ask to look at."""
    for path in LIBRARY:
        if path.name != "context.c":
            others = re.sub(rf"is_there\(\*?[\w.>-]+ = {FOUND}", "", path.read_text())
            assert not re.search(FOUND, others), path.name


@pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="/proc of Linux says how much memory there was"
)
def test_decoding_again_takes_no_more_memory(tmp_path: Path) -> None:
    stream = tmp_path / "knot.bsm"
    stream.write_bytes(bsm.encode(knot(12_000), step=2.0**-10, smoothing=1.0, coefficients=48))
    (tmp_path / "again.c").write_text(AGAIN, encoding="ascii")
    again = linked(compiled(), tmp_path / "again.c", tmp_path / "again")
    run = subprocess.run([again, stream], capture_output=True, text=True, check=True)
    second, last = map(int, run.stdout.split())
    assert last < second + 4096  # KiB


@pytest.mark.slow
def test_no_answer_of_a_function_is_ignored(tmp_path: Path) -> None:
    """Every function that returns bool says whether it is done: the compiler finds calls that do not look at that."""
    (tmp_path / "careless.c").write_text(CARELESS, encoding="ascii")
    checked = tmp_path / "checked.h"
    checked.write_text(
        "#include <stdbool.h>\n#undef bool\n#define bool __attribute__((warn_unused_result)) _Bool\n",
        encoding="ascii",
    )
    flags = [
        "-std=gnu11",
        "-O0",
        f"-I{ROOT}",
        "-DKERNEL_ONE_TARGET",
        "-Wno-attributes",
        "-include",
        str(checked),
    ]
    ignored = {}
    for path in [tmp_path / "careless.c", *(path for path in LIBRARY if path.name != "host.c")]:
        command = ["cc", *flags, "-c", str(path), "-o", str(tmp_path / "object.o")]
        run = subprocess.run(command, cwd=tmp_path, text=True, capture_output=True, check=True)
        ignored[path.name] = set(re.findall(r"ignoring return value of .(\w+)", run.stderr)) - {
            "fail_with"
        }
    assert ignored.pop("careless.c") == {"take_ints"}
    assert not {name: found for name, found in ignored.items() if found}
