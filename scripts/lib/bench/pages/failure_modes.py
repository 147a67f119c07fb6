"""Claimed and true errors of all models of hostile measurements, from the test that compares them."""

from __future__ import annotations

import json
import os
import subprocess

from ..project import BUILT
from ..run import Run

CSV = "failure_modes.csv"
SETTINGS = {}
PAGES = {"failure_modes.md": "failure_modes"}
_PROGRAM = BUILT / "tests/unit/brdf/fit/test_brdf_fit_optimized"
_KINDS = ("scattered", "parametric")
_SHARE = 0.1  # of the true error, by which a claim may be off without being shown
_VIEWS = ("5", "30", "60", "75", "85")


def measure(run: Run) -> dict:
    report = run.work / "tests.json"
    command = [_PROGRAM, "--gtest_filter=*AreSurvivedAndTold/*", f"--gtest_output=json:{report}"]
    long = os.environ | {"VELOUR_LONG_TESTS": "1"}
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=long)
    return {"conditions": run.conditions(), "rows": rows(json.loads(report.read_text(encoding="utf-8")))}


def rows(tests: dict) -> list[dict]:
    """A row per case and model of GoogleTest's report. Refused fits have no row."""
    found: dict[str, dict[str, dict]] = {}
    for test in tests["testsuites"][0]["testsuite"]:
        kind, case = test["value_param"].strip("()").split(", ", 1)
        views = [_errors(test, view) for view in _VIEWS if f"claimed_{view}" in test]
        if kind in _KINDS and views:
            worst = max(views, key=lambda row: (abs(row["claimed"] - row["true"]), row["true"]))
            found.setdefault(case, {})[kind] = {"case": case, "model": kind} | worst
    return [of[kind] for of in found.values() for kind in _KINDS if kind in of]


def _errors(test: dict, view: str) -> dict:
    return {"view": view} | {what: round(float(test[f"{what}_{view}"]), 3) for what in ("claimed", "true")}


def values(found: dict) -> dict:
    rows = found["rows"]
    wrong = [row for row in rows if abs(row["claimed"] - row["true"]) > _SHARE * row["true"]]
    return {"count": len({row["case"] for row in rows}), "share": _SHARE, "wrong": wrong}
