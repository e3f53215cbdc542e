"""Words of other programs for commands and options, and what bsm calls them."""

from collections.abc import Collection
from pathlib import Path

_TABLES = Path(__file__).with_suffix(".txt").read_text("utf-8").split("\n\n")


def _read_table(text: str) -> dict[str, str]:
    """Return the advice of a table for each word in front of it."""
    advice = {}
    for line in text.splitlines():
        words, told = line.split(": ", 1)
        advice.update(dict.fromkeys(words.split(), told))
    return advice


COMMANDS, OPTIONS = map(_read_table, _TABLES)
"""What to type in place of a command, and of an option. Advice on an option is a list with bars between its entries."""


def advice_on_option(word: str, options: Collection[str]) -> str:
    """Return the option to use in place of an unknown one, among those of a command; empty if there is none."""
    for entry in OPTIONS.get(word, "").split(" | "):
        name = entry.partition(" ")[0]
        if name in options or not name.startswith("-"):
            return entry
    return ""


def advice_on_keyword(word: str, keywords: Collection[str]) -> str:
    """Return the keyword of a function to use in place of an unknown one, with a value; empty if there is none."""
    for entry in OPTIONS.get(f"--{word.replace('_', '-')}", "").split(" | "):
        option, value, *_ = [*entry.split(" "), ""]
        keyword = option.removeprefix("--").replace("-", "_")
        if keyword not in keywords:
            continue
        if not value:
            return f"{keyword}=True"
        is_number = value.removeprefix("-").replace(".", "").isdigit()
        if not is_number:
            value = repr(value)
        return f"{keyword}={value}"
    return ""
