"""The table of times in docs/results/test_times.md, from the times that the last run of scripts/test kept."""

from __future__ import annotations

import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import generated
import provenance
from markdown_table import table
from velour.core import files
from velour.core.machine import threads
from velour_cli import ROOT

_PAGE = ROOT / "docs/results/test_times.md"
_TIMES = ROOT / "build/release/tests/times.json"
_SHOWN = 10  # number of slowest tests shown per group


def main() -> int:
    try:
        groups = json.loads(_TIMES.read_text(encoding="utf-8"))
    except OSError:
        print(f"test_times: there is no {_TIMES}; run scripts/test first.", file=sys.stderr)
        return 1
    page = generated.replaced(_PAGE.read_text(encoding="utf-8"), "times", text(groups), "test_times")
    files.write_text(_PAGE, page)
    print(_PAGE)
    return 0


def text(groups: dict[str, dict]) -> str:
    """`groups`: results that scripts/test keeps, by name of the group."""
    conditions = provenance.sentence(provenance.conditions(seed=0, threads=threads()))
    rows = [
        [name, str(group["tests"]), f"{group['seconds']:.0f}", f"{group['processor']:.0f}"]
        for name, group in groups.items()
    ]
    total = [sum(group[key] for group in groups.values()) for key in ("tests", "seconds", "processor")]
    rows.append(["all", *(f"{value:.0f}" for value in total)])
    slowest = [
        [name, test, f"{seconds:.1f}"]
        for name, group in groups.items()
        for test, seconds in group["slowest"][:_SHOWN]
    ]
    return (
        f"\n{conditions}\nTwo tests run at a time, so the seconds of one are those of a busy machine.\n\n"
        + table(["group", "tests", "seconds", "processor seconds"], rows)
        + "\n"
        + table(["group", "slowest tests", "seconds"], slowest)
        + "\n"
    )


if __name__ == "__main__":
    sys.exit(main())
