"""The contact sheet: a row per figure, a column per number of samples, the reference last, errors below."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plots
from display import display
from markdown_table import small

_CELL = 2.6  # width of a picture in inches, at 100 dots per inch
_WORST = 0.2  # relative error at which the brightness saturates


def draw(path: Path, figures: list, spp: tuple[int, ...]) -> None:
    height = _CELL * 0.75 + 0.3
    rows, columns = 2 * len(figures), len(spp) + 1
    sheet, axes = plots.sheet(rows, columns, (_CELL * columns, height * rows))
    for row, figure in enumerate(figures):
        _draw_figure(axes[2 * row], axes[2 * row + 1], figure, spp)
    plots.save(sheet, path, dpi=100)


def _draw_figure(above, below, figure, spp: tuple[int, ...]) -> None:
    mean = figure.reference.mean()
    for column, count in enumerate(spp):
        picture = figure.pictures["dissertation", count]
        relmse = {sampler: figure.errors[sampler, count][1] for sampler in ("dissertation", "default")}
        _show(above[column], picture.pixels, f"{figure.subject.name}, {count} spp")
        caption = f"relmse {small(relmse['dissertation'])}; default {small(relmse['default'])}"
        _show_error(below[column], picture.pixels, mean, caption)
    _show(above[-1], mean, f"measured, {figure.reference.spp} spp")
    modelled = mean + figure.differences.mean(axis=0)
    _show_error(below[-1], modelled, mean, f"the fit's: {small(figure.floor[1])}")


def _show(axes, pixels: np.ndarray, title: str) -> None:
    axes.imshow(display(pixels), interpolation="none")
    axes.set_title(title, fontsize=8)


def _show_error(axes, pixels: np.ndarray, reference: np.ndarray, title: str) -> None:
    """Error of the channels' sum, relative to the reference and a tenth of its mean, as in relmse."""
    x, r = pixels.sum(axis=-1), reference.sum(axis=-1)
    error = np.abs(x - r) / np.sqrt(r**2 + 0.01 * r.mean() ** 2)
    axes.imshow(error[::-1], cmap="inferno", vmin=0, vmax=_WORST, interpolation="none")
    axes.set_title(title, fontsize=8)
