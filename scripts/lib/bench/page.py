"""Pages and kept numbers.

A template of the folder `pages` is Markdown with

- fields in braces, those of str.format. None is "-", or empty if the field has no format. The format p is a
  percentage; others may begin with a factor: k and M divide by a thousand and a million;
- rows of a table: `*NAME* | {cell} | {cell} |`, below the titles, repeats for each of the rows NAME;
- sections: the lines from `*each NAME*` to `*end NAME*` repeat for each of NAME.
"""

from __future__ import annotations

import csv
import re
import string
from collections.abc import Mapping
from pathlib import Path

from velour.core import files

from .project import RESULTS, sentence

_TEMPLATES = Path(__file__).with_name("pages")
_SCALES = {"k": 1e-3, "M": 1e-6}
_SECTION = re.compile(r"^\*each (\w+)\*\n(.*?)^\*end \1\*\n", re.MULTILINE | re.DOTALL)
_ROWS = re.compile(r"^\*(\w+)\* (\|.*\|\n)", re.MULTILINE)


class _Fields(string.Formatter):
    def format_field(self, value, spec):
        if value is None:
            return "-" if spec else ""
        if spec == "p":
            return f"{100 * value:.2f} %"
        if spec[:1] in _SCALES:
            value, spec = value * _SCALES[spec[0]], spec[1:]
        return super().format_field(value, spec)


def fields(template: str, values: Mapping) -> str:
    return _Fields().vformat(template, (), values)


def filled(template: str, values: Mapping) -> str:
    before, *rest = _SECTION.split(template)
    text = _tables(before, values)
    for name, section, after in zip(rest[::3], rest[1::3], rest[2::3], strict=True):
        text += "".join(filled(section, {**values, **each}) for each in values[name]) + _tables(after, values)
    return text


def _tables(template: str, values: Mapping) -> str:
    before, *rest = _ROWS.split(template)
    text = fields(before, values)
    for name, cells, after in zip(rest[::3], rest[1::3], rest[2::3], strict=True):
        titles = text.splitlines()[-1]
        text += "|" + "---|" * (titles.count("|") - 1) + "\n"
        text += "".join(fields(cells, row) for row in values[name]) + fields(after, values)
    return text


def text(template: str, values: Mapping) -> str:
    """A template of the folder `pages`, filled. `values`: among them the conditions, which the field
    `conditions` states."""
    source = (_TEMPLATES / f"{template}.md").read_text(encoding="utf-8")
    return filled(source, {"conditions": sentence(values), **values} if "commit" in values else values)


def replaced(page: str, part: str, text: str) -> str:
    """`page` with `text` between the markers of `part`. Raises ValueError if they are missing."""
    pattern = re.compile(f"(?<=<!-- {part}: )(.*?-->\n).*?(?=<!-- end of {part} -->)", re.DOTALL)
    if len(pattern.findall(page)) != 1:
        raise ValueError(f"the page has no part {part!r} between its two markers")
    return pattern.sub(lambda found: found[1] + text, page)


def write(output: Path, name: str, page: str) -> None:
    """Writes a page of docs/results, or the part "measured" of a hand-written one; prints its path."""
    known = (RESULTS / name).read_text(encoding="utf-8") if (RESULTS / name).is_file() else ""
    if "<!-- measured: " in known:
        page = replaced(known, "measured", page)
    (output / name).parent.mkdir(parents=True, exist_ok=True)
    files.write_text(output / name, page)
    print(output / name)


def verdict(met: bool | None) -> str:
    return {True: "met", False: "missed", None: "not measured"}[met]


def judged(target: str, where: str, measured: str, met: bool | None) -> dict:
    """A row of a table of targets."""
    return {"target": target, "where": where, "measured": measured, "met": met, "word": verdict(met)}


def missed(targets: list[dict]) -> list[dict]:
    """A row per target that is not met, with each place and number."""
    found: dict[str, list[str]] = {}
    for each in targets:
        if not each["met"]:
            found.setdefault(each["target"], []).append(f"{each['where']}: {each['measured']}")
    return [{"target": target, "measured": "; ".join(cells)} for target, cells in found.items()]


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
