"""The measuring scripts on made-up data: their pages are written, what is done is kept, and they go on."""

from __future__ import annotations

from dataclasses import replace

import btf_chart
import chart
import figures
import flip_metric
import for_scene
import headless_blender
import inputs
import models
import perceptual
import plots
import provenance
import pytest
import uniform_moments
from campaigns import Campaign, made_up_data, only_kept, run_script
from mitsuba_runs import Mitsuba


@pytest.fixture(scope="module")
def folders(tmp_path_factory, measurement_file):
    """The folders of the data and of kept results: the scripts share fits."""
    folder = tmp_path_factory.mktemp("campaigns")
    return made_up_data(folder / "data", measurement_file), folder / "work"


@pytest.fixture
def campaign(folders, tmp_path, monkeypatch):
    """Without Blender and Mitsuba, which have their place in the long tests."""

    def absent(*_arguments):
        raise headless_blender.BlenderError("no Blender")

    monkeypatch.setattr(headless_blender, "run", absent)
    monkeypatch.setattr(Mitsuba, "installed", lambda _self: False)
    data, work = folders
    return Campaign(work, tmp_path / "out", data, monkeypatch)


def _less(monkeypatch, module, **values):
    """Makes --quick quicker."""
    monkeypatch.setattr(module, "QUICK", replace(module.QUICK, **values))


def _kept(campaign, module, capsys, *options) -> bool:
    """Whether a second run makes nothing again; its plots are not drawn."""
    capsys.readouterr()
    campaign.patch.setattr(plots, "save", lambda *_arguments, **_options: None)
    assert campaign.run(module, *options) == 0
    return only_kept(capsys.readouterr().out)


@pytest.mark.parametrize("name", ["figures", "chart", "btf_chart", "models", "perceptual", "for_scene"])
def test_without_data_a_sentence(name, tmp_path):
    done = run_script(name, tmp_path, data=tmp_path / "none")
    assert done.returncode == 0, done.stderr
    assert "there is no test data" in done.stdout


def test_figures(campaign, monkeypatch, capsys):
    small = {"size": (16, 12), "batch_spp": 16, "check_size": (8, 6), "uniform_spp": 500, "floor_spp": 8}
    _less(monkeypatch, figures, **small)
    assert campaign.run(figures) == 0
    assert "Suzanne is left out: no Blender" in capsys.readouterr().out
    page = campaign.page("README.md")
    assert "contact_sheet.png" in page
    assert (campaign.output / "contact_sheet.png").stat().st_size > 5000
    rows = [row for row in campaign.rows("figures.csv") if row["what"] == "picture"]
    assert {row["figure"] for row in rows} == {"7.11", "7.12"}
    assert all(0 < float(row["relmse"]) < 1 for row in rows)
    if uniform_moments.built():
        assert "| 7.11 " in campaign.page("check.md")
    assert _kept(campaign, figures, capsys)
    assert campaign.page("README.md") == page


def test_chart(campaign, monkeypatch, capsys):
    _less(monkeypatch, chart, size=(16, 12), bound_hits=2)
    assert campaign.run(chart) == 0
    page = campaign.page("README.md")
    for heading in ("Targets", "Equal error", "Equal time", "Equal samples", "Mitsuba", "Cycles"):
        assert f"\n## {heading}\n" in page
    assert "Mitsuba is left out" in page
    tables = [
        path for path in campaign.output.glob("*.csv") if path.name not in ("targets.csv", "mitsuba.csv")
    ]
    assert len(tables) == 3
    for table in tables:
        assert f"({table.with_suffix('.png').name})" in page
        assert table.with_suffix(".png").stat().st_size > 5000
        curves = {row["curve"] for row in campaign.rows(table.name)}
        assert curves >= {"uniform", "mis", "mis-dissertation", "mis-ggx", "product"}
    targets = campaign.rows("targets.csv")
    assert {row["met"] for row in targets} <= {"True", "False", ""}
    assert any("uniform" in row["target"] for row in targets)
    assert _kept(campaign, chart, capsys)


def test_btf_chart(campaign, monkeypatch, capsys, tmp_path):
    monkeypatch.chdir(tmp_path)
    inputs.write_ribs(tmp_path / "ribs.obj")
    small = {"tiles": ("ribs.obj",), "texels": 8, "directions": 16, "held_out": 4, "size": (16, 12), "spp": 8}
    _less(monkeypatch, btf_chart, **small, speed_size=(12, 9), speed_reference=16)
    assert campaign.run(btf_chart, "--methods=svd") == 0
    rows = campaign.rows("chart_btf.csv")
    assert {(row["tile"], row["method"], row["ratio"]) for row in rows if row["ratio"]} == {
        ("ribs.obj", "svd", "10"),
        ("ribs.obj", "svd", "20"),
    }
    page = campaign.page("chart_btf.md")
    for words in ("## Targets", "## ribs.obj", "## Costs at 1:20", "commit", "seed 1"):
        assert words in page
    assert _kept(campaign, btf_chart, capsys, "--methods=svd")
    campaign.run(btf_chart, "--methods=svd", "--ratios=5", "--add")
    assert "Its rows were added to those of" in campaign.page("chart_btf.md")
    assert {row["ratio"] for row in campaign.rows("chart_btf.csv") if row["ratio"]} == {"5", "10", "20"}


def test_models(campaign, monkeypatch, capsys):
    monkeypatch.setattr(provenance, "busy_threads", lambda: 0.0)  # looks for two seconds
    _less(monkeypatch, models, lobes=(1,), bytes=(2000,))
    assert campaign.run(models) == 0
    page = campaign.page("models.md")
    assert "| blue-metallic-paint | principled |" in page
    for picture in ("error_by_lobes", "error_by_bytes"):
        assert (campaign.output / f"models/{picture}.png").stat().st_size > 5000
    assert _kept(campaign, models, capsys)
    assert campaign.page("models.md") == page


def test_perceptual(campaign, monkeypatch, capsys):
    try:
        flip_metric._flip()
    except flip_metric.NoFlipError as absent:
        pytest.skip(str(absent))
    _less(monkeypatch, perceptual, size=(16, 12))
    assert campaign.run(perceptual) == 0
    assert "(perceptual/flip_by_error.png)" in campaign.page("perceptual.md")
    rows = [row for row in campaign.rows("perceptual/perceptual.csv") if row["flip_mean"]]
    assert {row["scene"] for row in rows} == {"sphere, venice_sunset", "bunny, venice_sunset"}
    assert {row["max_lobes"] for row in rows} == {"16", "2"}
    assert _kept(campaign, perceptual, capsys)


def test_for_scene(campaign, monkeypatch, capsys):
    _less(monkeypatch, for_scene, spp=8)
    assert campaign.run(for_scene) == 0
    assert "moved camera" in campaign.page("for_scene.md")
    assert "blue-metallic-paint" in {row["material"] for row in campaign.rows("for_scene.csv")}
    assert _kept(campaign, for_scene, capsys)
