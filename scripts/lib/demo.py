"""scripts/demo: measurement, fit, renders in Blender, difference, report; then a BTF."""

from __future__ import annotations

import argparse
import functools
import hashlib
import shutil
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import velour
from bench import blender, charts
from bench.progress import Progress
from bench.project import ROOT
from bench.run import Run, read_rgb
from velour.core import files
from velour.core.machine import machine
from velour.core.warning_table import COMMAND_LINE, sentences
from velour.native import Measurement, VelourError, fit_job, images, library, microsurface_job

OUT = ROOT / "out/demo"
SECONDS = OUT / "seconds.json"  # that the last demo took which made everything; read by scripts/test_times
_SOURCES = (Path(__file__).parent, Path(velour.__file__).parent)


class Part(NamedTuple):
    """Files that are made together."""

    name: str
    title: str
    seconds: float  # that it takes on two cores
    files: tuple[str, ...]  # files and folders that the part leaves in its folder


_PICTURES = tuple(f"{n}.{suffix}" for n in ("model", "reference", "difference") for suffix in ("exr", "png"))
CAPTURE = Part("capture", "capturing the default measurement", 7, ("microsurface.binary",))
_MADE = ("model.velour", *_PICTURES, "error_against_time.png")
MATERIAL = Part("material", "fitting and rendering the measured material", 42, _MADE)
BTF = Part("btf", "capturing, fitting and rendering the BTF of a weave", 46, ("tile.btf", *_PICTURES))


def keep(run: Run, part: Part, inputs: Mapping[str, Path], make: Callable[[], dict]) -> dict:
    """Returns the report of `make`, which makes the files of the part in run.work. "kept" in it says whether
    they are from an earlier run with the same inputs, scripts, add-on, library and machine."""
    parameters = {**inputs, "part": part, "code": _code()}
    record = run.stem(part.name, parameters).with_suffix(".json")
    if not all((run.work / name).exists() for name in part.files):
        record.unlink(missing_ok=True)
    if not (kept := record.is_file()):
        for other in run.kept.glob(f"{part.name}-*.json"):  # of other inputs, whose files are replaced
            other.unlink()
    return run.keep(part.title, part.name, parameters, make, part.seconds) | {"kept": kept}


@functools.cache
def _code() -> str:
    """The hash of all scripts and of the add-on. Run.keep() adds that of the library."""
    sources = [path for folder in _SOURCES for path in sorted(folder.rglob("*.py"))]
    return hashlib.sha256("".join(map(files.sha256, sources)).encode()).hexdigest()


def main() -> int:
    parser = argparse.ArgumentParser(prog="demo")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--since", type=float, default=time.time(), help=argparse.SUPPRESS)
    parser.add_argument("files", metavar="FILE", nargs="*", type=Path)
    args = parser.parse_args()
    progress, tasks = Progress(rate=1.0), _tasks(args.files)
    for part in [MATERIAL] * len(tasks) + [CAPTURE, BTF] * (not args.files):
        progress.expect(part.seconds)

    @functools.cache
    def run(folder: Path) -> Run:
        return Run("demo", folder, folder, SimpleNamespace(), fresh=args.fresh, progress=progress)

    try:
        default, capture = (None, {}) if args.files else default_measurement(run(OUT))
        for source, folder in tasks:
            _show_material(run(folder), source or default, capture)
        if not args.files:
            _show_btf(run(OUT / "btf"))
    except KeyboardInterrupt:
        return 130
    except (VelourError, OSError, blender.BlenderError) as error:
        print(f"demo: {error}", file=sys.stderr)
        return 1
    seconds = time.time() - args.since
    if not args.files and not progress.kept:
        files.write_json(SECONDS, {"seconds": seconds})
    print(f"        {seconds:.0f} s in all")
    return 0


def _tasks(given: list[Path]) -> list[tuple[Path | None, Path]]:
    """Pairs of measurement (None: the default one) and output folder."""
    if len(given) < 2:
        return [(given[0] if given else None, OUT)]
    folders = [OUT / path.stem for path in given]
    if len(set(folders)) < len(folders):
        folders = [OUT / f"{number}-{path.stem}" for number, path in enumerate(given, 1)]
    return list(zip(given, folders, strict=True))


def default_measurement(run: Run) -> tuple[Path, dict]:
    """A rough metal under a virtual goniometer; and what its capture took."""
    path = run.work / "microsurface.binary"

    def make() -> dict:
        with microsurface_job(path, seed=1) as job:  # the rest are the library's defaults
            return job.run()

    report = keep(run, CAPTURE, {}, make)
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
    model, reference = (read_rgb(folder / f"{name}.exr") for name in ("model", "reference"))
    for name in ("difference.exr", "difference.png"):
        images.write(folder / name, np.ascontiguousarray(np.abs(model - reference)))
    return dict(zip(("rmse", "relmse"), images.compare(model, reference), strict=True))


def _show_material(run: Run, measurement: Path, capture: dict) -> None:
    """A model of a measurement, renders of both in Blender, and a plot. `capture`: what measuring took."""
    folder, inputs = run.work, {"measurement": measurement}
    made = keep(run, MATERIAL, inputs, lambda: _make_material(folder, measurement))
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


def _make_material(folder: Path, measurement: Path) -> dict:
    model = folder / "model.velour"
    with Measurement.load(measurement) as source, fit_job(source) as job:
        fit = job.run()
        with job.result_model() as fitted:
            fitted.save(model)
    names = {"model": model, "measurement": measurement, "folder": folder}
    task = {name: str(path.resolve()) for name, path in names.items()}
    rendered = blender.run("demo", task, folder / "blender.log")
    title = "sampling error of the demo's scene at a quarter of its size"
    chart, axes = folder / "error_against_time.png", ("seconds", "relmse against the reference")
    charts.curves(chart, [("", rendered["curves"])], *axes, title=title)
    numbers = {name: fit[name] for name in ("relative_l2", "by_view_angle", "lobes", "bytes")}
    numbers |= {"fit_seconds": fit["seconds"], "render_seconds": rendered["seconds"], **_difference(folder)}
    numbers["samples_per_second"] = rendered["samples_per_second"]
    return {"numbers": numbers, "warnings": sentences(fit["warning_codes"], COMMAND_LINE)}


def _show_btf(run: Run) -> None:
    """A tile, its BTF, a model of it, and two renders in Blender."""
    folder = run.work

    def make() -> dict:
        shutil.rmtree(folder / "tile.btf", ignore_errors=True)  # a capture overwrites nothing
        task = {"folder": str(folder.resolve())}
        return blender.run("demo", task, folder / "blender.log") | _difference(folder)

    report = keep(run, BTF, {}, make)
    sizes = {name: report[f"{name}_bytes"] / 1e6 for name in ("btf", "model")}
    print(f"capture {report['capture_seconds']:.1f} s, {sizes['btf']:.0f} MB")
    print(f"fit     {report['compress_seconds']:.1f} s, {sizes['model']:.2f} MB")
    print(f"render  {report['model_seconds']:.1f} s, relmse {report['relmse']:.2g}")
    _write_report(folder, report)


if __name__ == "__main__":
    sys.exit(main())
