"""Approximations of textured materials in Cycles, with and without normal maps, beside Velour's renders under
a sun from the side. The table is printed, for docs/results/principled.md.

Tiles are captured and compressed once, into build/normal_maps. --names measures some of the materials.
"""

from __future__ import annotations

from pathlib import Path

from .. import blender, page
from ..run import Run
from ..velour_cli import ROOT, velour_to_file

# Shells with one BRDF and a VOTF, or BTFs: the tile, and the model of its surface.
MODELS = {
    **{f"BTF of {tile}": (tile, None) for tile in ("weave", "gravel", "net")},
    "weave of paint": ("weave", "paint"),
    "net of paint": ("net", "paint"),
    "gravel of paint": ("gravel", "paint"),
    "chain mail of paint": ("chainmail", "paint"),
    "chain mail of brushed metal": ("chainmail", "brushed"),
}
SETTINGS = {"names": (tuple(MODELS), ("weave of paint",)), "texels": (48, 16), "directions": (81, 37)}


def measure(run: Run) -> dict:
    rows = [{"material": name} | _measured(run, _model(run, *MODELS[name])) for name in run.settings.names]
    return {"conditions": run.conditions(), "rows": rows}


def _model(run: Run, tile: str, surface: str | None) -> Path:
    path, report = (run.kept / f"{tile}-{surface or 'btf'}.{suffix}" for suffix in ("velour", "json"))
    if path.exists():
        return path
    if surface:
        material = ROOT / f"blend-tests/scenes/data/{surface}.velour"
        velour_to_file(report, "votf", tile, "--material", material, "-o", path)
        return path
    own, btf = run.settings, run.kept / f"{tile}.btf"
    options = ["--texels", own.texels, "--views", own.directions, "--lights", own.directions, "--samples", 8]
    velour_to_file(report, "capture", tile, *options, "--resume", "-o", btf)
    velour_to_file(report, "compress", btf, "-o", path)
    return path


def _measured(run: Run, model: Path) -> dict:
    return blender.run("normal_maps", {"model": str(model)}, run.work / "blender.log", ("--addons", "velour"))


def write(run: Run, found: dict) -> None:
    for row in found["rows"]:
        row |= {"size": " x ".join(map(str, row["texels"])), "map": "yes" if row["has_map"] else "no"}
        row["pairs"] = " | ".join(map(_pair, (*row["by_angle"], row["judged"])))
    titles = "material | texels | 30° | 60° | 75° | by its own judges | map | seconds: colors | normals"
    cells = "{material} | {size} | {pairs} | {map} | {seconds[colors]:.1f} | {seconds[normals]:.1f}"
    print(page.table(found["rows"], titles, cells), end="")


def _pair(errors: list[float]) -> str:
    """The errors without and with a map."""
    return f"{errors[0]:.2f}, {errors[1]:.2f}" if max(errors) > 0 else "-"
