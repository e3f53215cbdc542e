"""One file of C for the library: `python -m tools.amalgamate FOLDER` writes it there.

bsmdec.c and bsmdec.h are the decoder, bsm.c is the decoder and the encoder, whose interface is bsmenc.h. All headers
come first, then all sources; names that several files use for themselves get a suffix in each, and what is not the
library's interface is static.
"""

import argparse
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
FOLDERS = ("bitstream", "codec/basis", "codec/blocks", "codec/signal", "codec/sequence")
FILES = ("codec/geometry/graph.c",)
SHORT = "bitstream/fields/"  # its loops are short, and slower as vectors
CHOICES = ("bitstream/isa.c", "codec/isa.c")
INTERFACES, VECTORS = ("library/bsmdec.h", "library/bsmenc.h"), "codec/basis/vectors.h"
ONORM = "codec/basis/onorm.h"
LEVELS = {1: "", 3: "avx2,bmi,bmi2", 4: "avx2,bmi,bmi2,avx512f,avx512vl,avx512dq,avx512bw"}
_HEAD = """#pragma GCC diagnostic ignored "-Wunused-function"
#if !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"
#pragma GCC diagnostic ignored "-Wattributes"
#elif __has_warning("-Wpsabi")
#pragma clang diagnostic ignored "-Wpsabi"
#endif
"""
_MANY = """
/* GCC for Windows keeps vectors of 32 and 64 bytes in a stack that is aligned to 16. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(_MSC_VER) && !defined(__AVX512F__) \\
    && !defined(KERNEL_ONE_TARGET) && (!defined(_WIN32) || defined(__clang__))
#define KERNEL_ISAS 3
#else
#define KERNEL_ISAS 1
#endif
"""
_BEGIN = """#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("{0}"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("{0}")
#endif
"""
_END = """#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
"""
_SCALAR = """
#if !defined(__clang__)
#pragma GCC push_options
#pragma GCC optimize("no-tree-vectorize", "no-tree-slp-vectorize")
#endif
{0}
#if !defined(__clang__)
#pragma GCC pop_options
#endif
"""
_OWN = re.compile(r'^#include "([^"]+)"\n', re.MULTILINE)
_WORDS = r"(?!typedef|static|extern|return|INLINE|SHARED|KERNEL|OFTEN|struct|enum|union)(?:const )?"
_PROTOTYPE = re.compile(
    rf"^(?={_WORDS}\w+ \**(?!bsmdec_|bsmenc_)[^=;{{]*\([^;{{]*\);)", re.MULTILINE
)
_FUNCTION = re.compile(
    r"^(?:KERNEL |OFTEN )*(?:static |INLINE |SHARED )+(?:OFTEN )?(?:const )?\w+ \**(?:ISA\()?(\w+)\)?\(",
    re.MULTILINE,
)
_BARE = re.compile(
    rf"^(?=(?:KERNEL |OFTEN )*{_WORDS}\w+ \**(?!bsmdec_|bsmenc_)(?:ISA\()?\w+\)?\([^;{{]*\) \{{)",
    re.MULTILINE,
)
_DOUBLES = '#define VECTORS_OF_DOUBLES\n#include "codec/basis/vectors.h"\n'
_TYPE = re.compile(r"^(?:typedef .*?|\} )(\w+);$", re.MULTILINE)
_CONSTANTS = re.compile(r"enum \{(.*?)\}", re.DOTALL)
_VARIABLES = re.compile(
    r"^static const [^=;({]*?(\w+)(?:\[[^=;]*)? = (.*?);$", re.MULTILINE | re.DOTALL
)
_MACRO = re.compile(r"^\s*#\s*define (\w+)", re.MULTILINE)


def sources(*, encodes: bool = False) -> list[str]:
    """The files of the decoder or of the whole library, kernels first, by their paths in the repository."""
    kernels = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.c"))]
    library = (
        sorted((ROOT / "library").glob("*.c"))
        + sorted((ROOT / "library/encode").glob("*.c")) * encodes
    )
    paths = (
        str(path.relative_to(ROOT))
        for path in [*kernels, *(ROOT / name for name in FILES), *library]
    )
    return [path for path in paths if path not in CHOICES]


def learnt(name: str) -> str:
    """Learnt numbers of the specification as C."""
    numbers = ",".join(map(str, (ROOT / f"spec/{name.lower()}.bin").read_bytes()))
    return f"const unsigned char {name}[{name}_BYTES] = {{{numbers}}};\n"


def _read(path: str) -> str:
    """A file, with the vectors of doubles and the Onorm that it has: others have vectors of floats."""
    vectors = (ROOT / VECTORS).read_text()
    text = (ROOT / path).read_text().replace(f'#include "{ONORM}"\n', (ROOT / ONORM).read_text())
    return text.replace(_DOUBLES, f"#define VECTORS_OF_DOUBLES\n{vectors}").replace(
        "#pragma once\n", ""
    )


def _bare(text: str) -> str:
    """Without comments."""
    return re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)


