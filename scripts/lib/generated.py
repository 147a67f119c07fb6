"""Generated parts of hand-written pages, between two markers, which stay."""

from __future__ import annotations


def replaced(page: str, part: str, text: str, script: str = "models") -> str:
    """`page` with `text` between the markers of `part` of `script`. Raises ValueError if they are missing."""
    begin, end = f"<!-- {part}: written by scripts/{script} -->\n", f"<!-- end of {part} -->"
    if page.count(begin) != 1 or page.count(end) != 1 or page.index(begin) > page.index(end):
        raise ValueError(f"the page has no part {part!r} between its two markers")
    return page[: page.index(begin) + len(begin)] + text + page[page.index(end) :]
