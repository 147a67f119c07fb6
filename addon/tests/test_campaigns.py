"""Measured pages on made-up data: they are written, what is done is kept, and a run goes on."""

from __future__ import annotations

import inputs
import pytest
from bench import __main__ as bench
from bench import blender, charts, flip_metric, mitsuba, project
from campaigns import Campaign, made_up_data, only_kept, run_script


@pytest.fixture(scope="module")
def folders(tmp_path_factory, measurement_file):
    """The folders of the data and of kept results: the pages share fits."""
    folder = tmp_path_factory.mktemp("campaigns")
    return made_up_data(folder / "data", measurement_file), folder / "work"


@pytest.fixture
def campaign(folders, tmp_path, monkeypatch):
    """Without Blender and Mitsuba, which have their place in the long tests."""

    def absent(*_arguments):
        raise blender.BlenderError("no Blender")

    monkeypatch.setattr(blender, "run", absent)
    monkeypatch.setattr(mitsuba, "installed", lambda: False)
    monkeypatch.setattr(project, "busy_threads", lambda: 0.0)  # looks for two seconds
    data, work = folders
    return Campaign(work, tmp_path / "out", data, monkeypatch)


def _kept(campaign, name, capsys, *options) -> bool:
    """Whether a second run makes nothing again; its plots are not drawn."""
    capsys.readouterr()
    campaign.patch.setattr(charts, "save", lambda *_arguments, **_options: None)
    assert campaign.run(name, *options) == 0
    return only_kept(capsys.readouterr().out)


@pytest.mark.parametrize("name", ["figures", "chart", "btf_chart", "models", "perceptual", "for_scene"])
def test_without_data_a_sentence(name, tmp_path):
    done = run_script(name, tmp_path, data=tmp_path / "none")
    assert done.returncode == 0, done.stderr
    assert "there is no test data" in done.stdout


def test_figures(campaign, capsys):
    small = ("--size=16x12", "--batch-spp=16", "--floor-spp=8")
    assert campaign.run("figures", *small) == 0
    assert "Suzanne is left out: no Blender" in capsys.readouterr().out
    page = campaign.page("figures/README.md")
    assert "contact_sheet.png" in page
    assert (campaign.output / "figures/contact_sheet.png").stat().st_size > 5000
    rows = [row for row in campaign.rows("figures/figures.csv") if row["what"] == "picture"]
    assert {row["figure"].split()[0] for row in rows} == {"7.11", "7.12"}
    assert all(0 < float(row["relmse"]) < 1 for row in rows)
    assert _kept(campaign, "figures", capsys, *small)
    assert campaign.page("figures/README.md") == page


def test_chart(campaign, capsys):
    small = ("--size=16x12", "--bound-hits=2")
    assert campaign.run("chart", *small) == 0
    page = campaign.page("chart/README.md")
    for heading in ("Targets", "Equal error", "Equal samples", "Mitsuba"):
        assert f"\n## {heading}\n" in page
    assert "Mitsuba is left out" in page
    assert "| seconds of `mis` to equal error at most 1/5 of `uniform` |" in page
    rows = [row for row in campaign.rows("chart/chart.csv") if row["seconds"]]
    scenes = {row["scene"] for row in rows}
    assert len(scenes) == 4
    for scene in scenes:
        curves = {row["curve"] for row in rows if row["scene"] == scene}
        assert curves >= {"uniform", "mis", "mis-ggx", "product", "auto"}
        assert ("mis-dissertation" in curves) == ("default model" not in scene)
        assert f"![{scene}]" in page
    assert all(path.stat().st_size > 5000 for path in (campaign.output / "chart").glob("*.png"))
    assert _kept(campaign, "chart", capsys, *small)


def test_btf_chart(campaign, capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    inputs.write_ribs(tmp_path / "ribs.obj")
    small = ("--tiles=ribs.obj", "--texels=8", "--directions=16", "--held-out=4", "--size=16x12", "--spp=8")
    small += ("--speed-size=12x9", "--speed-reference=16", "--methods=svd")
    assert campaign.run("btf_chart", *small) == 0
    rows = campaign.rows("chart_btf.csv")
    assert {(row["tile"], row["method"], row["ratio"]) for row in rows if row["ratio"]} == {
        ("ribs.obj", "svd", "10"),
        ("ribs.obj", "svd", "20"),
    }
    page = campaign.page("chart_btf.md")
    for words in ("## Targets", "## ribs.obj", "## Costs at 1:20", "commit", "seed 1"):
        assert words in page
    assert _kept(campaign, "btf_chart", capsys, *small)


def test_models(campaign, capsys):
    small = ("--lobes=1", "--bytes=2000")
    assert campaign.run("models", *small) == 0
    page = campaign.page("models.md")
    assert "\n| blue-metallic-paint | " in page
    assert "\n| parametric | " in page
    for picture in ("error_by_lobes", "error_by_bytes"):
        assert (campaign.output / f"models/{picture}.png").stat().st_size > 5000
    assert _kept(campaign, "models", capsys, *small)
    assert campaign.page("models.md") == page


def test_perceptual(campaign, capsys):
    try:
        flip_metric._flip()
    except project.MissingError as absent:
        pytest.skip(str(absent))
    assert campaign.run("perceptual", "--size=16x12") == 0
    assert "(perceptual/flip_by_error.png)" in campaign.page("perceptual.md")
    rows = [row for row in campaign.rows("perceptual/perceptual.csv") if row["flip_mean"]]
    assert {row["scene"] for row in rows} == {"sphere, venice_sunset", "bunny, venice_sunset"}
    assert {row["max_lobes"] for row in rows} == {"16", "2"}
    assert _kept(campaign, "perceptual", capsys, "--size=16x12")


def test_for_scene(campaign, capsys):
    assert campaign.run("for_scene", "--spp=8") == 0
    page = campaign.page("for_scene.md")
    assert "| blue-metallic-paint | " in page
    assert "blue-metallic-paint" in {row["material"] for row in campaign.rows("for_scene.csv")}
    assert _kept(campaign, "for_scene", capsys, "--spp=8")
    # From the kept numbers alone.
    (campaign.output / "for_scene.md").unlink()
    assert campaign.run("for_scene", "--page") == 0
    assert campaign.page("for_scene.md") == page


def test_the_runner_lists_its_pages_and_refuses_others(capsys):
    assert bench.main(["--list"]) == 0
    assert all(f"\n  {name} " in capsys.readouterr().out for name in ["chart"])
    assert bench.main(["unknown"]) == 2
    assert "no page 'unknown'" in capsys.readouterr().err
