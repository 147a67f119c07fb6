"""Seconds of the tests and of the demo, as the last runs of scripts/test and scripts/demo kept them."""

from __future__ import annotations

import json
from pathlib import Path

from velour.core import files

from ..page import replaced
from ..project import RESULTS, ROOT
from ..run import Run

SETTINGS = {"shown": (5, 5)}  # numbers of slowest tests and of slowest files shown per group
PAGES = {"test_times.md": "test_times"}
_TIMES = ROOT / "build/release/tests/times.json"
_DEMO = ROOT / "out/demo/seconds.json"
_README = ROOT / "README.md"


def measure(run: Run) -> dict:
    for path, script in ((_TIMES, "scripts/test"), (_DEMO, "scripts/demo")):
        if not path.is_file():
            raise FileNotFoundError(f"there is no {path}; run {script} first.")
    groups, demo = (json.loads(path.read_text(encoding="utf-8")) for path in (_TIMES, _DEMO))
    return {"conditions": run.conditions(seed=0), "groups": groups, "demo": demo["seconds"]}


def values(found: dict) -> dict:
    groups = [{"name": name, **group} for name, group in found["groups"].items()]
    sums = {key: sum(group[key] for group in groups) for key in ("tests", "seconds", "processor")}
    slowest = [
        {"group": group["name"], "test": test, "seconds": seconds}
        for group in groups
        for test, seconds in group["slowest"][: found["conditions"]["shown"]]
    ]
    files = [
        {"group": group["name"], "file": file, "tests": tests, "seconds": seconds}
        for group in groups
        for file, tests, seconds in group["files"][: found["conditions"]["shown"]]
    ]
    groups.append({"name": "all", **sums})
    return {"groups": groups, "slowest": slowest, "files": files, "demo": found["demo"]}


def draw(output: Path, found: dict) -> None:
    """Writes the times of the README's two commands into it."""
    if output == RESULTS:
        demo, tests = found["demo"] / 60, sum(group["seconds"] for group in found["groups"].values()) / 60
        text = f"On two cores, with the packages installed: {demo:.0f} and {tests:.0f} minutes.\n"
        files.write_text(_README, replaced(_README.read_text(encoding="utf-8"), "times", text))
