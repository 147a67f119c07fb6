"""Writes docs/results/votf_numbers.md and its pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import palette
import plots
import provenance
from display import display
from markdown_table import table

_BEHIND = 0.25  # background radiance
_CELL = 3.0  # width of a picture in inches, at 100 dots per inch
_TITLES = ("geometry", "smooth", "shell")


def draw(path: Path, sheet: list) -> None:
    """Draws two rows per surface: its three pictures, and a magnified part of each."""
    figure, axes = plots.sheet(2 * len(sheet), 3, (3 * _CELL, 2 * len(sheet) * (_CELL + 0.25)))
    cells = np.reshape(axes, (2 * len(sheet), 3))
    for row, (surface, pictures) in enumerate(sheet):
        for column, (title, pixels) in enumerate(zip(_TITLES, pictures, strict=True)):
            seen = pixels[..., :3] + (1 - pixels[..., 3:]) * _BEHIND
            _show(cells[2 * row, column], seen, f"{title}, {surface}")
            _show(cells[2 * row + 1, column], _edge(seen, pictures[0][..., 3]), "the same, magnified")
    palette.save(figure, path)


def _edge(picture: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """Crops a picture around the rightmost point of the object."""
    side = picture.shape[0] // 5
    column = int(np.flatnonzero(alpha.max(axis=0) > 0.5)[-1])
    row = int(np.median(np.flatnonzero(alpha[:, column] > 0.5)))
    left = np.clip(column - 3 * side // 4, 0, picture.shape[1] - side)
    low = np.clip(row - side // 2, 0, picture.shape[0] - side)
    return picture[low : low + side, left : left + side]


def _show(axes, picture: np.ndarray, title: str) -> None:
    axes.imshow(display(picture), interpolation="none")
    axes.set_title(title, fontsize=8)


def sheet_name(tile: str, look: str) -> str:
    return f"votf_{tile}.png" if look == "BRDF" else f"votf_{tile}_{look.lower()}.png"


def write(folder: Path, rows: list, conditions: dict, extent) -> None:
    of_brdf, of_btf = (
        table(_HEADER, [_row(row) for row in rows if row.look == look]) for look in ("BRDF", "BTF")
    )
    sheets_of_brdf, sheets_of_btf = (
        "\n".join(f"![{name}](images/{sheet_name(name, look)})\n" for name in extent.tiles)
        for look in ("BRDF", "BTF")
    )
    text = f"""# Shells beside real geometry

By `scripts/votf`. {provenance.sentence(conditions)}

Three pictures of each surface under a sun and an even sky: with the tile's geometry all over it (every
vertex at p + height n), smooth, and with the tile's shell ([votf.md](../engine/votf.md)).
The shell is 6 % of the sphere's radius high. Outline: soft intersection over union of alpha (sum of
minima over sum of maxima) with holes filled; alpha: the same with holes; light: root mean square of the
difference where both show the object, over that of the geometry. Pictures are {extent.side} pixels
wide, or as wide as holds the object; {extent.samples} samples a pixel. Seconds are of tracing and
shading, megabytes of the whole scene.

## With the tile's BTF

The geometry has the tile's own materials, the others show its BTF: {extent.texels} x {extent.texels} texels
under 81 x 81 directions, captured and compressed as `velour` does unasked: both sides of the net and the
chain mail.
{_ratios(rows, "BTF")}

{of_btf}
{sheets_of_btf}
## With one BRDF

One BRDF serves all three: what differs is the shape alone. {_ratios(rows, "BRDF")}

{of_brdf}
{sheets_of_brdf}"""
    (folder / "votf_numbers.md").write_text(text, encoding="utf-8")


def _ratios(rows: list, look: str) -> str:
    """Ratio of the render times of the shell and the smooth surface, for each size of tiles."""
    parts = []
    for pixels in dict.fromkeys(row.tile_pixels for row in rows):
        ratios = [r.seconds[2] / r.seconds[1] for r in rows if (r.look, r.tile_pixels) == (look, pixels)]
        parts.append(f"{min(ratios):.1f} to {max(ratios):.1f} times with {pixels} pixels a tile")
    return f"The shell takes as long as the smooth surface {', '.join(parts)}."


_HEADER = [
    "tile",
    "surface",
    "pixels a tile",
    "outline: smooth / shell",
    "alpha: smooth / shell",
    "light: smooth / shell",
    "seconds: geometry / smooth / shell",
    "MB: geometry / smooth / shell",
]


def _row(row) -> list:
    smooth, shell = row.errors
    return [
        row.tile,
        row.surface,
        row.tile_pixels,
        f"{smooth.outline:.3f} / **{shell.outline:.3f}**",
        f"{smooth.alpha:.3f} / **{shell.alpha:.3f}**",
        f"{smooth.light:.2f} / **{shell.light:.2f}**",
        " / ".join(f"{s:.1f}" for s in row.seconds),
        " / ".join(f"{b / 1e6:.1f}" for b in row.bytes),
    ]
