"""The compositor's Denoise node on Velour's image and denoising passes: a sheet, and errors."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

import headless_blender
import palette
import plots
from display import display
from velour.native import VelourError, images

ROOT = Path(__file__).resolve().parents[2]
TASK = {"size": (320, 240), "few": 16, "many": 4096}
SHOWN = {"few": f"{TASK['few']} samples", "denoised": "the same, denoised", "many": f"{TASK['many']} samples"}
DETAIL = (slice(96, 176), slice(124, 231))  # rows and columns around an eye
_CELL = 2.3  # width of a picture in inches, at 100 dots per inch


def main() -> int:
    parser = argparse.ArgumentParser(prog="denoise")
    parser.add_argument("--output", type=Path, metavar="FILE", default=ROOT / "docs/guide/images/denoise.png")
    output, work = parser.parse_args().output, ROOT / "out/denoise"
    work.mkdir(parents=True, exist_ok=True)
    try:
        headless_blender.run("denoise_scene.py", {**TASK, "folder": str(work)}, work / "blender.log")
        pictures = {
            name: np.ascontiguousarray(images.read(work / f"{name}.exr")[..., :3])
            for name in ("few", "without", "denoised", "many")
        }
    except (VelourError, OSError, headless_blender.BlenderError) as error:
        print(f"denoise: {error}", file=sys.stderr)
        return 1
    if np.array_equal(pictures["few"], pictures["denoised"]):
        print("denoise: this Blender has no OpenImageDenoise", file=sys.stderr)
        return 1
    _draw(output, pictures)
    for name in ("few", "without", "denoised"):
        print(f"{name}: {_relative(pictures[name], pictures['many']):.4f}")
    print(output)
    return 0


def _relative(picture: np.ndarray, reference: np.ndarray) -> float:
    """Root of the library's relmse: the relative error, in dark parts relative to a tenth of the mean."""
    return images.compare(picture, reference)[1] ** 0.5


def _draw(path: Path, pictures: dict[str, np.ndarray]) -> None:
    figure, axes = plots.sheet(2, 3, (3 * _CELL, 1.6 * _CELL))
    for column, (name, title) in enumerate(SHOWN.items()):
        shown = display(pictures[name])
        for axis, pixels in ((axes[0, column], shown), (axes[1, column], shown[DETAIL])):
            axis.imshow(pixels, interpolation="nearest")
            axis.set_axis_off()
        axes[0, column].set_title(title, fontsize=9)
    palette.save(figure, path)


if __name__ == "__main__":
    sys.exit(main())
