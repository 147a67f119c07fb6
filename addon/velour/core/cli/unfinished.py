"""Renders that SIGTERM or a time limit ends: a side file keeps the samples, and the next run continues."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from ...native import images
from ...native.errors import refuse
from ...native.images import Frame
from .. import picture_parts
from ..picture_parts import MADE, SAMPLES, Part
from . import output, render_part
from .exit_status import UnfinishedError


def side_file(path: str) -> Path:
    return Path(path).with_suffix(".unfinished.exr")


def kept(asked: Part) -> Part | None:
    """The part that earlier runs of this render left. Raises VelourError if it belongs to another render."""
    path = side_file(asked.name)
    if not path.exists():
        return None
    remedy = "remove it to start over, or choose another output"
    if not _goes_on(asked):
        if not _is_image_of(path, asked):
            raise refuse(f"{path} belongs to another render; {remedy}.")
        return None
    part = picture_parts.open_part(path)
    if difference := picture_parts.difference(part, asked):
        raise refuse(f"{path} belongs to another render, as {difference}; {remedy}.")
    (begin, end), (first, last) = asked.ranges[0], (part.ranges[0][0], part.ranges[-1][1])
    same = part.window == asked.window and len(part.ranges) == 1 and first == begin and last < end
    if not same:
        raise refuse(f"{path} belongs to another render, as its pixels or samples differ; {remedy}.")
    output.log.info("Continuing from samples %d:%d in %s.", first, last, path)
    return part


def _goes_on(asked: Part) -> bool:
    """Whether a run can continue from the means of all samples so far."""
    return not (asked.made["noise"] or asked.made["denoise"])


def _is_image_of(path: Path, asked: Part) -> bool:
    """Whether the file is all that an earlier run of `asked` left: an image, without samples to continue."""
    texts = images.header(path)["texts"]
    return SAMPLES not in texts and texts.get(MADE) == picture_parts.texts_of(asked)[MADE]


def left(asked: Part, before: Part | None) -> Part:
    """The part that remains to be rendered."""
    return replace(asked, ranges=((before.ranges[0][1], asked.ranges[0][1]),)) if before else asked


def deliver(asked: Part, before: Part | None, rendered: Part, report: dict) -> Part:
    """Writes the merged picture and removes the side file; if incomplete, writes the side file and raises
    UnfinishedError."""
    path = side_file(asked.name)
    if not report["passes"]:
        raise UnfinishedError(f"Stopped before a pass was complete; {_known(before, path)}")
    whole = _together(before, rendered)
    if render_part.is_complete(asked, whole, report):
        picture_parts.write(asked.name, whole)
        path.unlink(missing_ok=True)
        return whole
    picture_parts.write(path, whole)
    if not _goes_on(asked):
        raise UnfinishedError(
            f"Stopped; {path} has the image so far. With --noise or --denoise the next run starts over."
        )
    raise UnfinishedError(f"Stopped; {_known(whole, path)}")


def _known(part: Part | None, path: Path) -> str:
    if not part:
        return "nothing was written."
    begin, end = part.ranges[0]
    return f"{path} has samples {begin}:{end}. Run the same command again to continue."


def _together(before: Part | None, rendered: Part) -> Part:
    if not before:
        return rendered
    own = Frame(rendered.width, rendered.height)  # a crop counts as the whole: neither has other pixels
    merged = picture_parts.merge([replace(part, frame=own) for part in (before, rendered)], partial=True)
    return replace(merged, frame=rendered.frame)
