"""A page of reference | new | difference x 10: index.html, its pictures, and report.json in one folder."""

from __future__ import annotations

import html
import itertools
import math
from pathlib import Path

import numpy as np
from velour.core import files
from velour.native import VelourError, images

from .case import Outcome
from .views import GAIN, MAGNIFICATION, MARGIN, crop, views

_TITLES = {"reference": "reference", "new": "new", "difference": f"difference x {GAIN}"}
_COLUMNS = ("scene", "verdict", "causes")
_NUMBERS = (
    "largest block difference, %",
    "in standard errors",
    "limit",
    "sees exposure, %",
)
_STYLE = """body { font: 15px/1.4 sans-serif; margin: 2em; background: #222; color: #ddd }
table { border-collapse: collapse }
td, th { padding: .2em .8em; text-align: left; border-bottom: 1px solid #444 }
td.number, th.number { text-align: right }
td, p { max-width: 50em }
.failed { color: #ff8a80 } .ok { color: #a5d6a7 } a { color: #90caf9 }
figure { display: inline-block; width: clamp(240px, 30vw, 640px); margin: 0 1em .5em 0; vertical-align: top }
figcaption { color: #aaa; font-size: 13px }
img { image-rendering: pixelated; max-width: 100%; background: #000 }
.whole img { width: 100% }"""


class Page:
    """Takes outcomes one by one; `finish` writes the rest."""

    def __init__(self, folder: Path, title: str, names: dict[str, str] | None = None):
        """`names`: of "reference" and "new" on this page."""
        self._folder, self._title, self._names = folder, title, _TITLES | (names or {})
        self._rows: list[str] = []
        self._sections: list[str] = []
        self._records: list[dict] = []
        self._failed = 0
        self._numbers = itertools.count(1)  # of pictures
        (folder / "pictures").mkdir(parents=True, exist_ok=True)

    def draw(self, outcome: Outcome) -> None:
        """Writes the pictures of an outcome, which lets go of them. Threads may call it, before add()."""
        if outcome.ours is None:
            return
        try:
            outcome.figures = self._pictures(outcome, f"{next(self._numbers):03d}")
        except (VelourError, OSError) as error:
            outcome.notes.append(f"Its pictures are not shown: {error}")
        outcome.ours = outcome.reference = None

    def add(self, outcome: Outcome) -> None:
        self.draw(outcome)
        number = len(self._rows) + 1
        self._failed += not outcome.passed
        self._rows.append(_row(outcome, number))
        self._sections.append(self._section(outcome, number))
        self._records.append(_record(outcome))

    def finish(self) -> Path:
        """The path of index.html."""
        title = html.escape(self._title)
        head = f"{len(self._rows) - self._failed} as expected, {self._failed} not"
        names = [_tag("th", name) for name in _COLUMNS] + [_number("th", name) for name in _NUMBERS]
        table = _tag("table", _tag("tr", *names), *self._rows)
        body = _tag("body", _tag("h1", title), _tag("p", head), table, *self._sections)
        meta = f'<meta charset="utf-8">{_tag("title", title)}{_tag("style", _STYLE)}'
        files.write_text(
            self._folder / "index.html", f'<!doctype html>\n<html lang="en">{meta}{body}</html>\n'
        )
        files.write_json(self._folder / "report.json", {"failed": self._failed, "outcomes": self._records})
        return self._folder / "index.html"

    def _section(self, outcome: Outcome, number: int) -> str:
        parts = [f'<h2 id="{number}">{html.escape(outcome.name)} {_word(outcome)}</h2>']
        tested = [f"Tested: {outcome.quantity}"] if outcome.quantity else []
        parts += [_tag("p", html.escape(text)) for text in (*tested, outcome.sentence, *outcome.notes)]
        return "\n".join([*parts, *outcome.figures])

    def _pictures(self, outcome: Outcome, stem: str) -> list[str]:
        made, caption = views(outcome)
        parts = [f'<div class="whole">{self._figures(made, stem)}</div>']
        if outcome.comparison and not outcome.comparison.agrees and outcome.comparison.block:
            block = outcome.comparison.block
            parts.append(
                _tag("p", f"The worst block and {MARGIN} pixels around it, {MAGNIFICATION} times as large:")
            )
            parts.append(
                self._figures({name: crop(view, block) for name, view in made.items()}, f"{stem}-crop")
            )
        return [*parts, _tag("p", _tag("small", caption))]

    def _figures(self, made: dict[str, np.ndarray], stem: str) -> str:
        text = ""
        for name, view in made.items():
            path = f"pictures/{stem}-{name}.png"
            images.write(self._folder / path, np.ascontiguousarray(view, np.float32))
            text += _tag("figure", f'<img src="{path}" alt="{name}">', _tag("figcaption", self._names[name]))
        return text


def _tag(name: str, *inside: str) -> str:
    return f"<{name}>{''.join(inside)}</{name}>"


def _number(name: str, text: str) -> str:
    return f'<{name} class="number">{text}</{name}>'


def _word(outcome: Outcome) -> str:
    return f'<span class="{"ok" if outcome.passed else "failed"}">{outcome.word.lower()}</span>'


def _row(outcome: Outcome, number: int) -> str:
    cells = [_tag("td", f'<a href="#{number}">{html.escape(outcome.name)}</a>'), _tag("td", _word(outcome))]
    found = outcome.comparison
    cells.append(_tag("td", "<br>".join(html.escape(str(cause)) for cause in outcome.causes)))
    if found:
        texts = (f"{found.percent:.2f}", f"{found.z:.1f}", f"{found.limit:.1f}", f"{found.sees:.2f}")
        cells += [_number("td", text) for text in texts]
    else:
        cells.append(f'<td colspan="{len(_NUMBERS)}">{html.escape(outcome.sentence)}</td>')
    return _tag("tr", *cells)


def _record(outcome: Outcome) -> dict:
    numbers = outcome.comparison._asdict() if outcome.comparison else {}
    if numbers and math.isinf(numbers["sees"]):
        numbers["sees"] = None
    causes = [cause._asdict() for cause in outcome.causes]
    record = {"name": outcome.name, "passed": outcome.passed, "sentence": outcome.sentence}
    return {**record, "seconds": round(outcome.seconds, 2), "causes": causes, **numbers}
