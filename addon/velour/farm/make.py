"""Makes a job from a .blend. Blender reports its contents once; each node is checked against this report."""

from __future__ import annotations

import argparse
import json
import os
import tempfile
from pathlib import Path

from . import blender, job, sources

HERE = Path(__file__).resolve().parent


def make(given: argparse.Namespace) -> job.Job:
    """Saves nothing. An existing job must have the same .blend, the same models and the same Velour."""
    # Links stay: nodes may have others of the same names, and Blender looks beside a link for relative paths.
    blend = Path(os.path.abspath(given.path))
    if not blend.is_file():
        raise job.JobError(f"{blend} is no file.")
    folder = Path(os.path.abspath(given.output or blend.parent / "frames")) / job.FOLDER
    _check_path(folder.parent)
    made = job.Job(
        blend=str(blend),
        blend_hash=sources.sha256(blend),
        libraries={},
        name=blend.stem,
        format=given.format,
        velour="",
        blender_version="",
        models={},
        frames=given.frames or [],
        tasks=1,
        parts=given.parts,
        blender=given.blender,
        addon=given.addon,
        threads=given.threads,
        memory_mib=given.memory,
        preferences=given.preferences,
        scripts=given.scripts,
        folder=folder,
    )
    _ask_blender(made)
    made.tasks = min(given.tasks, len(made.frames) * made.parts)
    if (folder / "job.json").is_file():
        _refuse_another(made, job.load(folder))
    return made


def _check_path(output: Path) -> None:
    """Raises JobError for what has a special meaning in Slurm's scripts or in Blender's paths."""
    if str(output).startswith("//"):
        raise job.JobError(f"{output}: // means beside the .blend to Blender; name the --output without it.")
    signs = sorted({sign for sign in str(output) if sign in '"\\{}' or not sign.isprintable()})
    if signs:
        raise job.JobError(f"{output}: a path with {' '.join(map(repr, signs))} in it cannot be an --output.")


def _ask_blender(made: job.Job) -> None:
    with tempfile.TemporaryDirectory(prefix="velour-farm-") as name:
        report, log = Path(name) / "report.json", Path(name) / "log.txt"
        script = ["--python", str(HERE / "inside_blend.py"), "--", made.addon, str(made.parts), str(report)]
        status = blender.execute([*blender.start(made), *script], log)
        if status or not report.is_file():
            raise job.JobError(f"{made.blend}: {blender.ending(status, log)}.")
        found = json.loads(report.read_text(encoding="utf-8"))
    if "error" in found:
        raise job.JobError(f"{made.blend}: {found['error']}")
    for note in found["notes"]:
        print(note)
    made.velour, made.models, made.blender_version = found["velour"], found["models"], found["blender"]
    made.libraries = sources.libraries(made.blend, found["libraries"])
    made.frames = made.frames or found["frames"]


def _refuse_another(made: job.Job, before: job.Job) -> None:
    """Raises JobError: frames of two states of a scene must not become one sequence."""
    kept = {
        "blend": "path of the .blend",
        "blend_hash": ".blend",
        "libraries": "library",
        "velour": "Velour",
        "blender_version": "Blender",
        "models": "model",
        "format": "format",
        "parts": "number of parts",
        "preferences": "setting of --preferences",
        "scripts": "setting of --scripts",
    }
    other = [words for name, words in kept.items() if getattr(made, name) != getattr(before, name)]
    if other:
        raise job.JobError(
            f"{made.folder} is of another {' and another '.join(other)}: name another --output, or remove"
            " that folder to keep the pictures that its Velour and models still fit."
        )
