"""The table of claimed and true errors in docs/results/failure_modes.md, from the records of the test."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import generated
import provenance
from markdown_table import table
from velour.core import files
from velour_cli import ROOT

_PROGRAM = ROOT / "build/release/native/tests/unit/brdf/fit/test_failure_modes"
_PAGE = ROOT / "docs/results/failure_modes.md"
_KINDS = ("scattered", "parametric")
_VIEWS = ("5", "30", "60", "75", "85")


def main() -> int:
    with tempfile.TemporaryDirectory(prefix="velour-failures-") as folder:
        found = Path(folder) / "found.json"
        command = [_PROGRAM, "--gtest_filter=*AreSurvivedAndTold/*", f"--gtest_output=json:{found}"]
        subprocess.run(
            command, check=True, stdout=subprocess.DEVNULL, env=os.environ | {"VELOUR_LONG_TESTS": "1"}
        )
        tests = json.loads(found.read_text(encoding="utf-8"))
    page = generated.replaced(_PAGE.read_text(encoding="utf-8"), "claims", part(tests), "failure_modes")
    files.write_text(_PAGE, page)
    print(_PAGE)
    return 0


def part(tests: dict) -> str:
    """`tests`: GoogleTest's JSON report."""
    conditions = provenance.conditions(seed=0, threads=0)
    intro = f"""
Claimed / true relative L2 at the reported views, of scattered models of at most 6 Gaussian lobes a view and
of parametric models of at most 6 lobes in all. Commit {conditions["commit"]}, {conditions["date"]}.

"""
    return intro + table(["case", "model", *_VIEWS], _rows(tests))


def _rows(tests: dict) -> list[list[str]]:
    """A row per case and model. Refused fits and views that a measurement does not cover have no numbers."""
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


if __name__ == "__main__":
    sys.exit(main())
