"""One task on a node: renders frames that are not done, checks each picture, and only then gives it its name.

Needs only Python's standard library: frame.pyz in a job's folder, beside job.json. Exit status: 0 everything
requested is done; 1 something failed, with a message on stderr and in failed/; 2 wrong usage; 3 ended by
SIGTERM or the .blend's time limit, nothing failed, and the next run continues from there.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import socket
import sys
from collections.abc import Callable
from pathlib import Path

from . import blender, exr, job, ranges, sources

DONE, FAILED, UNFINISHED = 0, 1, 3  # exit statuses
_BETTER_FIRST = (DONE, UNFINISHED, FAILED)


class UnfinishedError(Exception):
    """Why a frame that did not fail is not done: its film is kept, and the next run continues from there."""


def main(arguments: list[str] | None = None) -> int:
    given = _parse(arguments)
    try:
        found = job.load(given.job)
        found.blend, found.blender = given.blend or found.blend, given.blender or found.blender
        units = _units(found, given)
    except (job.JobError, OSError) as error:
        print(f"farm: {error}", file=sys.stderr)
        return FAILED
    with blender.heeding_sigterm():
        return _run_all(found, units)


def _parse(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="frame.pyz", description="Renders frames of a job of scripts/farm.")
    parser.add_argument("job", type=Path, metavar="JOB", help="job.json")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--task", type=int, metavar="N", help="the frames of a task, counted from 0")
    what.add_argument("--frames", type=ranges.argument, metavar="LIST", help="such as 1-10,15")
    parser.add_argument("--part", type=int, metavar="K", help="of --frames only this part, from 1 on")
    parser.add_argument("--blend", metavar="PATH", help="the .blend, where this node has it elsewhere")
    parser.add_argument("--blender", metavar="PATH", help="the Blender, where this node has it elsewhere")
    return parser.parse_args(arguments)


def _units(task: job.Job, given: argparse.Namespace) -> list[job.Unit]:
    if given.frames is None:
        return task.task(given.task)
    if given.part is None:
        return task.units(given.frames)
    if given.part not in range(1, task.parts + 1):
        raise job.JobError(f"there is no part {given.part}; frames of this job have {task.parts}.")
    return [unit for unit in task.units(given.frames) if unit.part in (0, given.part)]


def _run_all(task: job.Job, units: list[job.Unit]) -> int:
    worst = DONE
    for unit in units:
        status = UNFINISHED if blender.stopped.is_set() else _run(task, unit)
        worst = max(worst, status, key=_BETTER_FIRST.index)
    return worst


def _run(task: job.Job, unit: job.Unit) -> int:
    """Renders a frame or a part of it; the last part makes the picture of all. Returns the exit status."""
    if not problem(task, task.picture(unit.frame)):
        print(f"frame {unit.frame}: is done", flush=True)
        return DONE
    if not unit.part:
        return _attempt(task, unit)
    if not task.part_done(unit).is_file() and (status := _attempt(task, unit)):
        return status
    if all(task.part_done(part).is_file() for part in task.parts_of(unit.frame)):
        return _attempt(task, job.Unit(unit.frame))
    return DONE


def _attempt(task: job.Job, unit: job.Unit) -> int:
    """Returns the exit status. The picture is made in a folder that nobody else writes to."""
    folder = task.partial(unit.frame) / job.nobody_elses_name()
    left = sentence = ""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        sentence = _render(task, unit, folder / "picture_")
    except UnfinishedError as why:
        left = str(why)
    except OSError as error:
        sentence = str(error)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    # Another run may have finished the frame, and removed the files of this one.
    if not (left or sentence) or not problem(task, task.picture(unit.frame)):
        task.failure(unit).unlink(missing_ok=True)
        print(f"{unit}: {'rendered' if unit.part else task.picture(unit.frame)}", flush=True)
        return DONE
    print(f"farm: {unit}: {left or sentence}", file=sys.stderr, flush=True)
    if left:
        task.failure(unit).unlink(missing_ok=True)  # failure of an earlier attempt
        return UNFINISHED
    _note(task.failure(unit), f"{sentence} Node: {_node()}")
    return FAILED


def _node() -> str:
    """Its name, for sbatch --exclude: several nodes of Slurm may share a host."""
    return os.environ.get("SLURMD_NODENAME") or socket.gethostname()


def _note(path: Path, sentence: str) -> None:
    """Whatever prevents writing a picture, such as a full disk, may also prevent writing its failure."""
    try:
        path.parent.mkdir(exist_ok=True)
        job.replace_text(path, sentence + "\n")
    except OSError as error:
        print(f"farm: {path} cannot be written ({error.strerror})", file=sys.stderr, flush=True)


def _render(task: job.Job, unit: job.Unit, path: Path) -> str:
    """Returns what went wrong, or "". Of a part the result is the film; its picture is only checked."""
    picture, check = Path(f"{path}{unit.frame:04d}.exr"), _problem if unit.part else problem
    if wrong := _blender(task, unit, path, lambda: not check(task, picture)):
        return wrong
    if wrong := check(task, picture):
        what = "part" if unit.part else "picture"
        return f"the {what} is not counted as done: {wrong}; {task.log(unit)} has what Blender said."
    if unit.part:
        task.part_done(unit).touch()
        return ""
    os.replace(picture, task.picture(unit.frame))
    shutil.rmtree(task.partial(unit.frame), ignore_errors=True)  # including files of killed runs
    return ""


def _blender(task: job.Job, unit: job.Unit, path: Path, is_good: Callable[[], bool]) -> str:
    """Returns what went wrong, or "". `is_good()` checks the picture."""
    if wrong := sources.changed(task):
        return wrong
    log = task.log(unit)
    status = blender.execute(blender.render(task, unit, path), log)
    if not status:
        return sources.changed(task)
    if blender.stopped.is_set():
        if is_good():  # the signal arrived when Blender had already written it
            return sources.changed(task)
        raise UnfinishedError("ended by SIGTERM; the next run goes on from there")
    if blender.ran_out_of_time(log):
        raise UnfinishedError("ended by the .blend's own time limit; the next run goes on from there")
    return f"{blender.ending(status, log)}; {log} has all of it."


def problem(task: job.Job, picture: Path) -> str:
    """Why a picture does not belong to this job or is incomplete; "" if it is done."""
    return _problem(task, picture) or _not_all_samples(picture)


def _not_all_samples(picture: Path) -> str:
    samples = exr.text_attribute(picture, "velour.samples")
    return f"it has the samples {samples} alone" if samples else ""


def _problem(task: job.Job, picture: Path) -> str:
    """problem() of a picture that may have only some of its samples."""
    try:
        return (
            _another_velour(task, exr.text_attribute(picture, "velour.version"))
            or _another_blender(task, exr.text_attribute(picture, "velour.blender"))
            or _other_models(task, exr.text_attribute(picture, "velour.models"))
            or _not_whole(picture)
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


def _another_blender(task: job.Job, version: str | None) -> str:
    """Ignores the third number of the version: those are bug-fix releases."""
    series, asked = (str(text).split(".")[:2] for text in (version, task.blender_version))
    return "" if series == asked else f"Blender {version} rendered it, the job is for {task.blender_version}"


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
