"""Claimed and true errors of all models of hostile measurements, from the test that compares them."""

from __future__ import annotations

import json
import os
import subprocess

from ..project import BUILT
from ..run import Run

SETTINGS = {}
PAGES = {"failure_modes.md": "failure_modes"}
_PROGRAM = BUILT / "tests/unit/brdf/fit/test_failure_modes"
_KINDS = ("scattered", "parametric")
_VIEWS = ("5", "30", "60", "75", "85")


def measure(run: Run) -> dict:
    report = run.work / "tests.json"
    command = [_PROGRAM, "--gtest_filter=*AreSurvivedAndTold/*", f"--gtest_output=json:{report}"]
    long = os.environ | {"VELOUR_LONG_TESTS": "1"}
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=long)
    return {"conditions": run.conditions(), "rows": rows(json.loads(report.read_text(encoding="utf-8")))}


def rows(tests: dict) -> list[list[str]]:
    """A row per case and model of GoogleTest's report. Refused fits, and views that a measurement does not
    cover, have no numbers."""
    found = {}
    for test in tests["testsuites"][0]["testsuite"]:
        kind, case = test["value_param"].strip("()").split(", ", 1)
        numbers = [_cell(test, view) for view in _VIEWS]
        if kind in _KINDS and any(number != "-" for number in numbers):
            found.setdefault(case, {})[kind] = numbers
    return [[case, kind, *of[kind]] for case, of in found.items() for kind in _KINDS if kind in of]


def _cell(test: dict, view: str) -> str:
    claimed, true = (test.get(f"{what}_{view}") for what in ("claimed", "true"))
    return "-" if claimed is None else f"{float(claimed):.3f} / {float(true):.3f}"


def _least_honest(cells: list[str]) -> str:
    """The cell whose errors differ most, of those the one with the largest true error, and its view."""

    def rank(item: tuple[str, str]) -> tuple[float, float]:
        claimed, true = map(float, item[1].split(" / "))
        return abs(claimed - true), true

    view, cell = max(((v, c) for v, c in zip(_VIEWS, cells, strict=True) if c != "-"), key=rank)
    return f"{cell} at {view}°"


def values(found: dict) -> dict:
    cases: dict[str, dict] = {}
    for case, kind, *cells in found["rows"]:
        cases.setdefault(case, dict.fromkeys(_KINDS) | {"case": case})[kind] = _least_honest(cells)
    return {"cases": cases.values()}
