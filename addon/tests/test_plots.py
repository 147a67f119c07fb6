"""Plots are files that depend on the data alone; the machine has a name."""

from __future__ import annotations

import plots
from velour.core import machine


def test_the_same_data_gives_the_same_picture(tmp_path):
    curves = {"mis": [(0.1, 1.0), (1.0, 0.1)], "cosine": [(0.1, 2.0), (1.0, 0.2)]}
    for name in ("a.png", "b.png"):
        plots.error_against_time(tmp_path / name, curves, "error against time")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_views_that_are_not_covered_are_left_out(tmp_path):
    plots.error_by_view_angle(tmp_path / "c.png", {"wool": {"5": 0.01, "85": None}}, 0.02)
    assert (tmp_path / "c.png").stat().st_size > 1000


def test_errors_can_be_read_off(monkeypatch):
    """Within one decade, too."""
    drawn = []
    monkeypatch.setattr(plots, "save", lambda figure, _: drawn.append(figure))
    plots.error_by_view_angle("c.png", {"wool": {"5": 0.012, "85": 0.12}}, 0.02)
    drawn[0].canvas.draw()
    shown = {label.get_text() for axis in drawn[0].axes for label in axis.get_yticklabels()}
    assert {"0.02", "0.05", "0.1"} <= shown


def test_machine():
    assert "threads" in machine.machine()
    assert machine.threads() >= 1
