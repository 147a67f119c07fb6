"""The sources of a job: its .blend and the libraries that it links, as they were when the job was made."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

from .job import Job, JobError

_known: dict[tuple, str] = {}  # hashes: a task has many frames, and a .blend may have gigabytes


def changed(job: Job) -> str:
    """Names a source that has changed, and says what to do; "" if none has."""
    expected = {Path(job.blend): job.blend_hash}
    expected |= {_place(job.blend, name): found for name, found in job.libraries.items()}
    for path, was in expected.items():
        try:
            if sha256(path) != was:
                return (
                    f"{path} changed since the job was made: frames of two states must not become one"
                    " sequence. Bring the former back, or make a job of this one with another --output."
                )
        except OSError as error:
            return f"{path} cannot be read ({error.strerror}); the job needs it as it was when it was made."
    return ""


def libraries(blend: str, names: list[str]) -> dict[str, str]:
    """Job.libraries of these paths. Raises JobError if one is missing: Blender would continue without it."""
    found = {}
    for name in names:
        try:
            found[name] = sha256(_place(blend, name))
        except OSError as error:
            raise JobError(
                f"{blend}: the library {_place(blend, name)} cannot be read ({error.strerror}), and frames"
                " would lack what is linked from it; bring it back, or remove it from the .blend."
            ) from error
    return found


def _place(blend: str, name: str) -> Path:
    return Path(os.path.normpath(Path(blend).parent / name))  # an absolute name stays itself


def sha256(path: Path) -> str:
    state = os.stat(path)
    key = (path, state.st_ino, state.st_size, state.st_mtime_ns)
    if key not in _known:
        digest = hashlib.sha256()
        with open(path, "rb") as file:
            while block := file.read(1 << 20):
                digest.update(block)
        _known[key] = digest.hexdigest()
    return _known[key]
