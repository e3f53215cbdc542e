"""Libraries that may be missing, and what to type then."""

import importlib
import json
from pathlib import Path
from typing import Any

from bsm.bitstream.errors import DependencyError

DISTRIBUTION = "bsm-codec"


def imported(module: str, why: str, extra: str) -> Any:
    """A module that an extra installs; `DependencyError` says why it is needed, and how it is installed."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise DependencyError(f"{why}; run: {how_to_install(extra)}") from error


def how_to_install(extra: str) -> str:
    """The command that installs an extra of this package from where the package itself came."""
    from importlib import metadata

    try:
        origin = metadata.distribution(DISTRIBUTION).read_text("direct_url.json")
    except metadata.PackageNotFoundError:  # run from a checkout that is not installed
        checkout = Path(__file__).resolve().parents[1]
        return f"pip install '{checkout}[{extra}]'"
    if origin is None:
        return f"pip install '{DISTRIBUTION}[{extra}]'"
    source = json.loads(origin)
    url = source["url"]
    if "vcs_info" in source:
        url = f"{source['vcs_info']['vcs']}+{url}@{source['vcs_info']['commit_id']}"
    editable = "-e " if source.get("dir_info", {}).get("editable") else ""
    if url.startswith("file://") and "dir_info" in source:
        # The folder behind a file's URL.
        from urllib.parse import urlsplit
        from urllib.request import url2pathname

        return f"pip install {editable}'{url2pathname(urlsplit(url).path)}[{extra}]'"
    return f"pip install '{DISTRIBUTION}[{extra}] @ {url}'"
