"""A run of a page: its settings, and the renders, fits and other results that it keeps.

A result is kept under a hash of everything it depends on and is not made again, so an interrupted run
continues.
"""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import json
import resource
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np
import velour as addon
from velour.core import files
from velour.core.machine import machine
from velour.native import images

from . import project
from .progress import Progress
from .project import flags

if TYPE_CHECKING:
    from .scenes import Scene

_LIBRARY = Path(addon.__file__).with_name("lib") / "libvelour.so"
# Cost of a process besides its samples, in samples: startup, reading the mesh, building the BVH.
START = 10_000_000


@dataclasses.dataclass(frozen=True)
class Picture:
    path: Path
    seconds: float
    report: dict = dataclasses.field(default_factory=dict)

    @functools.cached_property
    def pixels(self) -> np.ndarray:
        """Linear RGB, float32."""
        return read_rgb(self.path)

    def errors(self, reference: np.ndarray) -> tuple[float, float]:
        """rmse and relmse."""
        return images.compare(self.pixels, reference)


@dataclasses.dataclass
class Run:
    """`settings`: the page's own; its `size` is the size of renders unless another is given."""

    name: str
    work: Path
    output: Path
    settings: SimpleNamespace
    seed: int = 1
    threads: int = 2
    fresh: bool = False
    progress: Progress = dataclasses.field(default_factory=Progress)

    def __post_init__(self):
        self.kept = self.work / "kept"
        if self.fresh:
            shutil.rmtree(self.kept, ignore_errors=True)
        self.kept.mkdir(parents=True, exist_ok=True)
        self.output.mkdir(parents=True, exist_ok=True)

    @functools.cached_property
    def data(self) -> Path:
        """The test data. Raises MissingError."""
        return project.data_folder()

    def world(self, name: str) -> Path:
        return project.world(self.data, name)

    def materials(self) -> list[tuple[str, Path]]:
        """Names and files of the first `materials` measurements."""
        return project.materials(self.data)[: self.settings.materials]

    def conditions(self, **more) -> dict:
        """The machine, commit and settings that numbers are measured with, for their page."""
        settings = {name: _shown(name, value) for name, value in vars(self.settings).items()}
        return project.conditions(self.seed, self.threads) | settings | more

    def expect(self, spp: int, size: tuple[int, int] | None = None, count: int = 1) -> None:
        """Announces renders to the progress."""
        self.progress.expect(_cost(spp, size or self.settings.size), count)

    def render(self, scene: Scene, spp: int, *, seed: int | None = None, size=None, **options) -> Picture:
        """`options`: command line options of `velour render`."""
        size = size or self.settings.size
        parameters = {**scene.options, "size": "{}x{}".format(*size), "spp": spp, **options}
        parameters |= {"seed": self.seed if seed is None else seed, "threads": self.threads}
        label = " ".join([f"{scene.name}, {parameters['size']}, {spp} spp,", *map(str, options.values())])
        out = self.stem("render", parameters).with_suffix(".exr")
        cache = [] if "cache" in options else ["--cache", self.kept]
        words = ["render", *flags(parameters), *cache, "-o", out]
        report = self.velour(label, "render", parameters, *words, cost=_cost(spp, size))
        return Picture(out, report["seconds"], report)

    def fit(self, measurement: Path, model: str = "scattered", **options) -> tuple[Path, dict]:
        """The model, and the report of its fit: {"refused": True} if no model has so few `bytes`."""
        options = {"model": model, "tolerance": 0.02, "seed": self.seed, **options}
        options = {name.replace("_", "-"): value for name, value in options.items()}
        label = f"{model} fit of {measurement.stem}, " + ", ".join(f"{k} {v}" for k, v in options.items())
        return self.model(label, "fit", measurement, options, refusable="bytes" in options)

    def default_fit(self, measurement: Path) -> Path:
        """The model that users get who choose nothing."""
        return self.model(f"default fit of {measurement.stem}", "fit", measurement, {"seed": self.seed})[0]

    def model(
        self, label: str, verb: str, source: Path, options: dict, name: str = "", **how
    ) -> tuple[Path, dict]:
        """The model that a verb makes of a source, and its report. `name`: of the kept files; `how`:
        arguments of velour()."""
        parameters = {"measurement": source, **options}
        out = self.stem(name or verb, parameters).with_suffix(".velour")
        words = (verb, source, "-o", out, *flags(options))
        return out, self.velour(label, name or verb, parameters, *words, **how)

    def compare_peer(self, measurement: Path, peer: str) -> dict:
        """Errors of the closest `peer`: ggx or principled."""
        words = ("compare", measurement, f"--{peer}")
        return self.velour(f"{peer} of {measurement.stem}", peer, {"measurement": measurement}, *words)

    def velour(
        self, label: str, name: str, parameters: dict, *words, cost: float = START, refusable: bool = False
    ) -> dict:
        """The report of a call of Velour, with its processor seconds. `refusable`: {"refused": True} if it
        ends with status 1."""

        def run() -> dict:
            before = processor_seconds()
            try:
                found = project.velour(*words, "--quiet")
            except subprocess.CalledProcessError as error:
                if error.returncode != 1 or not refusable:
                    raise
                found = {"refused": True}
            return found | {"processor_seconds": processor_seconds() - before}

        return self.keep(label, name, parameters, run, cost)

    def program(self, label: str, program: Path, *arguments, cost: float = START, **unkeyed) -> dict | None:
        """The JSON that a program of native/bench prints; None if it is not built. `unkeyed`: further options
        that do not change the result."""
        if not program.is_file():
            return None
        command = [program, *map(str, arguments), *words_of(unkeyed)]

        def run() -> dict:
            said = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
            return json.loads(said or "{}")

        parameters = dict(enumerate([program, *arguments]))
        return self.keep(label, program.name, parameters, run, cost)

    def keep(
        self, label: str, name: str, parameters: dict, make: Callable[[], dict], cost: float = START
    ) -> dict:
        """The kept report, or that which `make` returns."""
        report = self.stem(name, parameters).with_suffix(".json")
        if report.is_file():
            self.progress.skip(label, cost)
        else:
            with self.progress.work(label, cost):
                files.write_json(report, make())
        return json.loads(report.read_text(encoding="utf-8"))

    def stem(self, name: str, parameters: dict) -> Path:
        """Path of the files that depend on the parameters, without suffix."""
        return self.kept / f"{name}-{key(parameters)}"

    def made(self, name: str, write: Callable[[Path], Path]) -> Path:
        """A file of the kept ones, which `write` makes unless it exists."""
        path = self.kept / name
        return path if path.is_file() else write(path)


def _cost(spp: int, size: tuple[int, int]) -> float:
    return spp * size[0] * size[1] + START


def words_of(options: dict) -> list[str]:
    """Options of a program of native/bench."""
    return [str(word) for name, value in options.items() for word in (f"--{name}", value)]


def read_rgb(path: Path) -> np.ndarray:
    return np.ascontiguousarray(images.read(path)[..., :3])


def key(parameters: dict) -> str:
    """Hash of the parameters (files by content, not by name), the library and the machine."""
    known = {
        name: _hash(value) if isinstance(value, Path) else str(value) for name, value in parameters.items()
    }
    text = json.dumps([known, _hash(_LIBRARY), machine()], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _hash(path: Path) -> str:
    status = path.stat()
    return _hash_of_version(path, status.st_mtime_ns, status.st_size)


@functools.cache
def _hash_of_version(path: Path, modified: int, size: int) -> str:
    return files.sha256(path)


def _shown(name: str, value) -> object:
    """A setting as its page shows it."""
    if isinstance(value, tuple):
        return ("x" if name.endswith("size") else ", ").join(map(str, value))
    return value


def processor_seconds() -> float:
    """Time of all processes that this one has started and that have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
