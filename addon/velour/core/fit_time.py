"""Estimates the time of a BTF fit from fits that were made on this machine.

A small trial fit would mislead: it looks at fewer places and tries other shapes. Recorded times are scaled
with texels and pairs to powers that were measured.
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

_FOLDER = "fits-2"  # changes with the format
_KEPT = 64
_NEAREST = 3
_POWERS = {"srbf": (0.65, 0.85), "kcta": (1.1, 0.75)}  # powers of texels and of pairs in the time
_USUAL_POWERS = 0.9, 0.8
_MISS, _USUAL_MISS = {"srbf": 1.5}, 2.0  # factor by which an estimate may be off
_FAR = 16.0  # if the nearest fit is this many times larger or smaller, the miss is squared
# Processor seconds for a weave of this many texels and pairs, used until there are fits.
_WEAVE_SIZE = 32 * 32, 81 * 81
_WEAVE = {"srbf": 21.0, "kcta": 58.0}


class Fit(NamedTuple):
    """The parameters that the time of a fit depends on."""

    method: str
    texels: int
    pairs: int
    searched: bool  # a largest error was requested, which takes several fits
    sized: bool  # a size was requested
    shaped: bool  # the clusters of tensors were given; otherwise many are tried
    threads: int


def fit_of(info: dict, asked: dict, threads: int) -> Fit:
    """`info`: the BTF's info; `asked`: options of compress_job()."""
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
    """Records a fit that was made from beginning to end. Does nothing if the folder is not writable.

    Each fit is a file of its own that never changes, so that fits that end at the same time, also on other
    machines, neither overwrite each other nor wait.
    """
    kept = folder / _FOLDER
    entry = {"release": list(VERSION), "fit": list(fit), "seconds": seconds}
    with contextlib.suppress(OSError):
        kept.mkdir(parents=True, exist_ok=True)
        # Named by the time and a random number, as clocks may agree.
        files.write_json(kept / f"{time.time_ns():020}-{secrets.token_hex(4)}.json", entry)
        for old in _entries(kept)[:-_KEPT]:
            old.unlink(missing_ok=True)


def _entries(kept: Path) -> list[Path]:
    """The oldest first, without files that are being written."""
    return sorted(path for path in kept.glob("*.json") if not path.name.startswith("."))


def _known(folder: Path) -> list[_Made]:
    """Fits made with this release, the oldest first, without damaged entries."""
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
    except (OSError, ValueError, TypeError, KeyError):  # just removed by another process, or damaged
        return None
    return made if usable else None


class Range(NamedTuple):
    """Range of times, in seconds."""

    least: float
    most: float
    made: int  # number of fits it is based on


def expected(folder: Path, fit: Fit) -> Range | None:
    """Estimate from the fits of the same kind that are nearest in size; None: there are none."""
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
    """Text for the artist."""
    found = expected(folder, fit)
    if found is not None:
        fits = "one fit" if found.made == 1 else f"{found.made} fits"
        return f"{_range_text(found)}, estimated from {fits} on this computer"
    known = _WEAVE.get(fit.method)
    if known is None or fit.searched or fit.sized or fit.shaped:
        return "time unknown, as no similar fit was made on this computer yet"
    seconds = duration(_scaled(known, fit, *_WEAVE_SIZE))
    return (
        "time unknown, as no similar fit was made on this computer yet; on another computer a weave of this"
        f" size took about {seconds} of processor time"
    )


def _range_text(found: Range) -> str:
    least, most = duration(found.least), duration(found.most)
    return f"about {most}" if least == most else f"{least} to {most}"
