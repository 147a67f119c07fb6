"""scripts/figures and scripts/chart --quick on the test data: they keep what is done, and go on.

test_campaigns.py has their short tests.
"""

from __future__ import annotations

import csv
import os
import subprocess
import time

import pytest
from campaigns import run_script, script_command, script_environment
from command_line import hear_ctrl_c, undated

pytestmark = pytest.mark.long


def _run(name: str, folder, *more, data) -> str:
    done = run_script(name, folder, *more, data=data)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def _rows(path) -> list[dict]:
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def figures(data_folder, tmp_path_factory):
    folder = tmp_path_factory.mktemp("figures")
    _run("figures", folder, data=data_folder)
    return folder


def test_figures_are_written(figures):
    page = (figures / "out/figures/README.md").read_text()
    assert "contact_sheet.png" in page
    assert "commit" in page
    assert (figures / "out/figures/contact_sheet.png").stat().st_size > 10000
    pictures = [row for row in _rows(figures / "out/figures/figures.csv") if row["what"] == "picture"]
    assert {row["figure"].split()[0] for row in pictures} >= {"7.11", "7.12"}
    assert all(0 < float(row["relmse"]) < 1 for row in pictures)
    for number in ("7.11", "7.12"):
        assert (figures / f"reference-{number}-standard-error.exr").is_file()


def test_figures_are_not_rendered_twice(figures, data_folder):
    before = undated((figures / "out/figures/README.md").read_text())
    start = time.monotonic()
    said = _run("figures", figures, data=data_folder)
    assert all("kept" in line for line in said.splitlines() if line.startswith("["))
    assert time.monotonic() - start < 30
    assert undated((figures / "out/figures/README.md").read_text()) == before


def test_a_run_that_is_stopped_leaves_whole_files_and_goes_on(data_folder, tmp_path):
    import signal

    env = script_environment(data_folder)
    # A group of its own: Ctrl-C reaches the script and the render.
    process = subprocess.Popen(
        script_command("figures", tmp_path),
        env=env,
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=hear_ctrl_c,
    )
    for line in process.stdout:
        if "32 spp" in line:
            break
    os.killpg(process.pid, signal.SIGINT)
    process.communicate(timeout=300)
    assert process.returncode == 130
    done = {path.stem for path in (tmp_path / "kept").glob("render-*.json")}
    assert done
    assert all((tmp_path / f"kept/{stem}.exr").is_file() for stem in done)
    assert not list((tmp_path / "kept").glob(".*"))


@pytest.fixture(scope="module")
def chart(data_folder, tmp_path_factory):
    folder = tmp_path_factory.mktemp("chart")
    _run("chart", folder, data=data_folder)
    return folder / "out/chart"


def test_every_scene_has_its_picture_and_points(chart):
    page = (chart / "README.md").read_text()
    rows = [row for row in _rows(chart / "chart.csv") if row["seconds"]]
    scenes = {row["scene"] for row in rows}
    assert len(scenes) >= 3
    assert len(list(chart.glob("*.png"))) == len(scenes)
    for scene in scenes:
        assert f"![{scene}]" in page
        curves = {row["curve"] for row in rows if row["scene"] == scene}
        assert {"uniform", "mis", "mis-dissertation", "mis-ggx", "product"} <= curves


def test_the_page_has_its_tables_and_the_targets(chart):
    page = (chart / "README.md").read_text()
    for heading in (
        "Targets",
        "Equal error",
        "Equal time",
        "Equal samples",
        "Mitsuba",
        "Cycles",
        "The small sun",
    ):
        assert f"\n## {heading}\n" in page
    assert "of `uniform` | " in page


def test_the_sun_survives_the_mixture(chart):
    import re

    page = (chart / "README.md").read_text()
    keeps = r"keeps\s+(\d+) lobe\(s\) of it, ([\d.]+) degrees across, with ([\d.]+) % of the energy"
    count, across, share = re.search(keeps, page).groups()
    assert int(count) >= 1
    assert 0.4 < float(across) < 0.8
    assert float(share) == pytest.approx(90, abs=2)


@pytest.fixture(scope="module")
def btf_chart(data_folder, tmp_path_factory):
    folder = tmp_path_factory.mktemp("btf_chart")
    _run("btf_chart", folder, "--methods=svd,svd-view", data=data_folder)
    return folder


def test_ways_to_compress_are_compared_at_equal_bytes(btf_chart):
    rows = [row for row in _rows(btf_chart / "out/chart_btf.csv") if row["tile"] == "weave"]
    assert {row["method"] for row in rows} == {"svd", "svd-view"}
    for row in rows:
        assert int(row["bytes"]) * int(row["ratio"]) <= 1.01 * 12 * 12 * 37 * 37 * 6
        assert 0 < float(row["picture"]) < 1
        assert 5 < float(row["psnr_unseen"]) < 60
    assert any(float(row["render_seconds"] or 0) > 0 for row in rows)


def test_the_page_of_btfs_shows_what_was_measured(btf_chart):
    page = (btf_chart / "out/chart_btf.md").read_text()
    for words in ("## Targets", "## weave", "## Costs at 1:20", "`svd-view`", "commit", "seed 1"):
        assert words in page
    for name in ("chart_btf.png", "chart_btf_weave.png"):
        assert f"images/{name}" in page
        assert (btf_chart / "out/images" / name).stat().st_size > 5000


def test_what_was_fitted_is_kept(btf_chart, data_folder):
    said = _run("btf_chart", btf_chart, "--methods=svd,svd-view", data=data_folder)
    assert all("kept" in line for line in said.splitlines() if line.startswith("["))
