"""Claimed and true errors of all models of hostile measurements, from the test that compares them."""

from __future__ import annotations

import json
import os
import subprocess

from .. import page
from ..run import BUILT, Run

SETTINGS = {}
_PROGRAM = BUILT / "tests/unit/brdf/fit/test_failure_modes"
_KINDS = ("scattered", "parametric")
_SHARE = 0.1  # of the true error, by which a claim may be off without being shown
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


def _least_honest(cells: list[str]) -> dict:
    """The view whose errors differ most, of those the one with the largest true error."""
    views = [(view, *cell.split(" / ")) for view, cell in zip(_VIEWS, cells, strict=True) if cell != "-"]
    view, claimed, true = max(views, key=lambda v: (abs(float(v[1]) - float(v[2])), float(v[2])))
    return {"view": view, "claimed": claimed, "true": true}


def _is_wrong(row: dict) -> bool:
    return abs(float(row["claimed"]) - float(row["true"])) > _SHARE * float(row["true"])


def write(run: Run, found: dict) -> None:
    conditions = found["conditions"]
    views = [{"case": case, "model": kind} | _least_honest(cells) for case, kind, *cells in found["rows"]]
    page.write_rows(run.output / "failure_modes.csv", views, conditions)
    wrong = [row for row in views if _is_wrong(row)]
    count = len({row["case"] for row in views})
    table = page.table(
        wrong, "case | model | view | claimed | true", "{case} | {model} | {view}° | {claimed} | {true}"
    )
    claims = f"""
Claimed and true relative L2, at the reported view where they differ most, of scattered models of at most 6
Gaussian lobes a view and of parametric models of at most 6 lobes in all. Commit {conditions["commit"]},
{conditions["date"]}. Of {count} cases ([CSV](failure_modes.csv)), these differ by more than {_SHARE:.0%}:

{table}"""
    page.write_parts(run.output, "failure_modes.md", "failure_modes", claims=claims)
