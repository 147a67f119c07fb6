"""How long the fit of a BTF will take: by those that were made on this machine.

A smaller fit, made to find out, would mislead: it looks at fewer places, and tries other shapes. What fits of
all sizes took is known, and grows with texels and with pairs to powers that were measured (docs/blender.md).
"""

from __future__ import annotations

import contextlib
import json
import math
import os
from pathlib import Path
from typing import NamedTuple

from ..native.version import VERSION
from . import files
from .capture_size import duration

_FILE = "fits-1.json"  # another form has another name
_KEPT = 64
_NEAREST = 3
_POWERS = {"srbf": (0.65, 0.85), "kcta": (1.1, 0.75)}  # of texels, of pairs, that the seconds grow with
_USUAL_POWERS = 0.9, 0.8
_MISS, _USUAL_MISS = {"srbf": 1.5}, 2.0  # times too long or too short
_FAR = 16.0  # times as large or small, what comes nearest: the miss is squared
# Processor seconds of a weave of so many texels under so many pairs, for who has made none.
_WEAVE_SIZE = 32 * 32, 81 * 81
_WEAVE = {"srbf": 21.0, "kcta": 58.0}


class Fit(NamedTuple):
    """What its time follows from."""

    method: str
    texels: int
    pairs: int
    searched: bool  # for a largest error: several fits
    sized: bool  # whether a size was asked for
    shaped: bool  # whether clusters are, of tensors; else many are tried
    threads: int


def fit_of(info: dict, asked: dict, threads: int) -> Fit:
    """`info`: of the BTF; `asked`: options of compress_job()."""
    return Fit(
        asked["method"],
        math.prod(info["texels"]),
        info["pairs"],
        asked["tolerance"] > 0,
        asked["bytes"] > 0,
        any(asked.get(name) for name in ("clusters", "members")),
        threads or os.cpu_count() or 1,
    )


class _Made(NamedTuple):
    fit: Fit
    seconds: float


def remember(folder: Path, fit: Fit, seconds: float) -> None:
    """Adds one that was made, from its beginning to its end. Does without where nothing can be written."""
    made = [*_known(folder), _Made(fit, seconds)][-_KEPT:]
    text = json.dumps({"release": list(VERSION), "fits": [[*m.fit, m.seconds] for m in made]})
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        files.write_text(folder / _FILE, text)


def _known(folder: Path) -> list[_Made]:
    """Those of this release, the oldest first; none where the file is damaged."""
    try:
        kept = json.loads((folder / _FILE).read_text(encoding="utf-8"))
        if kept["release"] != list(VERSION):
            return []
        made = [_Made(Fit(*numbers[:-1]), float(numbers[-1])) for numbers in kept["fits"]]
        return [m for m in made if m.seconds > 0 and m.fit.texels * m.fit.pairs > 0]
    except (OSError, ValueError, TypeError, KeyError, IndexError):
        return []


class Range(NamedTuple):
    """Seconds."""

    least: float
    most: float
    made: int  # fits that it is from


def expected(folder: Path, fit: Fit) -> Range | None:
    """By the fits of this kind that come nearest in size; None: there are none."""
    alike = [
        m for m in _known(folder) if m.fit._replace(texels=0, pairs=0) == fit._replace(texels=0, pairs=0)
    ]
    if not alike:
        return None
    alike.sort(key=lambda m: _distance(m.fit, fit))
    told = [_scaled(m.seconds, fit, m.fit.texels, m.fit.pairs) for m in alike[:_NEAREST]]
    miss = _MISS.get(fit.method, _USUAL_MISS)
    if _distance(alike[0].fit, fit) > math.log(_FAR):
        miss **= 2
    return Range(min(told) / miss, max(told) * miss, len(told))


def _distance(one: Fit, other: Fit) -> float:
    return abs(math.log(one.texels / other.texels)) + abs(math.log(one.pairs / other.pairs))


def _scaled(seconds: float, fit: Fit, texels: int, pairs: int) -> float:
    of_texels, of_pairs = _POWERS.get(fit.method, _USUAL_POWERS)
    return seconds * (fit.texels / texels) ** of_texels * (fit.pairs / pairs) ** of_pairs


def time_text(folder: Path, fit: Fit) -> str:
    """What artists are told."""
    found = expected(folder, fit)
    if found is not None:
        fits = "one fit" if found.made == 1 else f"{found.made} fits"
        return f"{_range_text(found)}, by {fits} made here"
    known = _WEAVE.get(fit.method)
    if known is None or fit.searched or fit.sized or fit.shaped:
        return "no such fit was made here yet, so nothing tells how long it will take"
    seconds = duration(_scaled(known, fit, *_WEAVE_SIZE))
    return f"no such fit was made here yet; of a weave it took about {seconds} of one processor elsewhere"


def _range_text(found: Range) -> str:
    least, most = duration(found.least), duration(found.most)
    return f"about {most}" if least == most else f"{least} to {most}"