def _headers(path: str, seen: dict[str, str]) -> None:
    """Note the headers that a file asks for, each behind those that it asks for itself."""
    for name in _OWN.findall(_read(path)):
        if name not in seen and name not in INTERFACES:
            seen[name] = ""
            _headers(name, seen)
            del seen[name]
            seen[name] = _OWN.sub("", _read(name))


def _names(text: str) -> set[str]:
    """Names of file scope that a text defines."""
    bare = _bare(text)
    constants = [
        item
        for body in _CONSTANTS.findall(bare)
        for item in re.findall(r"(\w+)\s*(?:=[^,]*)?(?:,|$)", body.strip())
    ]
    variables = [
        name
        for name, rest in _VARIABLES.findall(bare)
        for name in [name, *re.findall(r", (\w+)(?:\[[^=]*)? =", rest)]
    ]
    return {
        *_FUNCTION.findall(bare),
        *_TYPE.findall(bare),
        *_MACRO.findall(bare),
        *constants,
        *variables,
    }


def _renamed(text: str, names: Iterable[str], suffix: str) -> str:
    """A source whose own names have a suffix; members of structures keep theirs."""
    words = "|".join(sorted(names))
    return re.sub(rf"(?<![\w.])(?<!->)({words})\b", rf"\1_{suffix}", text) if words else text


def _private(text: str) -> str:
    """A header or a source with private names."""
    text = re.sub(r"^(extern )?INSIDE ", "static ", text, flags=re.MULTILINE).replace(
        "extern const", "static const"
    )
    return _BARE.sub(
        "static ",
        _PROTOTYPE.sub(
            "static ", re.sub(r"^const (?=.*\[)", "static const ", text, flags=re.MULTILINE)
        ),
    )


def _apart(texts: dict[str, str], seen_by: dict[str, dict[str, str]]) -> None:
    """Give types that several headers name alike other names, in all but the first of these and where they are seen."""
    first: dict[str, str] = {}
    for header in [path for path in texts if path.endswith(".h")]:
        for name in sorted(_TYPE.findall(_bare(texts[header]))):
            if first.setdefault(name, header) != header:
                for path in [
                    header,
                    *(path for path, headers in seen_by.items() if header in headers),
                ]:
                    texts[path] = re.sub(rf"\b{name}\b", f"{name}_{Path(header).stem}", texts[path])


def amalgamated(*, encodes: bool = False) -> str:
    """The source of the decoder, which includes bsmdec.h, or of the whole library, which includes bsmenc.h."""
    files, seen_by = sources(encodes=encodes), dict[str, dict[str, str]]()
    headers: dict[str, str] = {}
    for path in files:
        _headers(path, headers)
        _headers(path, seen_by.setdefault(path, {}))
    texts = headers | {path: _OWN.sub("", _read(path)) for path in files}
    _apart(texts, seen_by)
    headers = {path: texts[path] for path in headers}
    own = {path: _names(texts[path]) for path in files}
    shared = {name for text in headers.values() for name in re.findall(r"\w+", _bare(text))}
    count = Counter(name for names in own.values() for name in names)
    head = '#define BSMDEC_WRITES\n#include "bsmenc.h"\n' if encodes else '#include "bsmdec.h"\n'
    pieces, per_isa = [head, _HEAD, *map(_private, headers.values())], [_private(headers[VECTORS])]
    for path in files:
        suffix = re.sub(r"\W", "_", path[:-2])
        clashing = [name for name in own[path] if count[name] > 1 or name in shared]
        text = f"\n/* {path} */\n{_private(_renamed(texts[path], clashing, suffix))}"
        text = _SCALAR.format(text) if path.startswith(SHORT) else text
        (per_isa if path.endswith(".simd.c") else pieces).append(text)
    choices = [_OWN.sub("", _read(path)) for path in CHOICES]
    return "".join(
        [
            *pieces,
            *_each_isa("".join(per_isa)),
            *choices,
            _private(learnt("PRIORS") + learnt("START")),
        ]
    )


def _each_isa(text: str) -> Iterator[str]:
    """Files *.simd.c for each level of x86-64, with names of their own; for other processors the first of them."""
    names = _names(text)
    yield _MANY
    for level, target in LEVELS.items():
        yield f"\n#define KERNEL_ISA {level}\n{_BEGIN.format(target) if target else ''}"
        yield f"{_renamed(text, names, f'v{level}')}\n{_END if target else ''}#undef KERNEL_ISA\n"
        yield "" if target else "#if KERNEL_ISAS > 1\n"
    yield "#endif\n"


def interface(*, encodes: bool = False) -> str:
    """The header of the decoder, or of the encoder."""
    return _read(INTERFACES[encodes])


def main() -> None:
    """Write all files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", metavar="FOLDER", type=Path)
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "bsmdec.c").write_text(amalgamated())
    (folder / "bsmdec.h").write_text(interface())
    (folder / "bsm.c").write_text(amalgamated(encodes=True))
    (folder / "bsmenc.h").write_text(interface(encodes=True))


if __name__ == "__main__":
    main()
