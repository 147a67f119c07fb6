"""Plots are files that depend on the data alone; the machine has a name."""

from __future__ import annotations

from bench import charts
from velour.core import machine

CURVES = {"mis": [(0.1, 1.0), (1.0, 0.1)], "cosine": [(0.1, 2.0), (1.0, 0.2)]}


def test_the_same_data_gives_the_same_picture(tmp_path):
    for name in ("a.png", "b.png"):
        charts.curves(tmp_path / name, [("relmse", CURVES)], "seconds", "error")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def _drawn(monkeypatch, *panels, **options):
    figures = []
    monkeypatch.setattr(charts, "save", lambda figure, _: figures.append(figure))
    charts.curves("c.png", panels, "x", options.pop("y", "y"), **options)
    figures[0].canvas.draw()
    return figures[0]


def test_errors_can_be_read_off(monkeypatch):
    """Within one decade, too."""
    panel = ("wool", {"error": [(5, 0.012), (85, 0.12)]})
    figure = _drawn(monkeypatch, panel, log="y", levels=[0.02])
    shown = {label.get_text() for axis in figure.axes for label in axis.get_yticklabels()}
    assert {"0.02", "0.05", "0.1"} <= shown


def test_points_and_levels_stand_where_they_belong(monkeypatch):
    panels = [("relmse", CURVES | {"svd": [(1.0, 0.0), (2.0, 0.5)]}), ("rmse", CURVES)]
    first, second = _drawn(monkeypatch, *panels, levels={"relmse": 0.3}).axes
    assert [len(line.get_xdata()) for line in first.get_lines()] == [2, 2, 1, 2]  # without 0, with the level
    assert len(second.get_lines()) == 2


def test_rows_of_panels_have_their_labels(monkeypatch):
    panels = [(tile, CURVES) for _ in range(2) for tile in ("weave", "net")]
    axes = _drawn(monkeypatch, *panels, y=["PSNR", "picture error"], columns=2, shared=False).axes
    assert [cell.get_ylabel() for cell in axes] == ["PSNR", "", "picture error", ""]
    assert [cell.get_title() for cell in axes] == ["weave", "net", "", ""]


def test_machine():
    assert "threads" in machine.machine()
    assert machine.threads() >= 1
