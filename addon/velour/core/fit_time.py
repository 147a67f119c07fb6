"""How long the fit of a BTF will take: by those that were made on this machine.

A smaller fit, made to find out, would mislead: it looks at fewer places, and tries other shapes. What fits of
all sizes took is known, and grows with texels and with pairs to powers that were measured (docs/blender.md).
"""

from __future__ import annotations

import contextlib
import json
import math
import os
import secrets
import time
from pathlib import Path
from typing import NamedTuple

from ..native.version import VERSION
from . import files
from .capture_size import duration

_FOLDER = "fits-2"  # another form has another name
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
    """Adds one that was made, from its beginning to its end. Does without where nothing can be written.

    Each is a file of its own, which is never changed: others that end at the same time, on other machines as
    well, lose nothing by it, and nobody waits.
    """
    kept = folder / _FOLDER
    entry = {"release": list(VERSION), "fit": list(fit), "seconds": seconds}
    with contextlib.suppress(OSError):
        kept.mkdir(parents=True, exist_ok=True)
        # By time, to which a random number is added: clocks may agree.
        files.write_json(kept / f"{time.time_ns():020}-{secrets.token_hex(4)}.json", entry)
        for old in _entries(kept)[:-_KEPT]:
            old.unlink(missing_ok=True)


def _entries(kept: Path) -> list[Path]:
    """The oldest first, without what is being written."""
    return sorted(path for path in kept.glob("*.json") if not path.name.startswith("."))


def _known(folder: Path) -> list[_Made]:
    """Those of this release, the oldest first, without damaged ones."""
    try:
        read = [_made(path) for path in _entries(folder / _FOLDER)]
    except OSError:
        return []
    return [made for made in read if made is not None]


def _made(path: Path) -> _Made | None:
    try:
        entry = json.loads(path.read_text(encoding="utf-8"))
        made = _Made(Fit(*entry["fit"]), float(entry["seconds"]))
        usable = (
            entry["release"] == list(VERSION) and made.seconds > 0 and made.fit.texels * made.fit.pairs > 0
        )
    except (OSError, ValueError, TypeError, KeyError):  # another has just taken it away, or it is damaged
        return None
    return made if usable else None


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
