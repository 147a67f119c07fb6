"""Charts of curves and sheets of pictures, by matplotlib, drawn without a display."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import numpy as np
from matplotlib import pyplot, ticker
from PIL import Image
from velour.core import files

# Color of each strategy or model in all plots, distinguishable for the color-blind (Okabe and Ito's palette).
_GRAY, _SKY, _PINK, _RED, _ORANGE, _GREEN = "#999999", "#56b4e9", "#cc79a7", "#d55e00", "#e69f00", "#009e73"
_YELLOW, _BLUE, _BLACK = "#f0e442", "#0072b2", "#000000"
COLORS = {"uniform": _GRAY, "cosine": _SKY, "table": _PINK, "srbf": _RED, "light": _ORANGE, "mis": _GREEN}
COLORS |= {"ggx": _YELLOW, "mis-ggx": _BLUE, "product": _BLACK, "auto": _RED}
COLORS |= {"dissertation": "#a6761d", "mis-dissertation": "#882255"}
COLORS |= {"scattered": _RED, "parametric": _BLUE, "principled": _GREEN}
COLORS |= {"svd": _GRAY, "svd-view": _SKY, "tucker": _YELLOW, "cta": _ORANGE, "kcta": _GREEN}
COLORS |= {"kcta 2": _PINK, "kcta 3": _BLUE, "kcta 4": _BLACK}
COLORS |= {"geometry": _BLACK, "BTF": _ORANGE, "BTF + VOTF": _BLUE, "BRDF + VOTF": _GREEN}
_FEW_DECADES = 50  # ratio of an axis's ends below which powers of ten alone are too few labels

Points = Sequence[tuple[float, float]]


def curves(
    path: Path,
    panels: Sequence[tuple[str, Mapping[str, Points]]],
    x: str,
    y: str | Sequence[str],
    *,
    columns: int = 4,
    levels: Mapping[str, float] | Sequence[float] = (),
    log: str = "xy",
    shared: bool = True,
    title: str = "",
) -> None:
    """Panels of a title and curves: name -> points (x, y).

    `y`: the label of the axis, or one per row of panels, whose titles stand on top of the columns then.
    `levels`: dotted lines, in all panels or by title. `log`: the logarithmic axes; points that are not
    positive there are left out. `shared`: all panels have the same axes.
    """
    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    size = (6.4, 4.0) if len(panels) == 1 else (3.6 * columns + 1, 3.0 * rows)
    same = {"sharex": shared or rows > 1, "sharey": shared}
    figure, axes = pyplot.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained", **same)
    for cell in axes.flat[len(panels) :]:
        cell.set_axis_off()
    for place, (cell, (name, own)) in enumerate(zip(axes.flat, panels, strict=False)):
        _draw(cell, own, [levels[name]] if name in levels else [*levels], log)
        if isinstance(y, str) or place < columns:
            cell.set_title(name, fontsize="small")
        if not isinstance(y, str) and place % columns == 0:
            cell.set_ylabel(y[place // columns])
    named = [line for cell in axes.flat for line in cell.get_lines() if line.get_label()[0] != "_"]
    lines = {line.get_label(): line for line in named}
    beside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)}  # where the legend hides no points
    axes[0, -1].legend(lines.values(), lines.keys(), fontsize="small", **beside)
    figure.supxlabel(x)
    figure.supylabel(y if isinstance(y, str) else "")
    figure.suptitle(title, fontsize="medium")
    save(figure, path)


def _draw(cell, own: Mapping[str, Points], levels: Sequence[float], log: str) -> None:
    for curve, points in own.items():
        usable = [(a, b) for a, b in points if (a > 0 or "x" not in log) and (b > 0 or "y" not in log)]
        line, color = "o-" if curve in COLORS else "o--", COLORS.get(curve.split(",")[0])
        cell.plot(*np.reshape(usable, (-1, 2)).T, line, color=color, label=curve, markersize=4)
    for level in levels:
        if not isinstance(level, str):
            cell.axhline(level, color="black", linewidth=0.8, linestyle=":")
    scales = {f"{axis}scale": "log" if axis in log else "linear" for axis in "xy"}
    cell.set(**scales)
    cell.grid(which="both", alpha=0.25)
    for axis, ends in ((cell.xaxis, cell.get_xlim()), (cell.yaxis, cell.get_ylim())):
        if axis.get_scale() == "log" and ends[1] < _FEW_DECADES * ends[0]:
            axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_formatter(ticker.NullFormatter())


def sheet(
    path: Path,
    rows: Sequence[Sequence[tuple[str, np.ndarray]]],
    cell: tuple[float, float],
    few_colors: bool = False,
) -> None:
    """Rows of titles and pictures as displayed, row 0 on top. `cell`: width and height of a picture and its
    title in inches, at 100 dots per inch. `few_colors`: a third of the bytes, for noise and photographs."""
    columns = max(map(len, rows))
    size = (columns * cell[0], len(rows) * cell[1])
    figure, axes = pyplot.subplots(len(rows), columns, figsize=size, squeeze=False, layout="constrained")
    for cell_axes in axes.flat:
        cell_axes.set_axis_off()
    for line, pictures in zip(axes, rows, strict=True):
        for cell_axes, (title, picture) in zip(line, pictures, strict=False):
            cell_axes.imshow(picture, interpolation="antialiased")
            cell_axes.set_title(title, fontsize=8)
    save(figure, path, dpi=100)
    if few_colors:
        with Image.open(path) as drawn:
            picture = drawn.convert("RGB")
        # Without dithering, which would add noise.
        picture.quantize(256, kmeans=1, dither=Image.Dither.NONE).save(path, optimize=True)


def wrapped(cells: Sequence, columns: int) -> list[Sequence]:
    """A sequence as rows of a sheet."""
    return [cells[start : start + columns] for start in range(0, len(cells), columns)]


def display(linear: np.ndarray) -> np.ndarray:
    """Linear Rec. 709 to sRGB [IEC 61966-2-1], clipped, unrounded; flips the rows: row 0 on top."""
    c = np.clip(np.asarray(linear, np.float64)[::-1], 0, 1)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


def colored(values: np.ndarray, colors: str, low: float, high: float) -> np.ndarray:
    """Values as colors of one of matplotlib's maps; flips the rows."""
    return matplotlib.colormaps[colors]((values[::-1] - low) / (high - low))[..., :3]


def save(figure, path: Path, dpi: int = 120) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    # Without this metadata, the same data gives the same file.
    files.write_atomic(path, lambda name: figure.savefig(name, dpi=dpi, metadata={"Software": None}))
    pyplot.close(figure)
