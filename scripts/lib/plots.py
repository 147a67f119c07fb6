"""Plots with matplotlib, drawn without a display."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from velour.core import files

# Color of each strategy or model in all plots, distinguishable for the color-blind (Okabe and Ito's palette).
COLORS = {
    "uniform": "#999999",
    "cosine": "#56b4e9",
    "table": "#cc79a7",
    "srbf": "#d55e00",
    "light": "#e69f00",
    "mis": "#009e73",
    "ggx": "#f0e442",
    "mis-ggx": "#0072b2",
    "product": "#000000",
    "dissertation": "#a6761d",
    "mis-dissertation": "#882255",
    "scattered": "#d55e00",
    "parametric": "#0072b2",
    "principled": "#009e73",
    "svd": "#999999",
    "svd-view": "#56b4e9",
    "tucker": "#f0e442",
    "cta": "#e69f00",
    "kcta": "#009e73",
    "kcta 2": "#cc79a7",
    "kcta 3": "#0072b2",
    "kcta 4": "#000000",
}


def error_against_time(
    path: str | os.PathLike, curves: Mapping[str, Sequence[tuple[float, float]]], title: str
) -> None:
    """One curve per strategy: (seconds of tracing and shading, relmse), both axes logarithmic."""
    errors_against_time(path, {"relmse": curves}, title)


def errors_against_time(
    path: str | os.PathLike,
    curves: Mapping[str, Mapping[str, Sequence[tuple[float, float]]]],
    title: str,
    levels: Mapping[str, float] | None = None,
) -> None:
    """error_against_time() for several errors, side by side. `levels`: errors marked by a dotted line."""
    figure, axes = _figure(len(curves))
    for cell, (error, own) in zip(axes, curves.items(), strict=True):
        for name, points in own.items():
            usable = np.reshape([point for point in points if min(point) > 0], (-1, 2))
            line = "o--" if name not in COLORS else "o-"
            color = COLORS.get(name.split(",")[0])
            cell.loglog(*usable.T, line, color=color, label=name, markersize=4)
        if levels and error in levels:
            cell.axhline(levels[error], color="black", linewidth=0.8, linestyle=":")
        cell.set(xlabel="seconds", ylabel=f"{error} against the reference")
    # Beside the axes, where the legend hides no points.
    axes[-1].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="small")
    figure.suptitle(title, fontsize="medium")
    save(figure, path)


def error_by_view_angle(
    path: str | os.PathLike, curves: Mapping[str, Mapping[str, float | None]], tolerance: float
) -> None:
    """One curve per material: relative L2 at the held-out views; omits views that are not covered."""
    figure, (axes,) = _figure()
    for name, errors in curves.items():
        points = [(int(angle), error) for angle, error in errors.items() if error is not None]
        angles, values = zip(*points, strict=True)
        axes.semilogy(angles, values, "o-", label=name)
    axes.axhline(tolerance, color="black", linewidth=0.8, linestyle=":", label=f"tolerance {tolerance:g}")
    axes.set(xlabel="view angle, degrees", ylabel="relative L2")
    _label_errors(axes.yaxis)
    axes.legend()
    save(figure, path)


def errors_by_size(
    path: str | os.PathLike,
    panels: Mapping[str, Mapping[str, Sequence[tuple[float, float]]]],
    size: str,
    tolerance: float,
) -> None:
    """One panel per material, one curve per model: (size, relative L2)."""
    curves_by_panel(path, panels, (size, "relative L2"), [tolerance])


def curves_by_panel(
    path: str | os.PathLike,
    panels: Mapping[str, Mapping[str, Sequence[tuple[float, float]]]],
    axes_names: tuple[str, str],
    levels: Sequence[float],
) -> None:
    """Panels, four per row, both axes logarithmic. `levels`: dotted lines across all panels."""
    columns = min(4, len(panels))
    rows = -(-len(panels) // columns)
    figure, axes = _pyplot().subplots(
        rows,
        columns,
        figsize=(3.6 * columns, 3.0 * rows),
        squeeze=False,
        sharex=True,
        sharey=True,
        layout="constrained",
    )
    for cell, (name, curves) in zip(axes.flat, panels.items(), strict=False):
        for curve, points in curves.items():
            usable = np.reshape(points, (-1, 2)).T
            cell.loglog(*usable, "o-", color=COLORS.get(curve), label=curve, markersize=4)
        for level in levels:
            cell.axhline(level, color="black", linewidth=0.8, linestyle=":")
        cell.set_title(name, fontsize="small")
        cell.grid(which="both", alpha=0.25)
    for cell in axes.flat[len(panels) :]:
        cell.set_axis_off()
    axes.flat[0].legend(fontsize="small")
    figure.supxlabel(axes_names[0])
    figure.supylabel(axes_names[1])
    save(figure, path)


def grid(
    path: str | os.PathLike,
    panels: Mapping[tuple[str, str], Mapping[str, Sequence[tuple[float, float]]]],
    x_name: str,
) -> None:
    """Panels by (row, column) name: rows are the plotted values, columns their subjects. x is logarithmic."""
    rows = list(dict.fromkeys(row for row, _ in panels))
    columns = list(dict.fromkeys(column for _, column in panels))
    figure, axes = _pyplot().subplots(
        len(rows),
        len(columns),
        figsize=(3.2 * len(columns) + 1, 2.7 * len(rows)),
        squeeze=False,
        sharex=True,
        layout="constrained",
    )
    for (row, column), curves in panels.items():
        cell = axes[rows.index(row), columns.index(column)]
        for curve, points in curves.items():
            if points:
                cell.plot(*np.transpose(points), "o-", color=COLORS.get(curve), label=curve, markersize=4)
        cell.set(
            xscale="log", title=column if row == rows[0] else "", ylabel=row if column == columns[0] else ""
        )
        ticks = sorted({x for curve in curves.values() for x, _ in curve})
        cell.set_xticks(ticks, [f"{x:g}" for x in ticks])
        cell.set_xticks([], minor=True)
        cell.grid(alpha=0.25)
    lines = {line.get_label(): line for cell in axes.flat for line in cell.get_lines()}
    axes[0, -1].legend(
        lines.values(), lines.keys(), loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="small"
    )
    figure.supxlabel(x_name)
    save(figure, path)


def sheet(rows: int, columns: int, size: tuple[float, float]):
    """A figure of `size` inches and its rows x columns of axes for pictures, without frames and ticks."""
    figure, axes = _pyplot().subplots(rows, columns, figsize=size, squeeze=False, layout="constrained")
    for cell in axes.flat:
        cell.set_axis_off()
    return figure, axes


def save(figure, path: str | os.PathLike, dpi: int = 120) -> None:
    # Without this metadata, the same data gives the same file.
    files.write_atomic(Path(path), lambda name: figure.savefig(name, dpi=dpi, metadata={"Software": None}))
    _pyplot().close(figure)


def _figure(columns: int = 1):
    figure, axes = _pyplot().subplots(
        1, columns, figsize=(6.4 * columns, 4.0), squeeze=False, layout="constrained"
    )
    for cell in axes.flat:
        cell.grid(which="both", alpha=0.25)
    return figure, list(axes.flat)


def _label_errors(axis) -> None:
    """Labels 1, 2 and 5 of each decade: powers of ten alone may give a single label."""
    from matplotlib import ticker

    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(ticker.FuncFormatter(lambda error, _: f"{error:g}"))
    axis.set_minor_formatter(ticker.NullFormatter())


def _pyplot():
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    return pyplot
