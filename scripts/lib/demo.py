"""scripts/demo: measurement, fit, renders in Blender, difference, report; then a BTF."""

from __future__ import annotations

import argparse
import contextlib
import functools
import hashlib
import json
import shutil
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import velour
from bench import blender, charts, run
from bench.inside import STEP
from bench.progress import Progress
from bench.project import ROOT
from velour.core import files
from velour.core.machine import machine
from velour.core.warning_table import COMMAND_LINE, sentences
from velour.native import Measurement, VelourError, fit_job, images, library, microsurface_job

OUT = ROOT / "out/demo"
_SOURCES = (Path(__file__).parent, Path(velour.__file__).parent)


class Part(NamedTuple):
    """Files that are made together, and made again only if something that they depend on has changed."""

    name: str
    title: str
    steps: Mapping[str, float]  # seconds that each takes on two cores
    files: tuple[str, ...]  # files and folders that the part leaves in its folder


_PICTURES = tuple(f"{n}.{suffix}" for n in ("model", "reference", "difference") for suffix in ("exr", "png"))
_MEASURE, _FIT, _START = "capturing the default measurement", "fitting the model", "starting Blender"
_DRAW, _START_BTF = "drawing the difference and the plot", "starting Blender for a BTF"
_DRAW_BTF = "drawing the BTF's difference"
CAPTURE = Part("capture", "the default measurement", {_MEASURE: 7}, ("microsurface.binary",))
_RENDERS = {"rendering the measurement": 15, "rendering the model": 14, "taking error against time": 8}
MATERIAL = Part(
    "material",
    "the measured material",
    {_FIT: 1, _START: 2, **_RENDERS, _DRAW: 2},
    ("model.velour", *_PICTURES, "error_against_time.png"),
)
_MAKES = {"capturing a tile of weave": 9, "fitting a model to its BTF": 21, "rendering the BTF": 7}
_MAKES["rendering the model of the BTF"] = 6
BTF = Part("btf", "the BTF of a weave", {_START_BTF: 2, **_MAKES, _DRAW_BTF: 1}, ("tile.btf", *_PICTURES))


class Steps(contextlib.ExitStack):
    """Progress of the steps of a part: one ends when the next one begins, the last one with the context."""

    def __init__(self, progress: Progress, costs: Mapping[str, float]):
        super().__init__()
        self._progress, self._costs = progress, costs

    def begin(self, name: str) -> None:
        self.close()
        self.enter_context(self._progress.work(name, self._costs[name]))

    def hear(self, line: str) -> None:
        """Begins the step that a printed line of Blender announces."""
        if line.startswith(STEP):
            self.begin(line.removeprefix(STEP).strip())


class Parts:
    """`fresh`: makes everything again."""

    def __init__(self, progress: Progress, fresh: bool):
        self.progress, self.fresh = progress, fresh

    def expect(self, part: Part) -> None:
        for cost in part.steps.values():
            self.progress.expect(cost)

    def make(
        self, part: Part, folder: Path, inputs: Mapping[str, Path], make: Callable[[Steps], dict]
    ) -> dict:
        """Returns the report of `make`, which makes the files of the part. "kept" in it says whether the
        files are from an earlier run with the same inputs, scripts, add-on, library and machine."""
        record = folder / f"{part.name}.kept.json"
        key = run.key({**inputs, "part": part, "code": _code()})
        if not self.fresh and (report := _report(record, key)) is not None:
            label = f"{part.title}, with the times of the run that made it"
            self.progress.skip(label, sum(part.steps.values()), len(part.steps))
            return {**report, "kept": True}
        record.unlink(missing_ok=True)
        with Steps(self.progress, part.steps) as steps:
            report = make(steps)
        hashes = {name: _hash(folder / name) for name in part.files}
        files.write_json(record, {"key": key, "files": hashes, "report": report})
        return {**report, "kept": False}


def _report(record: Path, key: str) -> dict | None:
    """The recorded report; None if the record has another key, or files are missing or have changed."""
    if not record.is_file():
        return None
    said = json.loads(record.read_text(encoding="utf-8"))
    same = all(_hash(record.with_name(name)) == value for name, value in said["files"].items())
    return said["report"] if same and said["key"] == key else None


def _hash(path: Path) -> str | None:
    """The hash of a file, or of the names and contents of a folder's files; None if there is neither."""
    if path.is_dir():
        contents = [[file.name, files.sha256(file)] for file in sorted(path.iterdir())]
        return hashlib.sha256(json.dumps(contents).encode()).hexdigest()
    return files.sha256(path) if path.is_file() else None


@functools.cache
def _code() -> str:
    """The hash of all scripts and of the add-on. run.key() adds that of the library."""
    sources = [path for folder in _SOURCES for path in sorted(folder.rglob("*.py"))]
    return hashlib.sha256("".join(map(files.sha256, sources)).encode()).hexdigest()


def main() -> int:
    parser = argparse.ArgumentParser(prog="demo")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("files", metavar="FILE", nargs="*", type=Path)
    args = parser.parse_args()
    parts, tasks = Parts(Progress(rate=1.0), args.fresh), _tasks(args.files)
    for part in [MATERIAL] * len(tasks) + [CAPTURE, BTF] * (not args.files):
        parts.expect(part)
    try:
        default, capture = (None, {}) if args.files else default_measurement(parts)
        for source, folder in tasks:
            _show_material(folder, source or default, capture, parts)
        if not args.files:
            _show_btf(OUT / "btf", parts)
    except KeyboardInterrupt:
        return 130
    except (VelourError, OSError, blender.BlenderError) as error:
        print(f"demo: {error}", file=sys.stderr)
        return 1
    return 0


