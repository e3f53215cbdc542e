"""Make the pages that MkDocs does not find in `docs`: the law, texts of other folders, the command line, Python.

The site takes each text from the folder that owns it, without links in the file system, which some checkouts lack. All
documents of the law are pages, so that none can be forgotten.

pip install -e '.[docs,denoise]' && mkdocs build --strict
"""

import re
from inspect import getdoc, isclass, isfunction
from pathlib import Path
from posixpath import dirname, normpath, relpath
from typing import Any

import bsm
from bsm.cli import COMMANDS, command_parser
from bsm.ground.exits import EXITS
from bsm.viewer.page import site_with

ROOT = Path(__file__).parents[1]
ELSEWHERE = {
    "api/javascript.md": "web/README.md",
    "changes.md": "CHANGELOG.md",
    "contributing.md": "CONTRIBUTING.md",
    "guides/blender.md": "plugins/blender/README.md",
    "guides/untrusted.md": "src/bsm/SERVICE.md",
    "paper.md": "codec/PAPER.md",
}
"""Pages whose texts other folders own."""
LINK = r"\]\(([\w./-]+\.\w+)(#[\w-]+)?\)"
MODULES = {
    "bsm.research": "One's own dictionary, prediction or partition in place of ours",
    "bsm.trimesh": "Streams in trimesh",
    "bsm.pyvista": "Streams in pyvista",
    "bsm.openmesh": "Meshes of OpenMesh",
    "bsm.vtk": "Streams in pipelines of VTK, and ParaView",
}
"""Modules that are public beside `bsm` itself."""


def on_config(config: Any) -> Any:
    """Put the pages of public names after those of Python that are written by hand, and the law where it belongs."""
    for section in config.nav:
        if "The format" in section:
            section["The format"] = [*law()]
        if "Reference" in section:
            section["Reference"].insert(
                1,
                {"Python": ["api/python.md", *({name: f"api/{name}.md"} for name in reference())]},
            )
    return config


def on_files(files: Any, config: Any) -> Any:
    """Add the pages that are made here."""
    from mkdocs.structure.files import File

    for page, source in (ELSEWHERE | law()).items():
        files.append(
            File.generated(config, page, content=(ROOT / source).read_text(encoding="utf-8"))
        )
    for page, data in live().items():
        files.append(File.generated(config, f"live/{page}", content=data))
    files.append(File.generated(config, "api/python.md", content=contents()))
    for name, page in reference().items():
        files.append(File.generated(config, f"api/{name}.md", content=page))
    files.append(File.generated(config, "cli.md", content=command_line()))
    return files


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Links lead to files of the repository; on the site, to the pages that are made of them."""
    place, pages = page.file.src_uri, {source: name for name, source in (ELSEWHERE | law()).items()}
    source = (ELSEWHERE | law()).get(place, f"docs/{place}")

    def moved(link: re.Match[str]) -> str:
        file = normpath(f"{dirname(source)}/{link[1]}")
        name = pages.get(file) or (file.removeprefix("docs/") if file.startswith("docs/") else None)
        return f"]({relpath(name, dirname(place) or '.')}{link[2] or ''})" if name else link[0]

    # a[i][j] in the specification is not a link.
    return re.sub(
        LINK, moved, markdown.replace("][", "]\\[") if place.startswith("format/") else markdown
    )


def live() -> dict[str, bytes]:
    """The decoder and the player of the first page, as the npm package has them, and the page that encodes."""
    built = {
        path.name: path.read_bytes()
        for path in (ROOT / "web/built").iterdir()
        if path.suffix in (".js", ".wasm")
    }
    return built | {
        f"view/{name}": data for name, data in site_with([]).items() if isinstance(data, bytes)
    }


def law() -> dict[str, str]:
    """The pages of the specification, and their documents: the overview, the core, extensions, and all else."""
    names = sorted((path.name for path in (ROOT / "spec").glob("*.md")), key=_place)
    return {f"format/{name}": f"spec/{name}" for name in names}


def _place(name: str) -> tuple[int, str]:
    kinds = ("README", "core-", "extension-")
    return next(
        (place for place, kind in enumerate(kinds) if name.startswith(kind)), len(kinds)
    ), name


def reference() -> dict[str, str]:
    """A page for each public function, type and module, by its name."""
    found = {f"bsm.{name}": getattr(bsm, name) for name in bsm.__all__}
    names = [name for name, value in found.items() if isclass(value) or isfunction(value)]
    return {
        name: f"::: {name}\n    options:\n      heading_level: 1\n" for name in (*names, *MODULES)
    }


def contents() -> str:
    """The page that says in a sentence what each of them is."""
    rows = []
    for name in reference():
        text = (
            MODULES.get(name)
            or (getdoc(getattr(bsm, name.partition(".")[2])) or "").partition("\n")[0]
        )
        rows.append(f"| [`{name}`]({name}.md) | {text.rstrip('.')} |")
    return "\n".join(["# Python", "", "| name | what it is |", "|---|---|", *rows, ""])


def command_line() -> str:
    """The page of all commands, as `--help` prints them."""
    parts = ["# Command line\n"]
    for name, summary in COMMANDS.items():
        parser = command_parser(name)
        parts.append(
            f"## bsm {name}\n\nTo {summary}.\n\n```text\n{parser.format_help().rstrip()}\n```\n"
        )
    return "\n".join(parts)


def exit_codes() -> str:
    """The table of exit codes."""
    rows = [f"| {row.code} | {row.meaning} |" for row in sorted(EXITS, key=lambda row: row.code)]
    return "\n".join(["| code | meaning |", "|---:|---|", *rows])
