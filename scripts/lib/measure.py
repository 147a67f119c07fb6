"""Measures the numbers of docs/results/measurements.md through the command line, as a user would."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import data_files
import measure_text
import plots
import provenance
import script
from table_csv import csv_text
from velour.core import files
from velour_cli import ROOT, velour

WORK = ROOT / "build/measurements"
SEED = 1
THREADS = 2
MATERIAL = "blue-metallic-paint"
TOLERANCE = 0.02
LOBES = (2, 4, 8, 16)
STRATEGIES = ("uniform", "cosine", "table", "srbf", "ggx", "light", "mis", "mis-ggx", "product")
CHARTED = (MATERIAL, "nickel")
WORLDS = ("venice_sunset", "studio_small_03")


def main() -> int:
    data = data_files.folder()
    WORK.mkdir(parents=True, exist_ok=True)
    materials = {name: data_files.merl(data, name) for name in data_files.merl_names(data)}
    worlds = {name: _scene(data, name) for name in WORLDS}
    scene = worlds[WORLDS[0]]
    results = {
        "conditions": provenance.conditions(SEED, THREADS),
        "fits": {name: _fit(path) for name, path in materials.items()},
        "render": _main_render(scene),
        "lobes": _image_error_by_lobes(scene, materials[MATERIAL]),
        "strategies": {f"{m}, {w}": _strategies(worlds[w], m) for m in CHARTED for w in WORLDS},
    }
    files.write_text(ROOT / "docs/results/measurements.md", measure_text.page(results))
    files.write_text(ROOT / "docs/results/measurements.csv", _csv(results))
    errors = {name: fit["by_view_angle"] for name, fit in results["fits"].items()}
    plots.error_by_view_angle(ROOT / "docs/results/images/error_by_view_angle.png", errors, TOLERANCE)
    print(ROOT / "docs/results/measurements.md")
    return 0


def render(scene: list, material: Path, out: str, *options) -> dict:
    common = ["--seed", SEED, "--threads", THREADS, "-o", WORK / out]
    print(f"rendering {out} ...", flush=True)
    return velour("render", *scene, "--material", material, *common, *options)


def _scene(data: Path, world: str) -> list:
    return ["--mesh", data_files.mesh(data, "bunny"), "--world", data_files.world(data, world)]


def _model(name: str, lobes: int) -> Path:
    return WORK / f"{name}-{lobes}.velour"


def _fit(path: Path, lobes: int = LOBES[-1]) -> dict:
    print(f"fitting {path.stem}, {lobes} lobes ...", flush=True)
    options = ["--tolerance", TOLERANCE, "--max-lobes", lobes, "--seed", SEED, "--threads", THREADS]
    return velour("fit", path, "-o", _model(path.stem, lobes), "--model", "scattered", *options)


def _main_render(scene: list) -> dict:
    return render(scene, _model(MATERIAL, LOBES[-1]), "main.exr", "--size", "640x480", "--spp", 800)


def _image_error_by_lobes(scene: list, measurement: Path) -> dict[int, dict]:
    """Model against reference mode with the same light directions: the difference is the model's error."""
    small = ["--size", "320x240", "--spp", 512]
    rows = {}
    for lobes in LOBES:
        fit, model = _fit(measurement, lobes), _model(MATERIAL, lobes)
        reference = render(scene, measurement, f"{lobes}-raw.exr", *small, "--proposal", model)
        against = ["--reference", WORK / f"{lobes}-raw.exr"]
        report = render(scene, model, f"{lobes}-lobes.exr", *small, *against)
        rows[lobes] = {**report, "fit": fit, "reference_seconds": reference["seconds"]}
    return rows


def _strategies(scene: list, material: str) -> dict[str, dict]:
    model, small = _model(material, LOBES[-1]), ["--size", "320x240"]
    render(scene, model, "converged.exr", *small, "--spp", 8192, "--seed", SEED + 1)
    against = ["--reference", WORK / "converged.exr"]
    rows = {}
    for name in STRATEGIES:
        options = ["--spp", 64, "--strategy", name, "--cache", WORK, *against]
        rows[name] = render(scene, model, f"{name}.exr", *small, *options)
    return rows


def _csv(results: dict) -> str:
    rows = [["conditions", "", name, value] for name, value in results["conditions"].items()]
    for what in ("fits", "lobes", "strategies"):
        for case, report in results[what].items():
            rows += [[what, case, *pair] for pair in _flat(report)]
    rows += [["render", MATERIAL, *pair] for pair in _flat(results["render"])]
    return csv_text(["what", "case", "quantity", "value"], rows)


def _flat(report: dict, prefix: str = ""):
    for key, value in report.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{key}.")
        elif not isinstance(value, list):
            yield f"{prefix}{key}", "" if value is None else value


if __name__ == "__main__":
    sys.exit(script.guarded("measure", main, "stopped; nothing is kept."))
