"""scripts/farm: makes a job of a .blend, submits what remains to Slurm, status: docs/reference/farm.md."""

from __future__ import annotations

import argparse
import contextlib
import re
import sys
from pathlib import Path

from . import flamenco, job, openjd, program, ranges, slurm, status
from .make import make

_UNITS = {"": 1, "M": 1, "G": 1024, "T": 1024**2}


def main(arguments: list[str] | None = None) -> int:
    given = _parse(arguments)
    try:
        if given.status:
            return _say_status(job.load(given.path))
        return _submit(given)
    except (job.JobError, OSError) as error:
        print(f"farm: {error}", file=sys.stderr)
        return 1


def _parse(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="farm", description="Renders the frames of a .blend with Velour on Slurm, Flamenco or OpenJD."
    )
    add = parser.add_argument
    add("path", type=Path, metavar="BLEND", help="the .blend; with --status the folder of the images")
    add("--output", type=Path, metavar="FOLDER", help="folder of the images (frames, beside the .blend)")
    add("--frames", type=ranges.argument, metavar="LIST", help="such as 1-10,15,20-30:2 (those of the scene)")
    add("--format", choices=("OPEN_EXR", "OPEN_EXR_MULTILAYER"), default="OPEN_EXR", help="(OPEN_EXR)")
    add("--threads", type=_count, default=0, metavar="N", help="threads per task (all of its node)")
    add("--memory", type=_memory, default=0, metavar="SIZE", help="memory per task, MiB or 8G (Slurm's)")
    add("--tasks", type=_count, default=1000, metavar="N", help="maximum number of array elements (1000)")
    add("--parts", type=_count, default=1, metavar="N", help="parts of the samples of a frame (1)")
    add("--blender", default="blender", metavar="PATH", help="the Blender to run, here and on the nodes")
    add("--addon", default="velour", metavar="MODULE", help="Velour's name there (velour)")
    add("--preferences", action="store_true", help="with user preferences, not factory settings")
    add("--scripts", action="store_true", help="let scripts and drivers inside the .blend run")
    add("--sbatch", action="append", default=[], metavar="OPTION", help="for sbatch; may be repeated")
    add("--no-submit", action="store_true", help="only write the job")
    add("--status", action="store_true", help="list finished and failed frames")
    return parser.parse_args(arguments)


def _submit(given: argparse.Namespace) -> int:
    found = make(given)
    slurm.refuse_while_running(found)  # queued array elements would read the files that are saved here
    found.save()
    for writer in (program, slurm, flamenco, openjd):
        writer.write(found.folder if writer is program else found)
    now = status.look(found)
    left = status.tasks_left(found, now)
    print(now.lines()[-1])
    if not left:
        return 0
    if given.no_submit:
        print(f"The job is in {found.folder}.")
        return 0
    old = {path: path.stat().st_mtime_ns for frame in now.failed for path in found.failures(frame)}
    number = slurm.submit(found, left, given.sbatch)
    _forget(old)
    print(f"Slurm's job {number}; how it stands: scripts/farm --status {found.output}")
    return 0


def _forget(notes: dict[Path, int]) -> None:
    """Removes notes of failures that are rendered again, unless a frame has failed again since `noted`."""
    for path, noted in notes.items():
        with contextlib.suppress(FileNotFoundError):
            if path.stat().st_mtime_ns == noted:
                path.unlink()


def _say_status(found: job.Job) -> int:
    now = status.look(found)
    print("\n".join(now.lines()))
    return now.code


def _count(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError("a number from 1 on is needed")
    return int(text)


def _memory(text: str) -> int:
    """Parses a size in MiB."""
    match = re.fullmatch(r"(\d+)([MGT]?)", text)
    if not match or not int(match[1]):
        raise argparse.ArgumentTypeError("MiB, or a number with M, G or T, is needed")
    return int(match[1]) * _UNITS[match[2]]
