"""The table of scripts/failure_modes."""

from __future__ import annotations

from bench.page import replaced
from bench.pages import failure_modes
from conftest import ROOT


def _test(kind: str, case: str, **numbers: str) -> dict:
    return {"value_param": f"({kind}, {case})", **numbers}


def test_models_of_a_case_stand_together_and_the_refused_are_left_out():
    seen = {"claimed_5": "0.0104", "true_5": "0.2", "claimed_85": "1", "true_85": "0.9"}
    honest = {"claimed_5": "0.2", "true_5": "0.21"}
    cases = [
        _test("scattered", "near-mirror, bandwidth 1e4", **seen),
        _test("scattered", "no light direction"),
        _test("scattered_abel_poisson", "near-mirror, bandwidth 1e4", **seen),
        _test("parametric", "black", **honest),
        _test("parametric", "near-mirror, bandwidth 1e4", **seen),
    ]
    mirror = {"case": "near-mirror, bandwidth 1e4", "view": "5", "claimed": 0.01, "true": 0.2}
    black = {"case": "black", "model": "parametric", "view": "5", "claimed": 0.2, "true": 0.21}
    rows = failure_modes.rows({"testsuites": [{"testsuite": cases}]})
    assert rows == [mirror | {"model": kind} for kind in ("scattered", "parametric")] + [black]
    assert failure_modes.values({"rows": rows})["wrong"] == rows[:2]


def test_the_page_has_its_part():
    page = (ROOT / "docs/results/failure_modes.md").read_text(encoding="utf-8")
    assert replaced(page, "measured", "new\n") != page
