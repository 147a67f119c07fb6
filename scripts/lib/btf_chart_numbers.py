"""The arithmetic of scripts/chart --btf: fits of a given size, comparisons of methods, and the targets."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

HEADERS = 2300  # approximate bytes of a model's file besides the fitted parameters
_CLOSE = 0.08  # share of the bytes that may stay unused before another fit is tried
_SLACK = 1.01
_TRIES = 4
_MARGIN = 0.99  # share of the target that is tried first


@dataclass(frozen=True)
class Method:
    """A method of compression: its name, and its command line options."""

    name: str
    options: tuple[tuple[str, object], ...]


@dataclass(frozen=True)
class Entry:
    """Results of a method at one size."""

    tile: str
    method: str
    ratio: int
    bytes: int  # size of the model's file
    seconds: float  # duration of the fit
    processor_seconds: float  # whole call, all threads
    psnr: float
    ser: float
    evaluations: float  # per second and thread
    psnr_unseen: float | None = None
    ser_unseen: float | None = None
    picture: float | None = None  # relative error of the rendered picture
    flip: float | None = None
    render_seconds: float | None = None  # processor seconds to the chart's noise level
    brightness: float | None = None  # mean radiance of the model over that of the BTF


def packing(report: dict) -> float:
    """Bytes of the file per fitted byte."""
    return max(report["bytes"] - HEADERS, 1) / report["parameter_bytes"]


def largest_within(target: int, reports: Iterable[dict]) -> dict | None:
    """The largest file within 1.01 `target`: the excess does not change errors, and often saves a fit."""
    return max((r for r in reports if r["bytes"] <= _SLACK * target), key=lambda r: r["bytes"], default=None)


def fills(target: int, report: dict | None, least: float = 1 - _CLOSE) -> bool:
    """Whether at least this share of the bytes is used; by default, a share that is not worth another fit."""
    return report is not None and report["bytes"] >= least * target


def within(target: int, fit: Callable[[int], dict | None], packed: float = 1.0) -> dict | None:
    """The report of the largest file within `target` bytes. `fit` takes the bytes of the fitted parameters
    and returns a report, or None if it refuses; files are larger by their headers and smaller by compression.
    `packed`: the expected packing()."""
    best, tried, size = None, [], max(int(_MARGIN * (target - HEADERS) / packed), 1)
    for _ in range(_TRIES):
        report = fit(size)
        if report is None:
            break
        best = largest_within(target, [report, best] if best else [report])
        tried.append((report["parameter_bytes"], report["bytes"]))
        following = _next(target, tried)
        if best is report and following < (1 + _CLOSE) * size:
            break
        size = following
    return best


def _next(target: int, tried: list[tuple[int, int]]) -> int:
    """Fitted bytes that would fill the file, by a line through the last two of (fitted bytes, file size)."""
    fitted, size = tried[-1]
    slope = 1.0
    if len(tried) > 1 and tried[-2][0] != fitted:
        slope = min(max((size - tried[-2][1]) / (fitted - tried[-2][0]), 0.5), 2.0)
    return max(int(fitted + (target - size) / slope), fitted // 3, 1)


def relative_error(picture: np.ndarray, reference: np.ndarray) -> float:
    """Root mean square of the difference, relative to that of the reference."""
    return float(np.sqrt(((picture - reference) ** 2).mean() / (reference**2).mean()))


def widest_spread(pictures: list[np.ndarray], side: int) -> tuple[int, int]:
    """Row and column of the side x side window in which the pictures differ most from one another, as
    displayed: the square root of each channel, clipped at 1."""
    shown = np.sqrt(np.clip(np.stack(pictures), 0, 1))
    spread = shown.var(axis=0).sum(axis=-1)
    sums = np.pad(spread.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    windows = sums[side:, side:] - sums[:-side, side:] - sums[side:, :-side] + sums[:-side, :-side]
    row, column = np.unravel_index(windows.argmax(), windows.shape)
    return int(row), int(column)


class Results:
    """All entries, found by tile, method and ratio."""

    def __init__(self, entries: list[Entry]):
        self._entries = {(e.tile, e.method, e.ratio): e for e in entries}

    def all(self) -> list[Entry]:
        return list(self._entries.values())

    def get(self, tile: str, method: str, ratio: int) -> Entry | None:
        return self._entries.get((tile, method, ratio))

    def tiles(self) -> list[str]:
        return list(dict.fromkeys(e.tile for e in self.all()))

    def methods(self) -> list[str]:
        return list(dict.fromkeys(e.method for e in self.all()))

    def ratios(self) -> list[int]:
        return sorted({e.ratio for e in self.all()})

    def best(self, tile: str, ratio: int, value: str = "psnr") -> str | None:
        """The method with the largest `value`."""
        known = [
            e for e in self.all() if e.tile == tile and e.ratio == ratio and getattr(e, value) is not None
        ]
        return max(known, key=lambda e: getattr(e, value)).method if known else None

    def gain(self, tile: str, ratio: int, method: str, other: str, value: str = "psnr") -> float | None:
        """`value` of `method` minus that of `other`, at equal bytes."""
        a, b = self.get(tile, method, ratio), self.get(tile, other, ratio)
        if a is None or b is None or getattr(a, value) is None or getattr(b, value) is None:
            return None
        return getattr(a, value) - getattr(b, value)


@dataclass(frozen=True)
class Verdict:
    target: str
    where: str
    measured: str
    met: bool | None


def verdicts(results: Results) -> Iterator[Verdict]:
    kcta = [name for name in results.methods() if name.startswith("kcta")]
    yield from _at_least(results, "CTA at least as good as Tucker (fitted)", ["cta"], "tucker")
    yield from _at_least(results, "K-CTA at least as good as CTA (fitted)", kcta, "cta")
    for value, least, words in (
        ("psnr", 1.5, "1.5 dB better, fitted"),
        ("psnr_unseen", 0.0, "no worse, unseen"),
    ):
        target = f"K-CTA against singular values at 1:500, weave: {words}"
        gain = _largest([results.gain("weave", 500, name, "svd", value) for name in kcta])
        yield Verdict(target, "weave", _decibels(gain), None if gain is None else gain >= least)
    for name in ("cta", *kcta):
        rates = [e.evaluations for e in results.all() if e.method == name]
        slowest = min(rates) if rates else None
        measured = "-" if slowest is None else f"{slowest / 1e6:.1f} million"
        met = None if slowest is None else slowest >= 1e6
        yield Verdict("a million evaluations a second and core", name, measured, met)


def _at_least(results: Results, target: str, methods: list[str], other: str) -> Iterator[Verdict]:
    """Compares the best of `methods` with `other`, for each tile at the ratio where it gains least."""
    for tile in results.tiles():
        gains = {
            ratio: _largest([results.gain(tile, ratio, name, other) for name in methods])
            for ratio in results.ratios()
        }
        known = {ratio: gain for ratio, gain in gains.items() if gain is not None}
        if not known:
            yield Verdict(target, tile, "-", None)
            continue
        worst = min(known, key=known.get)
        measured = f"{_decibels(known[worst])} at 1:{worst}, {_decibels(max(known.values()))} at best"
        yield Verdict(target, tile, measured, known[worst] >= 0)


def _largest(gains: list[float | None]) -> float | None:
    return max((gain for gain in gains if gain is not None), default=None)


def _decibels(gain: float | None) -> str:
    return "-" if gain is None else f"{gain:+.2f} dB"
