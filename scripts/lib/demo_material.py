"""The demonstration's first part: a model of a measurement, renders of both in Blender, and a plot."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

import headless_blender
import plots
from demo_capture import Capture
from demo_difference import write_difference
from demo_parts import Part, Parts
from steps import Steps
from velour.core import files
from velour.core.machine import machine
from velour.core.warning_table import COMMAND_LINE, sentences
from velour.native import Measurement, fit_job, library

PART = Part(
    "material",
    "the measured material",
    {
        "fitting the model": 1,
        "starting Blender": 2,
        "rendering the measurement": 15,
        "rendering the model": 14,
        "taking error against time": 8,
        "drawing the difference and the plot": 2,
    },
    (
        "model.velour",
        *(f"{name}.{suffix}" for name in ("model", "reference", "difference") for suffix in ("exr", "png")),
        "error_against_time.png",
    ),
)


def demonstrate(folder: Path, capture: Capture, parts: Parts) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    inputs = {"measurement": capture.path}
    made = parts.make(PART, folder, inputs, lambda steps: _make(folder, capture.path, steps))
    report = {
        **made["numbers"],
        "capture_seconds": capture.seconds,
        "cached": capture.cached,
        "kept": made["kept"],
        "version": library.system()["version"],
        "machine": machine(),
    }
    files.write_json(folder / "report.json", report)
    _tell(folder, report, made["warnings"])


def _make(folder: Path, measurement: Path, steps: Steps) -> dict:
    model = folder / "model.velour"
    steps.begin("fitting the model")
    fit = save_fit(measurement, model)
    picture = _render(model, measurement, folder, steps)
    steps.begin("drawing the difference and the plot")
    rmse, relmse = write_difference(folder)
    title = "sampling error of the demo's scene at a quarter of its size"
    plots.error_against_time(folder / "error_against_time.png", picture["curves"], title)
    numbers = {
        "relative_l2": fit["relative_l2"],
        "by_view_angle": fit["by_view_angle"],
        "lobes": fit["lobes"],
        "bytes": fit["bytes"],
        "fit_seconds": fit["seconds"],
        "render_seconds": picture["seconds"],
        "samples_per_second": picture["samples_per_second"],
        "relmse": relmse,
        "rmse": rmse,
    }
    return {"numbers": numbers, "warnings": sentences(fit["warning_codes"], COMMAND_LINE)}


def save_fit(measurement_file: Path, model_file: Path) -> dict:
    """Returns the report of the fit."""
    with Measurement.load(measurement_file) as measurement, fit_job(measurement) as job:
        report = job.run()
        with job.result_model() as model:
            model.save(model_file)
    return report


def _render(model: Path, measurement: Path, folder: Path, steps: Steps) -> dict:
    """Writes pictures of model and measurement; returns the report of demo_scene.py."""
    steps.begin("starting Blender")
    with tempfile.TemporaryDirectory(prefix="velour-demo-") as temporary:
        report = Path(temporary) / "report.json"
        task = {
            "model": str(model.resolve()),
            "measurement": str(measurement.resolve()),
            "folder": str(folder.resolve()),
            "report": str(report),
        }
        headless_blender.run("demo_scene.py", task, folder / "blender.log", hear=steps.hear)
        return json.loads(report.read_text())


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
