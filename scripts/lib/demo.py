"""The demonstration: measurement, fit, picture through Blender, difference, report; then a BTF; or shells."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import demo_blender
import demo_btf
import demo_capture
import demo_votf
import headless_blender
import plots
from demo_difference import write_difference
from velour.core import files
from velour.core.machine import machine
from velour.native import Measurement, VelourError, fit_job, library

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "out/demo"


def main() -> int:
    args = _parser().parse_args()
    try:
        for source, folder in _tasks(args):
            folder.mkdir(parents=True, exist_ok=True)
            if args.votf:
                _demonstrate_votf(source, folder / "votf", args.fresh)
            else:
                demonstrate(source, folder, args.fresh)
        if not args.files and not args.votf:
            demo_btf.demonstrate(OUT / "btf")
    except KeyboardInterrupt:
        return 130
    except (VelourError, OSError, headless_blender.BlenderError) as error:
        print(f"demo: {error}", file=sys.stderr)
        return 1
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="demo")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--votf", action="store_true")
    parser.add_argument("files", metavar="FILE", nargs="*", type=Path)
    return parser


def _tasks(args: argparse.Namespace) -> list[tuple[Path | None, Path]]:
    """Pairs of measurement (None: the default one) and output folder."""
    if len(args.files) < 2:
        return [(args.files[0] if args.files else None, OUT)]
    folders = [OUT / path.stem for path in args.files]
    if len(set(folders)) < len(folders):
        folders = [OUT / f"{number}-{path.stem}" for number, path in enumerate(args.files, 1)]
    return list(zip(args.files, folders, strict=True))


def demonstrate(source: Path | None, folder: Path, fresh: bool) -> None:
    if source is None:
        capture = demo_capture.default_measurement(fresh)
        measurement_file = capture.path
    else:
        capture, measurement_file = demo_capture.Capture(source, None, False), source
    with Measurement.load(measurement_file) as measurement:
        model_file = folder / "model.velour"
        fit = _fit(measurement, model_file)
    picture = demo_blender.render(model_file, measurement_file, folder)
    rmse, relmse = write_difference(folder)
    title = "sampling error of the demo's scene at a quarter of its size"
    plots.error_against_time(folder / "error_against_time.png", picture["curves"], title)
    report = {
        "relative_l2": fit["relative_l2"],
        "by_view_angle": fit["by_view_angle"],
        "lobes": fit["lobes"],
        "bytes": fit["bytes"],
        "fit_seconds": fit["seconds"],
        "render_seconds": picture["seconds"],
        "samples_per_second": picture["samples_per_second"],
        "relmse": relmse,
        "rmse": rmse,
        "capture_seconds": capture.seconds,
        "cached": capture.cached,
        "version": library.system()["version"],
        "machine": machine(),
    }
    files.write_json(folder / "report.json", report)
    _tell(folder, report, fit["warnings"])


def _demonstrate_votf(source: Path | None, folder: Path, fresh: bool) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    metal = folder / "metal.velour"
    with Measurement.load(source or demo_capture.default_measurement(fresh).path) as measurement:
        _fit(measurement, metal)
    demo_votf.demonstrate(folder, metal)


def _fit(measurement: Measurement, path: Path) -> dict:
    with fit_job(measurement) as job:
        report = job.run()
        with job.result_model() as model:
            model.save(path)
    return report


def _tell(folder: Path, report: dict, warnings: list[str]) -> None:
    errors = ", ".join(f"{a} deg {e:.3f}" for a, e in report["by_view_angle"].items() if e is not None)
    print(f"fit     {report['lobes']} lobes, {report['bytes']} bytes, {report['fit_seconds']:.1f} s")
    print(f"        error {errors}")
    for warning in warnings:
        print(f"        {warning}")
    speed = report["samples_per_second"] / 1e6
    print(f"render  {report['render_seconds']:.1f} s, {speed:.1f} M samples/s, relmse {report['relmse']:.2g}")
    for name in ("model", "reference", "difference"):
        print(f"        {folder / name}.png, .exr")
    print(f"        {folder / 'error_against_time.png'}\n        {folder / 'report.json'}")


if __name__ == "__main__":
    start = time.monotonic()
    status = main()
    if status == 0:
        print(f"        {time.monotonic() - start:.0f} s in all")
    sys.exit(status)
