"""The nodes of measured materials in Cycles beside Velour's pictures of the measurements."""

from __future__ import annotations

import statistics
from pathlib import Path

import numpy as np
from velour.native import images

from .. import blender, charts, flip_metric
from ..run import Run, read_rgb
from ..scenes import STUDIO, SUNSET

CSV = "closures.csv"
SETTINGS = {
    "materials": (99, 1),
    "worlds": ((STUDIO, SUNSET, "potsdamer_platz"), (STUDIO,)),
    "size": (128, 48),
    "samples": (256, 16),
}
PAGES = {"closures.md": "closures"}
SHAPES, KINDS = ("sphere", "Suzanne"), ("measurement", "network", "principled")
_BLOCK = 4  # pixels, over which noise averages out


def measure(run: Run) -> dict:
    rows, sheet = [], []
    for name, measurement in run.materials():
        model, _report = run.fit(measurement, "parametric", tolerance=0.02)
        stem = _pictures(run, name, measurement, model)
        for world in run.settings.worlds:
            shown = []
            for shape in SHAPES:
                reference, *others, where = _read(stem, f"{run.world(world).name}-{shape}")
                row = {"material": name, "world": world, "shape": shape}
                for kind, picture in zip(KINDS[1:], others, strict=True):
                    found = differences(reference, picture, where)
                    row |= {f"{kind}_{key}": value for key, value in found.items()}
                rows.append(row)
                scale, pictures = flip_metric.exposure(reference, where), [reference, *others]
                titles = (name, "nodes", "Principled")
                shown += zip(titles, (charts.display(scale * p) for p in pictures), strict=True)
            if world == run.settings.worlds[0]:
                sheet.append(shown)
    charts.sheet(run.output / "images/closures.png", sheet, (1.6, 1.6))
    return {"conditions": run.conditions(), "rows": rows}


def _pictures(run: Run, name: str, measurement: Path, model: Path) -> Path:
    """The folder of the pictures of a material, which an earlier run may have made."""
    own, parameters = run.settings, {"model": model, "measurement": measurement, **vars(run.settings)}
    folder = run.stem("closures", parameters)
    task = {"model": str(model), "measurement": str(measurement), "folder": str(folder)}
    task |= {"worlds": [str(run.world(world)) for world in own.worlds]}
    task |= {"size": own.size, "samples": own.samples}

    def make() -> dict:
        folder.mkdir(exist_ok=True)
        return blender.run("closures", task, folder / "blender.log", ("--addons", "velour"))

    run.keep(f"pictures of {name}", "closures", parameters, make)
    return folder


def _read(folder: Path, stem: str) -> list[np.ndarray]:
    """The pictures of KINDS, and which pixels show the object."""
    pictures = [read_rgb(folder / f"{stem}-{kind}.exr") for kind in KINDS]
    return [*pictures, covered(folder / f"{stem}-{KINDS[0]}.exr")]


def covered(file: Path) -> np.ndarray:
    """Which pixels show nothing but the object."""
    return images.read(file)[..., 3] > 0.999


def differences(reference: np.ndarray, picture: np.ndarray, where: np.ndarray) -> dict:
    """Mean color over the reference's, relative L2 of blocks, and mean FLIP, over pixels of the object."""
    mean = picture[where].mean(0) / reference[where].mean(0)
    blocks = [_blocks(each * where[..., None]) for each in (picture, reference)]
    error = np.sqrt(np.square(blocks[0] - blocks[1]).sum() / np.square(blocks[1]).sum())
    found = dict(zip(("red", "green", "blue"), map(float, mean), strict=True))
    return found | {"l2": float(error), "flip": flip_metric.of_object(reference, picture, where)[0]}


def _blocks(picture: np.ndarray) -> np.ndarray:
    side = len(picture) // _BLOCK * _BLOCK
    shape = side // _BLOCK, _BLOCK, side // _BLOCK, _BLOCK, 3
    return picture[:side, :side].reshape(shape).mean((1, 3))


def values(found: dict) -> dict:
    """Medians of each material over its pictures."""
    materials: dict[str, list[dict]] = {}
    for row in found["rows"]:
        materials.setdefault(row["material"], []).append(row)
    worlds = {row["world"] for row in found["rows"]}
    return {
        "world_count": len(worlds),
        "materials": [{"material": name, **_medians(rows)} for name, rows in materials.items()],
    }


def _medians(rows: list[dict]) -> dict:
    names = [name for name in rows[0] if name not in ("material", "world", "shape")]
    return {name: statistics.median(row[name] for row in rows) for name in names}
