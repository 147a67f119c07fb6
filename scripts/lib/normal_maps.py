"""scripts/normal_maps: approximations in Cycles, with and without normal maps, against Velour's renders."""

from __future__ import annotations

import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import headless_blender
import markdown_table
from velour_cli import ROOT, velour_to_file

FOLDER = ROOT / "build/normal_maps"
DATA = ROOT / "blend-tests/scenes/data"
BTFS = ("weave", "gravel", "net")
# Shells with one BRDF and a VOTF: the tile, and the model of its surface.
SHELLS = {
    "weave of paint": ("weave", "paint"),
    "net of paint": ("net", "paint"),
    "gravel of paint": ("gravel", "paint"),
    "chain mail of paint": ("chainmail", "paint"),
    "chain mail of brushed metal": ("chainmail", "brushed"),
}
TEXELS, DIRECTIONS = 48, 81
HEADER = [
    "material",
    "texels",
    "30°",
    "60°",
    "75°",
    "by its own judges",
    "map",
    "seconds: colors",
    "normals",
]


def main(names: list[str]) -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    models = {f"BTF of {tile}": (tile, None) for tile in BTFS} | SHELLS
    rows = [_row(name, _model(*models[name])) for name in names or models]
    print(markdown_table.table(HEADER, rows), end="")


def _model(tile: str, surface: str | None) -> Path:
    path = FOLDER / f"{tile}-{surface or 'btf'}.velour"
    if path.exists():
        return path
    report = path.with_suffix(".json")
    if surface:
        velour_to_file(report, "votf", tile, "--material", DATA / f"{surface}.velour", "-o", path)
        return path
    btf, angles = FOLDER / f"{tile}.btf", ("--views", DIRECTIONS, "--lights", DIRECTIONS)
    velour_to_file(
        report, "capture", tile, "--texels", TEXELS, *angles, "--samples", 8, "--resume", "-o", btf
    )
    velour_to_file(report, "compress", btf, "-o", path)
    return path


def _row(name: str, model: Path) -> list:
    report = FOLDER / "report.json"
    task = {"model": str(model), "report": str(report)}
    headless_blender.run("normal_maps_inside.py", task, FOLDER / "blender.log", ["--addons", "velour"])
    found = json.loads(report.read_text())
    return [
        name,
        " x ".join(map(str, found["texels"])),
        *(_pair(errors) for errors in (*found["by_angle"], found["judged"])),
        "yes" if found["has_map"] else "no",
        *(f"{found['seconds'][step]:.1f}" for step in ("colors", "normals")),
    ]


def _pair(errors: list[float]) -> str:
    """The errors without and with a map."""
    return f"{errors[0]:.2f}, {errors[1]:.2f}" if max(errors) > 0 else "-"


if __name__ == "__main__":
    main(sys.argv[1:])
