"""Parts of one picture made by several machines or runs: some of its pixels, some of its samples, or both.

A part's header identifies the whole picture (`velour.render`: everything that it depends on), the samples
that each pixel has (`velour.samples`), and the instruction set that made them (`velour.simd`), which affects
the last bits. Its data window is the position of its pixels. Ranges [begin, end) count light directions.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np

from ..native import images
from ..native.errors import refuse
from ..native.images import Frame
from ..native.version import version_text

MADE, SAMPLES, SIMD = "velour.render", "velour.samples", "velour.simd"
_ONE_LAYER = (
    ["Y"],
    ["R", "G", "B"],
    ["R", "G", "B", "A"],
)  # channel names that images.write_part() writes
Range = tuple[int, int]


@dataclass(frozen=True)
class Part:
    name: str  # for messages
    made: dict  # everything that the whole picture depends on, including spp and split
    ranges: tuple[Range, ...]  # sorted, with gaps between them
    frame: Frame
    width: int
    height: int
    simd: str  # names separated by commas
    # Reads the pixels [height x width x channels], row 0 at the bottom; None: not rendered yet.
    read: Callable[[], np.ndarray] | None

    @property
    def window(self) -> tuple[slice, slice]:
        """Row and column slices of the part in an array of the whole picture."""
        x, y = self.frame.x, self.frame.y
        return slice(y, y + self.height), slice(x, x + self.width)


def write(path: str | os.PathLike, part: Part) -> None:
    """Like images.write(); .exr files say what they are a part of. Without ranges they cannot be merged."""
    if Path(path).suffix != ".exr":
        return images.write(path, part.read())
    images.write_part(path, part.read(), part.frame, texts_of(part))


def texts_of(part: Part) -> dict[str, str]:
    """Header texts that part_of() reads."""
    texts = {"velour.version": version_text(), MADE: json.dumps(part.made, sort_keys=True), SIMD: part.simd}
    if part.ranges:
        texts[SAMPLES] = ",".join(f"{begin}:{end}" for begin, end in part.ranges)
    return texts


def open_part(path: str | os.PathLike) -> Part:
    """The part in a file; its pixels are read later. Raises VelourError if the header describes no part."""
    header = images.header(path)
    _check_one_layer(path, header)
    return part_of(path, header)


def part_of(path: str | os.PathLike, header: dict) -> Part:
    """The part that a header describes. The channels are not checked."""
    said = header["texts"]
    missing = next((name for name in (MADE, SAMPLES) if name not in said), None)
    if missing:
        raise refuse(
            f"{path} cannot be merged: its header has no {missing}. Use parts that Velour rendered"
            " without noise target and denoising."
        )
    made, ranges = _parsed(said[MADE], said[SAMPLES])
    width, height, frame = header["width"], header["height"], header["frame"]
    inside = 0 <= frame.x <= frame.width - width and 0 <= frame.y <= frame.height - height
    if not (ranges and inside):
        raise refuse(f"{path} cannot be merged: its header is invalid. Render this part again.")
    return Part(str(path), made, ranges, frame, width, height, said.get(SIMD, ""), lambda: images.read(path))


def _check_one_layer(path: str | os.PathLike, header: dict) -> None:
    """Merging does not keep channel names, so it would lose other layers."""
    if header["multi_part"]:
        more = "several OpenEXR parts"
    elif header["channels"] not in _ONE_LAYER:
        more = f"the channels {', '.join(header['channels'])}"
    else:
        return
    raise refuse(
        f"{path} has {more}, but merging needs files with one layer, as velour render writes them. Render"
        " parts with several passes in Blender with --velour-parts, or write the image without passes."
    )


def _parsed(made_text: str, ranges_text: str) -> tuple[dict, tuple[Range, ...]]:
    """The parsed header texts; no ranges if Velour did not write them."""
    try:
        made = json.loads(made_text)
        ranges = tuple(
            (int(begin), int(end)) for begin, end in (r.split(":") for r in ranges_text.split(","))
        )
        ends = [end for span in ranges for end in span]
        sound = ends == sorted(set(ends)) and ends[0] >= 0 and ends[-1] <= made["spp"] and made["split"] > 0
    except (ValueError, KeyError, TypeError):
        sound = False
    return (made, ranges) if sound else ({}, ())


def merge(parts: list[Part], partial: bool = False) -> Part:
    """The whole picture with all samples of all pixels; with `partial`, all pixels may lack the same samples.

    The means of a pixel are weighted by their camera rays. A pixel found in only one part keeps its bits.
    """
    check_one_picture(parts)
    for one, other in combinations(parts, 2):
        _check_apart(one, other)
    ranges = _covered(parts, partial)
    pixels = _weighted(parts, ranges)
    height, width = pixels.shape[:2]
    simd = ",".join(sorted({name for part in parts for name in part.simd.split(",")}))
    return Part(
        "the merged image", parts[0].made, ranges, Frame(width, height), width, height, simd, lambda: pixels
    )


def check_one_picture(parts: list[Part]) -> None:
    """Raises VelourError that names two parts of different pictures and how the pictures differ."""
    first = parts[0]
    for part in parts[1:]:
        if what := difference(first, part):
            raise refuse(f"{first.name} and {part.name} are parts of different images: {what}.")


def difference(one: Part, other: Part) -> str:
    """How the pictures of the two parts differ; empty if it is the same picture."""
    for key in sorted(one.made.keys() | other.made.keys()):
        a, b = one.made.get(key), other.made.get(key)
        if a != b:
            return f"the {key.replace('_', ' ')} differs ({_short(a)} and {_short(b)})"
    a, b = one.frame, other.frame
    if (a.width, a.height) != (b.width, b.height):
        return f"the size differs ({a.width}x{a.height} and {b.width}x{b.height} pixels)"
    return ""


def _short(value) -> str:
    text = json.dumps(value)
    return text if len(text) <= 40 else f"{text[:17]}..."


def _check_apart(one: Part, other: Part) -> None:
    sides = zip(one.window, other.window, strict=True)
    pixels = [(max(a.start, b.start), min(a.stop, b.stop)) for a, b in sides]
    if any(begin >= end for begin, end in pixels):
        return
    for a in one.ranges:
        for b in other.ranges:
            begin, end = max(a[0], b[0]), min(a[1], b[1])
            if begin < end:
                where = _place(one.frame, *pixels)
                raise refuse(
                    f"{one.name} and {other.name} overlap: both have samples {begin}:{end} of {where}."
                    " Leave one of them out."
                )


def _covered(parts: list[Part], partial: bool) -> tuple[Range, ...]:
    """The samples that all pixels have. Raises VelourError that names what is missing."""
    frame, spp = parts[0].frame, parts[0].made["spp"]
    ends = sorted({0, spp, *(end for part in parts for span in part.ranges for end in span)})
    covered = []
    for begin, end in pairwise(ends):
        seen = np.zeros((frame.height, frame.width), bool)
        for part in parts:
            if any(a <= begin and end <= b for a, b in part.ranges):
                seen[part.window] = True
        if partial and not seen.any():
            continue
        if not seen.all():
            raise refuse(_missing(frame, ~seen, begin, end))
        covered.append((begin, end))
    return joined(covered)


def _missing(frame: Frame, missing: np.ndarray, begin: int, end: int) -> str:
    rows, columns = (np.flatnonzero(missing.any(axis=axis)) for axis in (1, 0))
    rows, columns = (rows[0], rows[-1] + 1), (columns[0], columns[-1] + 1)
    all_of_them = missing[slice(*rows), slice(*columns)].all()
    where = _place(frame, rows, columns)
    return (
        f"No part has samples {begin}:{end} of {where if all_of_them else f'some of {where}'}; render them."
    )


def _place(frame: Frame, rows: tuple[int, int], columns: tuple[int, int]) -> str:
    """Pixels in the notation of --crop, which counts rows from the top."""
    top, bottom = frame.height - rows[1], frame.height - rows[0]
    return f"the pixels {columns[0]}:{columns[1]},{top}:{bottom}"


def joined(ranges: Iterable[Range]) -> tuple[Range, ...]:
    """Joins adjacent ranges."""
    result: list[Range] = []
    for begin, end in sorted(ranges):
        if result and result[-1][1] == begin:
            begin = result.pop()[0]
        result.append((begin, end))
    return tuple(result)


def camera_rays(ranges: Iterable[Range], split: int) -> int:
    """Number of camera rays. A pixel's last ray may have fewer than `split` directions; it counts fully."""
    return sum(-(-end // split) - -(-begin // split) for begin, end in ranges)


def _weighted(parts: list[Part], ranges: tuple[Range, ...]) -> np.ndarray:
    split, frame = parts[0].made["split"], parts[0].frame
    total = None
    for part in parts:
        pixels = part.read()
        if total is None:
            # Adding to -0.0 preserves every number, including -0.0.
            total = np.full((frame.height, frame.width, pixels.shape[2]), -0.0)
        if pixels.shape[2] != total.shape[2]:
            raise refuse(
                f"{part.name} has {pixels.shape[2]} channels, but {parts[0].name} has {total.shape[2]}; use"
                " parts with the same channels."
            )
        # Exact: the product of a float32 and a number of camera rays fits into a float64.
        total[part.window] += pixels.astype(np.float64) * camera_rays(part.ranges, split)
    return (total / camera_rays(ranges, split)).astype(np.float32)
