"""scripts/models: its own pieces against what is known, and a small run on the test data."""

from __future__ import annotations

import csv
import re

import models_tables
import models_text
import pytest
from campaigns import only_kept, run_script
from command_line import undated
from conftest import ROOT
from generated import replaced
from model_runs import Result, Row
from models_targets import ANGLES, NO_NOISE, meets, met, target

PAGE = "above\n<!-- fit: written by scripts/models -->\nold\n<!-- end of fit -->\nbelow\n"


def test_a_part_is_replaced_between_its_markers():
    once = replaced(PAGE, "fit", "new\n")
    assert once == PAGE.replace("old", "new")
    assert replaced(once, "fit", "new\n") == once


@pytest.mark.parametrize("page", ["", PAGE + PAGE, PAGE.replace("end of fit", "end")])
def test_a_page_without_its_two_markers_is_refused(page):
    with pytest.raises(ValueError, match="'fit'"):
        replaced(page, "fit", "new")


def test_every_generated_page_has_its_part():
    for name in ("models", "fit", "ggx", "principled"):
        replaced((ROOT / f"docs/results/{name}.md").read_text(encoding="utf-8"), name, "")


def test_targets():
    assert [target(angle, None) for angle in ANGLES] == [0.02, 0.02, 0.02, 0.02, 0.04]
    assert target("75", 0.05) == 0.05
    assert target("85", 0.03) == 0.04
    assert meets("5", 0.02, NO_NOISE)
    assert not meets("5", 0.0201, NO_NOISE)
    errors = dict(zip(ANGLES, (0.01, 0.03, 0.03, 0.02, None), strict=True))
    assert met(errors, NO_NOISE) == 2
    assert met(errors, {**NO_NOISE, "30": 0.04}) == 3


def _result(name: str, seconds: float) -> Result:
    errors = dict(zip(ANGLES, (0.01, 0.02, 0.03, 0.04, None), strict=True))
    common = {"relative_l2": 0.02, "by_view_angle": errors, "parameter_bytes": 44, "seconds": seconds}
    fit = {**common, "bytes": 4000, "lobes": 7}
    cost = dict(zip(models_tables.COSTS, (50.0, 100.0, 10.0, 20.0), strict=True))
    values = {"base_color": [0.1, 0.2, 0.3], "metallic": 1.0}
    rows = {
        "scattered": Row(fit, cost, {"views": 47}),
        "ggx": Row({**common, "ggx": {"alpha": [0.25, 0.25]}}, cost, {}),
        "principled": Row({**common, "principled": values}, cost, {}),
    }
    curves = {"scattered": {4: fit}}
    noise = {**NO_NOISE, "60": 0.05}
    return Result(name, 35_000_000, noise, {"f": 40.0, "f_16": 30.0}, rows, curves, curves, fit)


@pytest.fixture
def results() -> list[Result]:
    return [_result("nickel", 1.0), _result("paper", 3.0)]


def test_tables_name_every_material_and_model(results):
    errors = models_tables.errors(results).splitlines()
    assert len(errors) == 2 + 2 * 4
    assert errors[2] == "| nickel | noise |  | - | - | 0.0500 | - | - |"
    assert errors[3] == "| nickel | scattered | 0.0200 | **0.0100** | **0.0200** | **0.0300** | 0.0400 | - |"
    costs = models_tables.costs(results).splitlines()
    assert costs[2] == "| nickel | measurement |  | 35000000 |  |  | 40 | - | 30 | - |"
    assert costs[3] == "| nickel | scattered | 7 | 4000 | 44 | 1.00 | 50 | 100 | 10 | 20 |"
    assert "| paper | 0.250 | 0.0200 |" in models_tables.ggx(results)
    assert "| nickel | 0.100, 0.200, 0.300 | 1.000 |" in models_tables.principled(results)
    assert "| nickel | 47, 7 | 4000 | 0.0200, 0.0100 / " in models_tables.scattered(results)


def test_pages_and_rows_are_written(results, tmp_path):
    (tmp_path / "models").mkdir()
    conditions = {"machine": "m", "date": "d", "commit": "c", "seed": 1, "threads": 2, "load": 1.25}
    models_text.write(ROOT / "docs/results", tmp_path, results, {}, conditions)
    page = (tmp_path / "models.md").read_text(encoding="utf-8")
    assert "| scattered | 0.0200 | 6 of 8 | 4 | 44 | 2.00 | 50 | 100 | 10 | 20 |" in page
    assert "commit c" in page
    assert "other programs kept 1.2 processors busy" in page
    with open(tmp_path / "models/models.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["model"] for row in rows if row["material"] == "paper"} == {
        *("noise", "measurement", "scattered", "ggx", "principled", "scattered, unturned")
    }


def _page(folder) -> str:
    """Without the load of other programs, which is that of the moment."""
    page = (folder / "out/models.md").read_text(encoding="utf-8")
    return re.sub(
        r"; \*\*other programs kept .*? processors busy\*\*, so they are too many", "", page, flags=re.S
    )


@pytest.mark.long
def test_a_small_run_is_whole_and_is_not_repeated(data_folder, tmp_path):
    assert run_script("models", tmp_path, data=data_folder).returncode == 0
    page = _page(tmp_path)
    assert "| blue-metallic-paint | principled |" in page
    for picture in ("error_by_lobes", "error_by_bytes"):
        assert (tmp_path / f"out/models/{picture}.png").stat().st_size > 5000
    assert only_kept(run_script("models", tmp_path, data=data_folder).stdout)
    assert undated(_page(tmp_path)) == undated(page)
