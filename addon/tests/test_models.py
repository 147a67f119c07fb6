"""scripts/models: its own pieces against what is known, and a small run on the test data."""

from __future__ import annotations

import pytest
from bench import page
from bench.page import replaced
from bench.pages import models
from bench.pages.models import ANGLES, meets, met, target

PAGE = "above\n<!-- fit: written by scripts/models -->\nold\n<!-- end of fit -->\nbelow\n"


def test_a_part_is_replaced_between_its_markers():
    once = replaced(PAGE, "fit", "new\n")
    assert once == PAGE.replace("old", "new")
    assert replaced(once, "fit", "new\n") == once


@pytest.mark.parametrize("page", ["", PAGE + PAGE, PAGE.replace("end of fit", "end")])
def test_a_page_without_its_two_markers_is_refused(page):
    with pytest.raises(ValueError, match="'fit'"):
        replaced(page, "fit", "new")


def _row(errors, noise=()) -> tuple[dict, dict]:
    """A row and its material's noise."""
    return tuple(
        {f"error_{a}": e for a, e in zip(ANGLES, list(x) or [None] * 5, strict=True)} for x in (errors, noise)
    )


def test_targets():
    assert [target(angle, None) for angle in ANGLES] == [0.02, 0.02, 0.02, 0.02, 0.04]
    assert target("75", 0.05) == 0.05
    assert target("85", 0.03) == 0.04
    assert meets(*_row([0.02] * 5)[:1], "5", {})
    assert not meets(*_row([0.0201] * 5)[:1], "5", {})
    errors = (0.01, 0.03, 0.03, 0.02, None)
    assert met(*_row(errors)) == 2
    assert met(*_row(errors, (None, 0.04, None, None, None))) == 3


def _material(name: str, seconds: float) -> list[dict]:
    errors, noise = _row((0.01, 0.02, 0.03, 0.04, None), (None, None, 0.05, None, None))
    cost = dict(zip(models.COSTS, (50.0, 100.0, 10.0, 20.0), strict=True))
    common = {"relative_l2": 0.02, **errors, "parameter_bytes": 44, "seconds": seconds, **cost}
    fit = common | {"bytes": 4000, "lobes": 7}
    rows = {
        "noise": noise,
        "measurement": {"bytes": 35_000_000, "f": 40.0, "f_16": 30.0},
        "scattered": fit | {"views": 47},
        "parametric": fit,
        "ggx": common | {"alpha": 0.25},
        "principled": common,
        models.UNTURNED: fit,
    }
    first = dict.fromkeys(("bound", "value", *fit, "views", "alpha"))
    found = [first | {"material": name, "model": model} | own for model, own in rows.items()]
    return [
        *found,
        found[2] | {"bound": "max-lobes", "value": 4},
        found[2] | {"bound": "bytes", "value": 4000},
    ]


@pytest.fixture
def shown(tmp_path):
    """Writes the page of two materials; returns its text."""
    values = {"base_color": [0.1, 0.2, 0.3], "metallic": 1.0}
    rows = [*_material("nickel", 1.0), *_material("paper", 3.0)]
    conditions = {"machine": "m", "date": "d", "commit": "c", "seed": 1, "threads": 2, "load": 1.25}
    page.write_rows(tmp_path / models.CSV, rows, conditions)
    conditions, rows = page.read_rows(tmp_path / models.CSV)
    found = {"conditions": conditions, "rows": rows, "principled": {"nickel": values, "paper": values}}
    models.draw(tmp_path, found)
    return page.text("models", conditions | models.values(found))


def test_tables_name_every_material_and_model(shown):
    for line in (
        "| nickel | 0.0200 | 0.0200 | 0.0200 | 0.0200 | 0.0200 | 0.250 |",
        "| scattered | 0.0200 | 6 of 8 | 4 | 44 | 2.00 | 50 | 100 | 10 | 20 |",
    ):
        assert f"\n{line}\n" in shown
    assert shown.count("\n| paper | ") == 1
    assert "commit c" in shown
    assert "Other programs kept 1.2 processors busy" in shown
