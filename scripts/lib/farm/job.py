"""A job: what is rendered, how, and by which Velour. It is OUTPUT/farm/job.json; pictures go to OUTPUT."""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass, field
from pathlib import Path

FOLDER = "farm"


class JobError(RuntimeError):
    """One sentence: what is wrong and what to do."""


@dataclass
class Job:
    blend: str  # absolute path
    blend_state: list[int]  # bytes and nanoseconds of the last change, when the job was made
    name: str  # pictures are NAME_0012.exr
    format: str  # OPEN_EXR or OPEN_EXR_MULTILAYER
    velour: str  # the version
    models: dict[str, list[str]]  # hashes of what each measured material of the .blend is rendered from
    frames: list[int]
    tasks: int  # that the frames are dealt out to
    blender: str = "blender"  # on the nodes
    addon: str = "velour"  # its module: bl_ext.user_default.velour of an extension
    threads: int = 0  # of Blender; 0: all that the node has
    memory_mib: int = 0  # to ask for; 0: what the engine gives
    preferences: bool = False  # the node's user preferences rather than factory settings
    scripts: bool = False  # those inside the .blend may run
    folder: Path = field(default=Path(), compare=False)  # of job.json

    @property
    def output(self) -> Path:
        return self.folder.parent

    def picture(self, frame: int) -> Path:
        return self.output / f"{self.name}_{frame:04d}.exr"

    def failure(self, frame: int) -> Path:
        """Says in a sentence why a frame failed, where it did."""
        return self.folder / "failed" / f"{frame:04d}.txt"

    def log(self, frame: int) -> Path:
        return self.folder / "logs" / f"{frame:04d}.log"

    def partial(self, frame: int) -> Path:
        """Where pictures of a frame are until they are known to be good."""
        return self.folder / "partial" / f"{frame:04d}"

    def task(self, number: int) -> list[int]:
        """The frames of a task: they are dealt out in turn, so neighbours run side by side."""
        if number not in range(self.tasks):
            raise JobError(f"there is no task {number}; the job has {self.tasks}, counted from 0.")
        return self.frames[number :: self.tasks]

    def save(self) -> None:
        for name in ("failed", "logs", "partial"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        values = asdict(self)
        del values["folder"]
        replace_text(self.folder / "job.json", json.dumps(values, indent=2, ensure_ascii=False) + "\n")


def load(path: Path) -> Job:
    """From a job.json, its folder, or the folder of pictures."""
    found = next((p for p in (path, path / "job.json", path / FOLDER / "job.json") if p.is_file()), None)
    if found is None:
        raise JobError(f"{path} holds no job; scripts/farm makes one from a .blend.")
    try:
        return Job(**json.loads(found.read_text(encoding="utf-8")), folder=found.resolve().parent)
    except (ValueError, TypeError) as error:
        raise JobError(f"{found} cannot be read ({error}); remove it, and make the job anew.") from error


def blend_state(path: str) -> list[int]:
    found = os.stat(path)
    return [found.st_size, found.st_mtime_ns]


def replace_text(path: Path, text: str) -> None:
    """The file is the old one or the new one, never a part."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, path)
