"""Pages, tables and kept numbers.

Whole pages are written from templates in the folder `pages`: Markdown with fields in braces. Other pages are
written by hand, apart from parts between markers.
"""

from __future__ import annotations

import csv
import string
from collections.abc import Iterable, Mapping
from pathlib import Path

from velour.core import files

from . import provenance
from .velour_cli import ROOT

RESULTS = ROOT / "docs/results"
_TEMPLATES = Path(__file__).with_name("pages")
_SCALES = {"k": 1e-3, "M": 1e-6, "m": 1e3}


def table(rows: Iterable, header: str, cells: str) -> str:
    """A Markdown table. `header`: the titles, between bars; `cells`: the template of a row, likewise.

    Fields of the template are those of str.format, for the entries of a row. None is "-", or empty if the
    field has no format. The format p is a percentage; others may begin with a factor: k and M divide by a
    thousand and a million, m multiplies by a thousand.
    """
    lines = [f"| {line} |\n" for line in (header, *(filled(cells, row) for row in rows))]
    return "".join([lines[0], "|" + "---|" * len(header.split("|")) + "\n", *lines[1:]])


class _Cells(string.Formatter):
    def format_field(self, value, spec):
        if value is None:
            return "-" if spec else ""
        if spec == "p":
            return f"{100 * value:.2f} %"
        if spec[:1] in _SCALES:
            value, spec = value * _SCALES[spec[0]], spec[1:]
        return super().format_field(value, spec)


_CELLS = _Cells()


def filled(template: str, values: Mapping) -> str:
    return _CELLS.vformat(template, (), values)


def replaced(page: str, part: str, text: str, script: str = "models") -> str:
    """`page` with `text` between the markers of `part` of `script`. Raises ValueError if they are missing."""
    begin, end = f"<!-- {part}: written by scripts/{script} -->\n", f"<!-- end of {part} -->"
    if page.count(begin) != 1 or page.count(end) != 1 or page.index(begin) > page.index(end):
        raise ValueError(f"the page has no part {part!r} between its two markers")
    return page[: page.index(begin) + len(begin)] + text + page[page.index(end) :]


def text(template: str, values: Mapping) -> str:
    """A template of the folder `pages`, filled. `values`: its fields, among them the conditions, which the
    field `conditions` states."""
    source = (_TEMPLATES / f"{template}.md").read_text(encoding="utf-8")
    sentence = {"conditions": provenance.sentence(values)} if "commit" in values else {}
    return filled(source, {**sentence, **values})


def write(output: Path, name: str, page: str) -> None:
    """Writes a page of docs/results, and prints its path."""
    (output / name).parent.mkdir(parents=True, exist_ok=True)
    files.write_text(output / name, page)
    print(output / name)


def write_parts(output: Path, name: str, script: str, **parts: str) -> None:
    """Writes the page docs/results/NAME with new parts to OUTPUT/NAME, and prints its path."""
    page = (RESULTS / name).read_text(encoding="utf-8")
    for part, found in parts.items():
        page = replaced(page, part, found, script)
    write(output, name, page)


def verdict(met: bool | None) -> str:
    return {True: "met", False: "missed", None: "not measured"}[met]


def write_rows(path: Path, rows: list[dict], conditions: Mapping) -> None:
    """Writes a CSV: the conditions, as name and value in the first two columns, then the rows."""
    path.parent.mkdir(parents=True, exist_ok=True)
    names = list(dict.fromkeys(name for row in rows for name in row))
    lines = [[name, value, *[""] * (len(names) - 2)] for name, value in conditions.items()]
    lines += [[row.get(name, "") for name in names] for row in rows]

    def save(temporary: Path) -> None:
        with temporary.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows([names, *lines])

    files.write_atomic(path, save)


def read_rows(path: Path) -> tuple[dict, list[dict]]:
    """The conditions, as text, and the rows of a CSV that write_rows() wrote."""
    with path.open(newline="", encoding="utf-8") as file:
        names, *lines = csv.reader(file)
    conditions = {line[0]: line[1] for line in lines if not any(line[2:])}
    return conditions, [dict(zip(names, map(_parsed, line), strict=True)) for line in lines if any(line[2:])]


def _parsed(text: str) -> object:
    if text in ("", "True", "False"):
        return {"": None, "True": True, "False": False}[text]
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
