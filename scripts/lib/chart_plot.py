"""One plot per scene: both errors against seconds."""

from __future__ import annotations

from pathlib import Path

import plots
from chart_result import DEFAULT, Result


def draw(path: Path, result: Result) -> None:
    curves = {name: list(result.means(name).values()) for name in result.points}
    levels = {"relmse": result.level}
    relmse = {name: [(seconds, error) for seconds, error, _ in points] for name, points in curves.items()}
    rmse = {name: [(seconds, error) for seconds, _, error in points] for name, points in curves.items()}
    title = f"{result.scene.scene.name}; dotted: {DEFAULT} at {result.level_spp} samples a pixel"
    plots.errors_against_time(path, {"relmse": relmse, "rmse": rmse}, title, levels)
