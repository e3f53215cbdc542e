"""The viewer as a widget of notebooks (anywidget)."""

from typing import Any

import anywidget
import traitlets

from bsm.viewer.page import Content, built


class StreamWidget(anywidget.AnyWidget):
    """Shows one stream, as `bsm view` does."""

    _esm = built("viewer.js")
    name = traitlets.Unicode().tag(sync=True)
    stream = traitlets.Bytes().tag(sync=True)
    original = traitlets.Bytes().tag(sync=True)
    height = traitlets.Int().tag(sync=True)

    def __init__(self, content: Content, height: int, **keywords: Any) -> None:
        original = b"" if content.original is None else content.original.astype("<f4").tobytes()
        super().__init__(name=content.name, stream=content.stream, original=original, height=height, **keywords)