def _tasks(given: list[Path]) -> list[tuple[Path | None, Path]]:
    """Pairs of measurement (None: the default one) and output folder."""
    if len(given) < 2:
        return [(given[0] if given else None, OUT)]
    folders = [OUT / path.stem for path in given]
    if len(set(folders)) < len(folders):
        folders = [OUT / f"{number}-{path.stem}" for number, path in enumerate(given, 1)]
    return list(zip(given, folders, strict=True))


def default_measurement(parts: Parts) -> tuple[Path, dict]:
    """A rough metal under a virtual goniometer; and what its capture took."""
    path = OUT / "microsurface.binary"

    def make(steps: Steps) -> dict:
        steps.begin(_MEASURE)
        with microsurface_job(path, seed=1) as job:  # the rest are the library's defaults
            return job.run()

    OUT.mkdir(parents=True, exist_ok=True)
    report = parts.make(CAPTURE, OUT, {}, make)
    return path, {"capture_seconds": report["seconds"], "cached": report["kept"]}


def _write_report(folder: Path, report: dict) -> None:
    """Writes report.json and tells which pictures were made."""
    report |= {"version": library.system()["version"], "machine": machine()}
    files.write_json(folder / "report.json", report)
    for name in ("model", "reference", "difference"):
        print(f"        {folder / name}.png, .exr")
    print(f"        {folder / 'report.json'}")


def _difference(folder: Path) -> dict:
    """Writes difference.{exr,png} of model.exr and reference.exr."""
    model, reference = (run.read_rgb(folder / f"{name}.exr") for name in ("model", "reference"))
    for name in ("difference.exr", "difference.png"):
        images.write(folder / name, np.ascontiguousarray(np.abs(model - reference)))
    return dict(zip(("rmse", "relmse"), images.compare(model, reference), strict=True))


def _show_material(folder: Path, measurement: Path, capture: dict, parts: Parts) -> None:
    """A model of a measurement, renders of both in Blender, and a plot. `capture`: what measuring took."""
    folder.mkdir(parents=True, exist_ok=True)
    make = lambda steps: _make_material(folder, measurement, steps)  # noqa: E731
    made = parts.make(MATERIAL, folder, {"measurement": measurement}, make)
    report = made["numbers"] | {"capture_seconds": None, "cached": False, **capture, "kept": made["kept"]}
    errors = ", ".join(f"{a} deg {e:.3f}" for a, e in report["by_view_angle"].items() if e is not None)
    print(f"fit     {report['lobes']} lobes, {report['bytes']} bytes, {report['fit_seconds']:.1f} s")
    print(f"        error {errors}")
    for warning in made["warnings"]:
        print(f"        {warning}")
    speed = report["samples_per_second"] / 1e6
    print(f"render  {report['render_seconds']:.1f} s, {speed:.1f} M samples/s, relmse {report['relmse']:.2g}")
    print(f"        {folder / 'error_against_time.png'}")
    _write_report(folder, report)


def _make_material(folder: Path, measurement: Path, steps: Steps) -> dict:
    model = folder / "model.velour"
    steps.begin(_FIT)
    with Measurement.load(measurement) as source, fit_job(source) as job:
        fit = job.run()
        with job.result_model() as fitted:
            fitted.save(model)
    steps.begin(_START)
    names = {"model": model, "measurement": measurement, "folder": folder}
    task = {name: str(path.resolve()) for name, path in names.items()}
    rendered = blender.run("demo", task, folder / "blender.log", hear=steps.hear)
    steps.begin(_DRAW)
    title = "sampling error of the demo's scene at a quarter of its size"
    chart, axes = folder / "error_against_time.png", ("seconds", "relmse against the reference")
    charts.curves(chart, [("", rendered["curves"])], *axes, title=title)
    numbers = {name: fit[name] for name in ("relative_l2", "by_view_angle", "lobes", "bytes")}
    numbers |= {"fit_seconds": fit["seconds"], "render_seconds": rendered["seconds"], **_difference(folder)}
    numbers["samples_per_second"] = rendered["samples_per_second"]
    return {"numbers": numbers, "warnings": sentences(fit["warning_codes"], COMMAND_LINE)}


def _show_btf(folder: Path, parts: Parts) -> None:
    """A tile, its BTF, a model of it, and two renders in Blender."""

    def make(steps: Steps) -> dict:
        shutil.rmtree(folder, ignore_errors=True)  # a capture overwrites nothing
        folder.mkdir(parents=True)
        steps.begin(_START_BTF)
        task, log = {"folder": str(folder.resolve())}, folder / "blender.log"
        found = blender.run("demo", task, log, hear=steps.hear)
        steps.begin(_DRAW_BTF)
        return found | _difference(folder)

    report = parts.make(BTF, folder, {}, make)
    sizes = {name: report[f"{name}_bytes"] / 1e6 for name in ("btf", "model")}
    print(f"capture {report['capture_seconds']:.1f} s, {sizes['btf']:.0f} MB")
    print(f"fit     {report['compress_seconds']:.1f} s, {sizes['model']:.2f} MB")
    print(f"render  {report['model_seconds']:.1f} s, relmse {report['relmse']:.2g}")
    _write_report(folder, report)


if __name__ == "__main__":
    start = time.monotonic()
    status = main()
    if status == 0:
        print(f"        {time.monotonic() - start:.0f} s in all")
    sys.exit(status)
