"""Samples of a frame as files: what several machines render of it, or an ended run leaves to the next.

Each file has a range [begin, end) of the light directions of every pixel. It is an OpenEXR picture whose
first four channels are the picture so far; the others are Job.read_sums(), so that all passes go on and add
up. Its header says what it is a part of, as picture_parts.py has it.
"""

from __future__ import annotations

import glob
import hashlib
import json
from itertools import pairwise
from pathlib import Path
from urllib.parse import quote

import numpy as np

from ..native import Job, images, library
from ..native.errors import VelourError, refuse
from ..native.images import Frame
from . import picture_parts
from .picture_parts import Part, Range

_COLOURS = 4
_LONGEST_NAME = 200  # of the 255 bytes that most file systems have


class FilmParts:
    """Those of one frame's view layer within a range of samples."""

    def __init__(
        self,
        folder: Path,
        name: str,
        made: dict,
        size: tuple[int, int],
        asked: Range | None = None,
        stay: bool = False,
    ):
        """`name`: what its files' names begin with; `made`: all that the frame depends on, spp and split
        among it; `asked`: all samples unless given; `stay`: who asks for the frame removes the files.
        Raises a sentence where a file is of another frame."""
        self._folder, self._name, self.stay = folder, _file_name(name), stay
        self._made, self._size = json.loads(json.dumps(made)), size
        self.asked = asked or (0, made["spp"])
        self._check_asked()
        self._all = self._found()
        self._kept = self._disjoint()

    @property
    def is_whole(self) -> bool:
        return self.asked == (0, self._made["spp"])

    @property
    def gaps(self) -> list[Range]:
        """What is asked for and not there."""
        ends = [self.asked[0], *(end for part in self._kept for end in part.ranges[0]), self.asked[1]]
        return [(begin, end) for begin, end in list(pairwise(ends))[::2] if begin < end]

    @property
    def files(self) -> list[Path]:
        """All there are of what is asked for, also such that others have made superfluous."""
        return [Path(part.name) for part in self._all]

    def begin(self, job: Job, gap: Range) -> None:
        """Hands all samples before `gap` to `job`, which is to render it. Gaps are rendered in order."""
        for part in self._before(gap):
            job.add_sums(_sums(part, job))

    def keep(self, job: Job, gap: Range, end: int) -> Path:
        """Writes what begin() handed on and `job` has added up to `end`; the former files go."""
        before = self._before(gap)
        written = self._write(job, (self.asked[0], end))
        self._remove(before)
        self._all = self._found()
        self._kept = self._disjoint()
        return written

    def complete(self, job: Job, gap: Range | None) -> None:
        """Adds all that `job` does not have yet, which has rendered the last gap, or nothing."""
        before = self._before(gap) if gap else []
        for part in self._kept:
            if part not in before:
                job.add_sums(_sums(part, job))

    def keep_all(self, job: Job) -> Path:
        """Writes what is asked for, once complete() made it; it takes the place of all other files."""
        written = self._write(job, self.asked)
        self._remove([part for part in self._all if Path(part.name) != written])
        return written

    def _before(self, gap: Range) -> list[Part]:
        return [part for part in self._kept if part.ranges[0][1] <= gap[0]]

    def _write(self, job: Job, span: Range) -> Path:
        self._folder.mkdir(parents=True, exist_ok=True)
        path = self._folder / f"{self._name}.{span[0]}-{span[1]}.exr"
        part = self._part(str(path), span)
        pixels = np.concatenate((job.read_pass("Combined"), job.read_sums()), axis=2)
        images.write_part(path, pixels, part.frame, picture_parts.texts_of(part))
        return path

    def _part(self, name: str, span: Range) -> Part:
        simd = library.system()["simd"]
        return Part(name, self._made, (span,), Frame(*self._size), *self._size, simd, None)

    def _found(self) -> list[Part]:
        """Sorted; longer ones before others that begin at the same sample."""
        wanted = self._part("this render", self.asked)
        found = []
        for path in self._folder.glob(f"{glob.escape(self._name)}.*-*.exr"):
            part = _opened(path)
            if not part:
                continue
            if difference := picture_parts.difference(part, wanted):
                raise refuse(
                    f"{path} is not of this render: {difference}; remove it, or name another folder."
                )
            begin, end = part.ranges[0][0], part.ranges[-1][1]
            if len(part.ranges) == 1 and self.asked[0] <= begin and end <= self.asked[1]:
                found.append(part)
        return sorted(found, key=lambda part: (part.ranges[0][0], -part.ranges[0][1]))

    def _disjoint(self) -> list[Part]:
        kept: list[Part] = []
        for part in self._all:
            if not kept or part.ranges[0][0] >= kept[-1].ranges[0][1]:
                kept.append(part)
        return kept

    def _remove(self, parts: list[Part]) -> None:
        for part in parts:
            Path(part.name).unlink(missing_ok=True)

    def _check_asked(self) -> None:
        (begin, end), spp, split = self.asked, self._made["spp"], self._made["split"]
        text = f"The samples {begin}:{end}"
        if end > spp:
            raise refuse(f"{text} go beyond {spp}, those of the scene; raise them there, or ask for fewer.")
        if any(at % split and at != spp for at in (begin, end)):
            raise refuse(f"{text} must begin and end at multiples of {split}, which share a camera ray.")


def _file_name(name: str) -> str:
    """Quoted, and no longer than file systems allow together with what follows it."""
    quoted = quote(name, safe="")
    if len(quoted) <= _LONGEST_NAME:
        return quoted
    return f"{quoted[: _LONGEST_NAME - 17]}-{hashlib.sha256(name.encode()).hexdigest()[:16]}"


def _opened(path: Path) -> Part | None:
    """None: another run of the same frame has just put a longer one in its place."""
    try:
        return picture_parts.part_of(path, images.header(path))
    except VelourError:
        if path.exists():
            raise
        return None


def _sums(part: Part, job: Job) -> np.ndarray:
    width, height, channels = images.size(part.name)
    if (width, height) != job.size or channels != _COLOURS + job.sums_per_pixel():
        raise refuse(f"{part.name} has other pixels or passes than this render; remove it.")
    return images.read(part.name)[..., _COLOURS:]
