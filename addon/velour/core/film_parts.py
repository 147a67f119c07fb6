"""Files with samples of a frame, rendered by several machines or left by an interrupted run for the next.

Each file has a range [begin, end) of the light directions of every pixel. It is an OpenEXR picture whose
first four channels are the picture so far; the others are Job.read_sums(), from which all passes can be
continued and added up. Its header says what it is a part of (picture_parts.py).
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

_COLORS = 4
_LONGEST_NAME = 200  # bytes; a suffix follows, and most file systems allow 255


class FilmParts:
    """The files of one view layer of a frame within a range of samples."""

    def __init__(
        self,
        folder: Path,
        name: str,
        made: dict,
        size: tuple[int, int],
        asked: Range | None = None,
        stay: bool = False,
    ):
        """`name`: prefix of the file names; `made`: everything that the frame depends on, including spp and
        split; `asked`: requested range, by default all samples; `stay`: the user removes the files.
        Raises VelourError if a file belongs to another frame."""
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
        """Requested ranges that no file has."""
        ends = [self.asked[0], *(end for part in self._kept for end in part.ranges[0]), self.asked[1]]
        return [(begin, end) for begin, end in list(pairwise(ends))[::2] if begin < end]

    @property
    def files(self) -> list[Path]:
        """All files within the requested range, including redundant ones."""
        return [Path(part.name) for part in self._all]

    def begin(self, job: Job, gap: Range) -> None:
        """Adds all samples before `gap` to `job`, which will render the gap. Gaps are rendered in order."""
        for part in self._before(gap):
            job.add_sums(_sums(part, job))

    def keep(self, job: Job, gap: Range, end: int) -> Path:
        """Writes the samples that begin() added and `job` rendered, up to `end`; removes the files before.

        Files that other runs have written meanwhile do not count: their samples are in the gaps."""
        before, span = self._before(gap), (self.asked[0], end)
        written = self._write(job, span)
        self._remove(before)
        self._all, self._kept = (
            [self._part(str(written), span), *(part for part in parts if part not in before)]
            for parts in (self._all, self._kept)
        )
        return written

    def complete(self, job: Job, gap: Range | None) -> None:
        """Adds all samples that `job` lacks, which has rendered the last gap or nothing."""
        before = self._before(gap) if gap else []
        for part in self._kept:
            if part not in before:
                job.add_sums(_sums(part, job))

    def keep_all(self, job: Job) -> Path:
        """Writes the requested range after complete(). The file replaces all others, unless they stay:
        another run may be reading them."""
        written = self._write(job, self.asked)
        if not self.stay:
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
        """Parts within the requested range, sorted by first sample, then longest first."""
        wanted = self._part("this render", self.asked)
        found = []
        for path in self._folder.glob(f"{glob.escape(self._name)}.*-*.exr"):
            part = _opened(path)
            if not part:
                continue
            if difference := picture_parts.difference(part, wanted):
                raise refuse(
                    f"{path} belongs to another render, as {difference}; remove it, or choose another folder."
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
        text = f"Samples {begin}:{end}"
        if end > spp:
            raise refuse(f"{text} exceed the {spp} samples of the scene; raise Samples, or request fewer.")
        if any(at % split and at != spp for at in (begin, end)):
            raise refuse(
                f"{text} must begin and end at multiples of {split}, the samples per camera ray (Split)."
            )


def _file_name(name: str) -> str:
    """The name quoted, and shortened to leave room for the suffix of the file name."""
    quoted = quote(name, safe="")
    if len(quoted) <= _LONGEST_NAME:
        return quoted
    return f"{quoted[: _LONGEST_NAME - 17]}-{hashlib.sha256(name.encode()).hexdigest()[:16]}"


def _opened(path: Path) -> Part | None:
    """None: another run of the same frame has just replaced the file by a longer one."""
    try:
        return picture_parts.part_of(path, images.header(path))
    except VelourError:
        if path.exists():
            raise
        return None


def _sums(part: Part, job: Job) -> np.ndarray:
    width, height, channels = images.size(part.name)
    if (width, height) != job.size or channels != _COLORS + job.sums_per_pixel():
        raise refuse(f"{part.name} differs from this render in its pixels or passes; remove it.")
    return images.read(part.name)[..., _COLORS:]
