"""Renders and fits through the command line, each kept under a hash of everything it depends on.

Kept results are not made again, so an interrupted run continues.
"""

from __future__ import annotations

import functools
import hashlib
import json
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import velour
from progress import Progress
from scenes import Scene
from velour.core.machine import machine
from velour.native import images
from velour_cli import velour_to_file

_LIBRARY = Path(velour.__file__).with_name("lib") / "libvelour.so"
# Cost of a process besides its samples, in samples: startup, reading the mesh, building the BVH.
_START = 10_000_000


@dataclass(frozen=True)
class Picture:
    path: Path
    report: dict

    @functools.cached_property
    def pixels(self) -> np.ndarray:
        """Linear RGB, float32."""
        return read_rgb(self.path)

    def errors(self, reference: np.ndarray) -> tuple[float, float]:
        """rmse and relmse."""
        return images.compare(self.pixels, reference)


@dataclass(frozen=True)
class Settings:
    """Settings that all renders of a run share."""

    folder: Path
    size: tuple[int, int]
    threads: int
    seed: int


class Renders:
    def __init__(self, settings: Settings, progress: Progress, fresh: bool):
        self.settings, self.progress = settings, progress
        if fresh:
            shutil.rmtree(settings.folder, ignore_errors=True)
        settings.folder.mkdir(parents=True, exist_ok=True)

    def expect(self, spp: int, size: tuple[int, int] | None = None, count: int = 1) -> None:
        """Announces renders to the progress."""
        self.progress.expect(self._cost(spp, size or self.settings.size), count)

    def render(
        self,
        scene: Scene,
        spp: int,
        *,
        seed: int | None = None,
        size: tuple[int, int] | None = None,
        **options,
    ) -> Picture:
        """`options`: command line options of `velour render`."""
        size = size or self.settings.size
        parameters = {**scene.options, "size": "{}x{}".format(*size), "spp": spp, **options}
        parameters |= {
            "seed": self.settings.seed if seed is None else seed,
            "threads": self.settings.threads,
        }
        label = " ".join([f"{scene.name}, {parameters['size']}, {spp} spp,", *map(str, options.values())])
        out = self.stem("render", parameters).with_suffix(".exr")
        cache = [] if "cache" in options else ["--cache", self.settings.folder]

        def run(report: Path) -> dict:
            return velour_to_file(report, "render", *flags(parameters), *cache, "-o", out)

        return Picture(out, self.keep(label, "render", parameters, run, self._cost(spp, size)))

    def fit(
        self, measurement: Path, model: str = "scattered", tolerance: float = 0.02, lobes: int = 16
    ) -> tuple[Path, dict]:
        """The model and the report of its fit."""
        options = {"model": model, "tolerance": tolerance, "max-lobes": lobes, "seed": self.settings.seed}
        parameters = {"measurement": measurement, **options}
        out = self.stem("fit", parameters).with_suffix(".velour")

        def run(report: Path) -> dict:
            return velour_to_file(report, "fit", measurement, "-o", out, *flags(options))

        label = f"{model} fit of {measurement.stem}, tolerance {tolerance:g}, up to {lobes} lobes"
        return out, self.keep(label, "fit", parameters, run)

    def ggx(self, measurement: Path) -> dict:
        """The report of the comparison with the best GGX lobe."""

        def run(report: Path) -> dict:
            return velour_to_file(report, "compare", measurement, "--ggx")

        return self.keep(f"GGX of {measurement.stem}", "ggx", {"measurement": measurement}, run)

    def keep(
        self,
        label: str,
        name: str,
        parameters: dict,
        run: Callable[[Path], dict],
        cost: float = _START,
    ) -> dict:
        """Returns the kept report, or calls `run`, which must write the report to the given path, last."""
        report = self.stem(name, parameters).with_suffix(".json")
        if report.is_file():
            self.progress.skip(label, cost)
            return json.loads(report.read_text(encoding="utf-8"))
        with self.progress.work(label, cost):
            return run(report)

    def stem(self, name: str, parameters: dict) -> Path:
        """Path of the files that depend on the parameters, without suffix."""
        return self.settings.folder / f"{name}-{key(parameters)}"

    @staticmethod
    def _cost(spp: int, size: tuple[int, int]) -> float:
        return spp * size[0] * size[1] + _START


def read_rgb(path: Path) -> np.ndarray:
    return np.ascontiguousarray(images.read(path)[..., :3])


def key(parameters: dict) -> str:
    """Hash of the parameters (files by content, not by name), the library and the machine."""
    known = {name: _identity(value) for name, value in parameters.items()}
    text = json.dumps([known, _hash(_LIBRARY), machine()], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def flags(parameters: dict) -> list[str]:
    # One word per option: a value may begin with a minus.
    return [f"--{name}={value}" for name, value in parameters.items()]


def _identity(value) -> str:
    return _hash(value) if isinstance(value, Path) else str(value)


def _hash(path: Path) -> str:
    status = path.stat()
    return _hash_of_version(path, status.st_mtime_ns, status.st_size)


@functools.cache
def _hash_of_version(path: Path, modified: int, size: int) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
