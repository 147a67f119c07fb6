"""The demonstration's second part: a tile, its BTF, a model of it, two renders in Blender, report."""

from __future__ import annotations

import json
import shutil
import tempfile
from pathlib import Path

import headless_blender
from demo_difference import write_difference
from demo_parts import Part, Parts
from steps import Steps
from velour.core import files
from velour.core.machine import machine
from velour.native import library

_STARTING, _COMPARING = "starting Blender for a BTF", "drawing the BTF's difference"
PART = Part(
    "btf",
    "the BTF of a weave",
    {
        _STARTING: 2,
        "capturing a tile of weave": 9,
        "fitting a model to its BTF": 21,
        "rendering the BTF": 7,
        "rendering the model of the BTF": 6,
        _COMPARING: 1,
    },
    (
        "tile.btf",
        *(f"{name}.{suffix}" for name in ("model", "reference", "difference") for suffix in ("exr", "png")),
    ),
)


def demonstrate(folder: Path, parts: Parts) -> None:
    report = parts.make(PART, folder, {}, lambda steps: _make(folder, steps))
    report |= {"version": library.system()["version"], "machine": machine()}
    files.write_json(folder / "report.json", report)
    _tell(folder, report)


def _make(folder: Path, steps: Steps) -> dict:
    shutil.rmtree(folder, ignore_errors=True)  # a capture overwrites nothing
    folder.mkdir(parents=True)
    steps.begin(_STARTING)
    with tempfile.TemporaryDirectory(prefix="velour-demo-") as temporary:
        taken = Path(temporary) / "report.json"
        task = {"folder": str(folder.resolve()), "report": str(taken)}
        headless_blender.run("demo_btf_scene.py", task, folder / "blender.log", hear=steps.hear)
        report = json.loads(taken.read_text())
    steps.begin(_COMPARING)
    report["rmse"], report["relmse"] = write_difference(folder)
    return report


def _tell(folder: Path, report: dict) -> None:
    sizes = {name: report[f"{name}_bytes"] / 1e6 for name in ("btf", "model")}
    print(f"capture {report['capture_seconds']:.1f} s, {sizes['btf']:.0f} MB")
    print(f"fit     {report['compress_seconds']:.1f} s, {sizes['model']:.2f} MB")
    print(f"render  {report['model_seconds']:.1f} s, relmse {report['relmse']:.2g}")
    for name in ("model", "reference", "difference"):
        print(f"        {folder / name}.png, .exr")
    print(f"        {folder / 'report.json'}")
