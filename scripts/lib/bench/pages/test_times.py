"""Seconds of the tests, from the times that the last run of scripts/test kept."""

from __future__ import annotations

import json

from .. import page, provenance
from ..run import Run
from ..velour_cli import ROOT

SETTINGS = {"shown": (3, 3)}  # number of slowest tests shown per group
_TIMES = ROOT / "build/release/tests/times.json"


def measure(run: Run) -> dict:
    if not _TIMES.is_file():
        raise FileNotFoundError(f"there is no {_TIMES}; run scripts/test first.")
    groups = json.loads(_TIMES.read_text(encoding="utf-8"))
    return {"conditions": run.conditions(seed=0), "groups": groups}


def write(run: Run, found: dict) -> None:
    page.write_parts(
        run.output, "test_times.md", "test_times", times=text(found["groups"], found["conditions"])
    )


def text(groups: dict[str, dict], conditions: dict) -> str:
    """`groups`: results that scripts/test keeps, by name of the group."""
    rows = [{"name": name, **group} for name, group in groups.items()]
    sums = {key: sum(row[key] for row in rows) for key in ("tests", "seconds", "processor")}
    slowest = [
        {"group": row["name"], "test": test, "seconds": seconds}
        for row in rows
        for test, seconds in row["slowest"][: conditions["shown"]]
    ]
    cells = "{name} | {tests} | {seconds:.0f} | {processor:.0f}"
    return f"""
{provenance.sentence(conditions)}
Two tests run at a time, so the seconds of one are those of a busy machine.

{page.table([*rows, {"name": "all", **sums}], "group | tests | seconds | processor seconds", cells)}
{page.table(slowest, "group | slowest tests | seconds", "{group} | {test} | {seconds:.1f}")}
"""
