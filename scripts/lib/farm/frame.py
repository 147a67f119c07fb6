"""One task on a node: renders frames that are not done, checks each picture, and only then gives it its name.

Runs alone, by Python's own library: frame.pyz of a job's folder, beside job.json. Exit status: 0 all frames
are done; 1 one failed, with a sentence on stderr and in failed/; 2 wrong usage.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import socket
import sys
from pathlib import Path

from . import blender, exr, job, ranges


def main(arguments: list[str] | None = None) -> int:
    given = _parse(arguments)
    try:
        found = job.load(given.job)
        found.blend, found.blender = given.blend or found.blend, given.blender or found.blender
        frames = found.task(given.task) if given.frames is None else given.frames
        return max([_run(found, frame) for frame in frames])
    except (job.JobError, OSError) as error:
        print(f"farm: {error}", file=sys.stderr)
        return 1


def _parse(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="frame.pyz", description="Renders frames of a job of scripts/farm.")
    parser.add_argument("job", type=Path, metavar="JOB", help="job.json")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--task", type=int, metavar="N", help="the frames of a task, counted from 0")
    what.add_argument("--frames", type=_frames, metavar="LIST", help="such as 1-10,15")
    parser.add_argument("--blend", metavar="PATH", help="the .blend, where this node has it elsewhere")
    parser.add_argument("--blender", metavar="PATH", help="the Blender, where this node has it elsewhere")
    return parser.parse_args(arguments)


def _frames(text: str) -> list[int]:
    try:
        return ranges.parse(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _run(task: job.Job, frame: int) -> int:
    """The exit status of a frame."""
    if not problem(task, task.picture(frame)):
        print(f"frame {frame}: is done", flush=True)
        return 0
    try:
        sentence = _render(task, frame)
    except OSError as error:
        sentence = str(error)
    # Another run may have finished the frame, and cleared away what this one had.
    if not sentence or not problem(task, task.picture(frame)):
        task.failure(frame).unlink(missing_ok=True)
        print(f"frame {frame}: {task.picture(frame)}", flush=True)
        return 0
    print(f"farm: frame {frame}: {sentence}", file=sys.stderr, flush=True)
    task.failure(frame).parent.mkdir(exist_ok=True)
    job.replace_text(task.failure(frame), sentence + "\n")
    return 1


def _render(task: job.Job, frame: int) -> str:
    """What went wrong, or "". Nobody else writes to the folder that the picture is made in."""
    folder = task.partial(frame) / f"{socket.gethostname()}-{os.getpid()}"
    folder.mkdir(parents=True, exist_ok=True)
    try:
        status = blender.execute(blender.render(task, frame, folder / "picture_"), task.log(frame))
        if status:
            return f"{blender.ending(status, task.log(frame))}; {task.log(frame)} has all of it."
        picture = folder / f"picture_{frame:04d}.exr"
        wrong = problem(task, picture)
        if wrong:
            return f"the picture is not counted as done: {wrong}; {task.log(frame)} has what Blender said."
        os.replace(picture, task.picture(frame))
        shutil.rmtree(task.partial(frame), ignore_errors=True)  # what killed runs of this frame left, too
        return ""
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def problem(task: job.Job, picture: Path) -> str:
    """Why a picture is none of this job, or not whole; "" of one that is done."""
    try:
        return _another_velour(task, exr.text_attribute(picture, "velour.version")) or (
            _other_models(task, exr.text_attribute(picture, "velour.models")) or _not_whole(picture)
        )
    except FileNotFoundError:
        return "there is none"
    except (OSError, exr.ExrError) as error:
        return str(error)


def _another_velour(task: job.Job, version: str | None) -> str:
    if version is None:
        return "no Velour wrote it, or one older than 0.1.0"
    if version != task.velour:
        return f"Velour {version} rendered it, the job is for {task.velour}"
    return ""


def _other_models(task: job.Job, text: str | None) -> str:
    """A frame need not show all materials of the .blend."""
    try:
        found = json.loads(text or "")
        other = sorted(name for name, hashes in found.items() if task.models.get(name) != hashes)
    except (ValueError, AttributeError):
        return "it does not say from which models it was rendered"
    if other:
        names = ", ".join(f"'{name}'" for name in other)
        return f"it was rendered from other models than the job's: {names}"
    return ""


def _not_whole(picture: Path) -> str:
    exr.check_whole(picture)
    return ""
