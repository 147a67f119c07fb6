"""A job: what is rendered, how, and by which Velour. Saved as OUTPUT/farm/job.json; pictures go to OUTPUT."""

from __future__ import annotations

import json
import os
import secrets
import socket
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import NamedTuple

FOLDER = "farm"


class JobError(RuntimeError):
    """Its message says in one sentence what is wrong and what to do."""


class Unit(NamedTuple):
    """A frame or a part of one, rendered by one run of Blender."""

    frame: int
    part: int = 0  # from 1 to the job's parts; 0: the whole frame

    @property
    def name(self) -> str:
        return f"{self.frame:04d}" + (f"_{self.part}" if self.part else "")

    def __str__(self) -> str:
        return f"frame {self.frame}" + (f", part {self.part}" if self.part else "")


@dataclass
class Job:
    blend: str  # absolute path
    blend_hash: str  # SHA-256, when the job was made
    libraries: dict[str, str]  # SHA-256 of linked libraries by path; relative paths without Blender's //
    name: str  # pictures are NAME_0012.exr
    format: str  # OPEN_EXR or OPEN_EXR_MULTILAYER
    velour: str  # the version
    blender_version: str  # such as 3.4.1
    models: dict[str, list[str]]  # hashes of what each measured material of the .blend is rendered from
    frames: list[int]
    tasks: int  # number of tasks that share the frames, or their parts
    parts: int = 1  # number of parts that share the samples of a frame
    blender: str = "blender"  # on the nodes
    addon: str = "velour"  # module name; bl_ext.user_default.velour for an extension
    threads: int = 0  # for Blender; 0: all threads of the node
    memory_mib: int = 0  # requested memory; 0: the render manager's default
    preferences: bool = False  # use the node's user preferences instead of factory settings
    scripts: bool = False  # scripts inside the .blend may run
    folder: Path = field(default=Path(), compare=False)  # folder of job.json

    @property
    def output(self) -> Path:
        return self.folder.parent

    def picture(self, frame: int) -> Path:
        return self.output / f"{self.name}_{frame:04d}.exr"

    def failure(self, unit: Unit) -> Path:
        """File with the message why the unit failed; exists only if it did."""
        return self.folder / "failed" / f"{unit.name}.txt"

    def failures(self, frame: int) -> list[Path]:
        """Existing failure files of the frame and of its parts."""
        units = [Unit(frame), *self.parts_of(frame)]
        return [path for path in map(self.failure, units) if path.is_file()]

    def log(self, unit: Unit) -> Path:
        return self.folder / "logs" / f"{unit.name}.log"

    def partial(self, frame: int) -> Path:
        """Folder of a frame's pictures until they have been checked."""
        return self.folder / "partial" / f"{frame:04d}"

    def film(self, frame: int) -> Path:
        """Folder where Velour keeps the films of parts and of interrupted runs."""
        return self.partial(frame) / "film"

    def part_done(self, unit: Unit) -> Path:
        """File that exists once the film contains the part."""
        return self.film(unit.frame) / f"{unit.part}-of-{self.parts}.done"

    def parts_of(self, frame: int) -> list[Unit]:
        """The parts of a frame; empty if it is rendered in one piece."""
        return [Unit(frame, number) for number in range(1, self.parts + 1)] if self.parts > 1 else []

    def units(self, frames: list[int]) -> list[Unit]:
        return [unit for frame in frames for unit in self.parts_of(frame) or [Unit(frame)]]

    def task(self, number: int) -> list[Unit]:
        """Units of a task. They are distributed round-robin, so neighboring frames run at the same time."""
        if number not in range(self.tasks):
            raise JobError(f"there is no task {number}; the job has {self.tasks}, counted from 0.")
        return self.units(self.frames)[number :: self.tasks]

    def save(self) -> None:
        for name in ("failed", "logs", "partial"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        values = asdict(self)
        del values["folder"]
        replace_text(self.folder / "job.json", json.dumps(values, indent=2, ensure_ascii=False) + "\n")


def load(path: Path) -> Job:
    """Loads a job from its job.json, the folder of that, or the folder of pictures."""
    found = next((p for p in (path, path / "job.json", path / FOLDER / "job.json") if p.is_file()), None)
    if found is None:
        raise JobError(f"{path} holds no job; scripts/farm makes one from a .blend.")
    try:
        return Job(**json.loads(found.read_text(encoding="utf-8")), folder=found.absolute().parent)
    except (ValueError, TypeError) as error:
        raise JobError(f"{found} cannot be read ({error}); remove it, and make the job anew.") from error


def replace_text(path: Path, text: str) -> None:
    replace_bytes(path, text.encode())


def replace_bytes(path: Path, data: bytes) -> None:
    """Replaces the file atomically. A killed process may leave a temporary file, which nobody reads."""
    temporary = path.with_name(f".{path.name}.{nobody_elses_name()}")
    try:
        temporary.write_bytes(data)
        os.replace(temporary, path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def nobody_elses_name() -> str:
    """A name for files of this process alone: nodes share folders and may have equal process ids."""
    return f"{socket.gethostname()}-{secrets.token_hex(8)}"
