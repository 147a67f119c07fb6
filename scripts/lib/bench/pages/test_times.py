"""Seconds of the tests, from the times that the last run of scripts/test kept."""

from __future__ import annotations

import json

from ..project import ROOT
from ..run import Run

SETTINGS = {"shown": (3, 3)}  # number of slowest tests shown per group
PAGES = {"test_times.md": "test_times"}
_TIMES = ROOT / "build/release/tests/times.json"


def measure(run: Run) -> dict:
    if not _TIMES.is_file():
        raise FileNotFoundError(f"there is no {_TIMES}; run scripts/test first.")
    return {"conditions": run.conditions(seed=0), "groups": json.loads(_TIMES.read_text(encoding="utf-8"))}


def values(found: dict) -> dict:
    groups = [{"name": name, **group} for name, group in found["groups"].items()]
    sums = {key: sum(group[key] for group in groups) for key in ("tests", "seconds", "processor")}
    slowest = [
        {"group": group["name"], "test": test, "seconds": seconds}
        for group in groups
        for test, seconds in group["slowest"][: found["conditions"]["shown"]]
    ]
    return {"groups": [*groups, {"name": "all", **sums}], "slowest": slowest}
