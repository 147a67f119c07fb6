"""A render that SIGTERM or its time limit ends: a side file keeps what it has, and the next run goes on."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from ...native.errors import refuse
from ...native.images import Frame
from .. import picture_parts
from ..picture_parts import Part
from . import output, render_part
from .exit_status import UnfinishedError


def side_file(path: str) -> Path:
    return Path(path).with_suffix(".unfinished.exr")


def kept(asked: Part) -> Part | None:
    """What earlier runs of the same render left. Raises a sentence where it is another render's."""
    path = side_file(asked.name)
    if not _goes_on(asked) or not path.exists():
        return None
    part = picture_parts.open_part(path)
    remedy = "remove the former to begin anew, or name another output"
    if difference := picture_parts.difference(part, asked):
        raise refuse(f"{path} is not of this render: {difference}; {remedy}.")
    (begin, end), (first, last) = asked.ranges[0], (part.ranges[0][0], part.ranges[-1][1])
    same = part.window == asked.window and len(part.ranges) == 1 and first == begin and last < end
    if not same:
        raise refuse(f"{path} is not of this render: it has other pixels or samples; {remedy}.")
    output.log.info("Goes on from the samples %d:%d in %s.", first, last, path)
    return part


def _goes_on(asked: Part) -> bool:
    """Whether means of all samples so far suffice for a run to go on from."""
    return not (asked.made["noise"] or asked.made["denoise"])


def left(asked: Part, before: Part | None) -> Part:
    """What is still to be rendered."""
    return replace(asked, ranges=((before.ranges[0][1], asked.ranges[0][1]),)) if before else asked


def deliver(asked: Part, before: Part | None, rendered: Part, report: dict) -> Part:
    """Writes the picture of both and removes the side file; or writes that one and raises."""
    path = side_file(asked.name)
    if not report["passes"]:
        raise UnfinishedError(f"Stopped before a pass was done; {_known(before, path)}")
    whole = _together(before, rendered)
    if render_part.is_complete(asked, whole, report):
        picture_parts.write(asked.name, whole)
        path.unlink(missing_ok=True)
        return whole
    picture_parts.write(path, whole)
    if not _goes_on(asked):
        raise UnfinishedError(
            f"Stopped; {path} has the picture so far; with --noise or --denoise the next run starts over."
        )
    raise UnfinishedError(f"Stopped; {_known(whole, path)}")


def _known(part: Part | None, path: Path) -> str:
    if not part:
        return "nothing was written."
    begin, end = part.ranges[0]
    return f"{path} has the samples {begin}:{end}, and the same command goes on from there."


def _together(before: Part | None, rendered: Part) -> Part:
    if not before:
        return rendered
    own = Frame(rendered.width, rendered.height)  # of a crop: neither has other pixels
    merged = picture_parts.merge([replace(part, frame=own) for part in (before, rendered)], partial=True)
    return replace(merged, frame=rendered.frame)
