"""The nodes of measured materials in Cycles beside Velour's pictures of the measurements."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from velour.native import images

from .. import blender, charts, data_files, flip_metric, page
from ..run import Run, read_rgb
from ..scenes import STUDIO, SUNSET
from .perceptual import flips

CSV = "closures.csv"
SETTINGS = {
    "materials": (99, 1),
    "worlds": ((STUDIO, SUNSET, "potsdamer_platz"), (STUDIO,)),
    "size": (128, 48),
    "samples": (256, 16),
}
SHAPES, KINDS = ("sphere", "Suzanne"), ("measurement", "network", "principled")
_BLOCK = 4  # pixels, over which noise averages out


def measure(run: Run) -> dict:
    rows, sheet = [], []
    for name, measurement in data_files.materials(run.data)[: run.settings.materials]:
        model, _report = run.fit(measurement, "parametric", tolerance=0.02)
        folder = _pictures(run, name, measurement, model)
        rows += _rows(run, name, folder)
        sheet += [_shown(run, name, folder, shape) for shape in SHAPES]
    charts.sheet(run.output / "images/closures.png", sheet, (1.6, 1.6))
    return {"conditions": run.conditions(), "rows": rows}


def _pictures(run: Run, name: str, measurement: Path, model: Path) -> Path:
    """The folder of the pictures of a material, which an earlier run may have made."""
    folder, own = run.kept / name, run.settings
    done = folder / "done"
    if not done.exists():
        folder.mkdir(exist_ok=True)
        worlds = [str(data_files.world(run.data, world)) for world in own.worlds]
        task = {"model": str(model), "measurement": str(measurement), "worlds": worlds, "folder": str(folder)}
        task |= {"size": own.size, "samples": own.samples}
        blender.run("closures", task, folder / "blender.log", ("--addons", "velour"))
        done.touch()
    return folder


def _rows(run: Run, name: str, folder: Path) -> list[dict]:
    rows = []
    for world in run.settings.worlds:
        for shape in SHAPES:
            stem = f"{data_files.world(run.data, world).name}-{shape}"
            reference, *others, where = _read(folder, stem)
            row = {"material": name, "world": world, "shape": shape}
            for kind, picture in zip(KINDS[1:], others, strict=True):
                row |= {
                    f"{kind}_{key}": value for key, value in _differences(reference, picture, where).items()
                }
            rows.append(row)
    return rows


def _shown(run: Run, name: str, folder: Path, shape: str) -> list:
    """The pictures under the first world, with titles."""
    *pictures, where = _read(folder, f"{data_files.world(run.data, run.settings.worlds[0]).name}-{shape}")
    scale = flip_metric.exposure(pictures[0], where)
    return [(f"{name}, {kind}", charts.display(scale * p)) for kind, p in zip(KINDS, pictures, strict=True)]


def _read(folder: Path, stem: str) -> list[np.ndarray]:
    """The pictures of KINDS, and which pixels show the object."""
    pictures = [read_rgb(folder / f"{stem}-{kind}.exr") for kind in KINDS]
    return [*pictures, images.read(folder / f"{stem}-{KINDS[0]}.exr")[..., 3] > 0.999]


def _differences(reference: np.ndarray, picture: np.ndarray, where: np.ndarray) -> dict:
    """Mean color over the reference's, relative L2 of blocks, and mean FLIP, over pixels of the object."""
    mean = picture[where].mean(0) / reference[where].mean(0)
    blocks = [_blocks(each * where[..., None]) for each in (picture, reference)]
    error = np.sqrt(np.square(blocks[0] - blocks[1]).sum() / np.square(blocks[1]).sum())
    found = dict(zip(("red", "green", "blue"), map(float, mean), strict=True))
    return found | {"l2": float(error), "flip": flips(reference, picture, where)[0]}


def _blocks(picture: np.ndarray) -> np.ndarray:
    side = len(picture) // _BLOCK * _BLOCK
    shape = side // _BLOCK, _BLOCK, side // _BLOCK, _BLOCK, 3
    return picture[:side, :side].reshape(shape).mean((1, 3))


def write(run: Run, found: dict) -> None:
    rows = found["rows"]
    for row in rows:
        row["mean"] = "; ".join(
            " ".join(f"{row[f'{kind}_{c}']:.3f}" for c in ("red", "green", "blue")) for kind in KINDS[1:]
        )
    titles = (
        "material | world | shape | mean of red, green, blue: nodes; Principled | L2: nodes | Principled | "
        "FLIP: nodes | Principled"
    )
    cells = (
        "{material} | {world} | {shape} | {mean} | {network_l2:.3f} | {principled_l2:.3f} | "
        "{network_flip:.3f} | {principled_flip:.3f}"
    )
    parts = {"table": page.table(rows, titles, cells)}
    page.write(run.output, "closures.md", page.text("closures", found["conditions"] | parts))
