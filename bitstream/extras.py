"""What to type for a library that is missing."""

import json
from pathlib import Path

DISTRIBUTION = "bsm-codec"


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
        return f"pip install {editable}'{_path(url)}[{extra}]'"
    return f"pip install '{DISTRIBUTION}[{extra}] @ {url}'"


def _path(url: str) -> str:
    """The folder behind a file's URL."""
    from urllib.parse import urlsplit
    from urllib.request import url2pathname

    return url2pathname(urlsplit(url).path)
