"""Results of a campaign of scripts/mutants so far: build/mutants/results.json."""

from __future__ import annotations

import json
import os
from collections import Counter
from pathlib import Path

from mutant_faults import Fault
from mutant_tests import GROUPS, LONG_SUITE, Outcome

SEEN = "seen"
UNSEEN = "not seen by the nearest tests"
SHORT_MISSED = "not seen by the short suite"  # the long suite has yet to run
LONG = "only the long suite"
MISSED = "missed"
BROKEN = "does not build"
UNPLANTED = "does not apply"


class Results:
    """Results count only for their commit, and those of a fault only for its patch."""

    def __init__(self, path: Path, commit: str):
        self._path, self.commit = path, commit
        kept = _read(path)
        self.faults: dict[str, dict] = kept.get("faults", {})
        is_same = kept.get("commit") == commit
        self.clean: dict[str, dict] = kept.get("clean", {}) if is_same else {}

    def of(self, fault: Fault) -> dict | None:
        found = self.faults.get(fault.name)
        is_current = found and found["digest"] == fault.digest and found["commit"] == self.commit
        return found if is_current else None

    def state(self, fault: Fault) -> str | None:
        found = self.of(fault)
        return found["state"] if found else None

    def keep(self, fault: Fault, state: str, seconds: float, by: str = "", case: str = "") -> None:
        """`by`: the tests that detected it, `case`: the first of them that failed."""
        before = self.of(fault) or {"seconds": 0.0}
        self.faults[fault.name] = {
            "digest": fault.digest,
            "commit": self.commit,
            "state": state,
            "by": by,
            "case": case,
            "seconds": round(before["seconds"] + seconds, 1),
        }
        self._write()

    def keep_clean(self, tests: str, found: Outcome) -> None:
        """Keeps the outcome of `tests` without a fault."""
        self.clean[tests] = {"passed": found.passed, "failed": list(found.failed)}
        self._write()

    def is_usable(self, tests: str) -> bool:
        """Whether a failure is evidence: without a fault, a file must pass, and a group must pass in part."""
        found = self.clean[tests]
        return found["passed"] > 0 and (not found["failed"] or tests in (*GROUPS, LONG_SUITE))

    def new_failures(self, tests: str, found: Outcome) -> list[str]:
        """The cases that fail with a fault and pass without it."""
        return [case for case in found.failed if case not in self.clean[tests]["failed"]]

    def unusable(self) -> list[str]:
        """A line for each of the tests that prove nothing."""
        return [
            f"not usable: {tests}: {', '.join(found['failed']) or 'no case'} "
            f"{'fails without a fault, too' if found['failed'] else 'runs here'}"
            for tests, found in self.clean.items()
            if not self.is_usable(tests)
        ]

    def counts(self, faults: list[Fault]) -> str:
        """The last line of a campaign."""
        states = Counter(self.state(fault) or "not tried" for fault in faults)
        return ", ".join(f"{count} {state}" for state, count in states.most_common())

    def _write(self) -> None:
        text = json.dumps({"commit": self.commit, "clean": self.clean, "faults": self.faults}, indent=1)
        temporary = self._path.with_name(f".{self._path.name}.{os.getpid()}")
        self._path.parent.mkdir(parents=True, exist_ok=True)
        temporary.write_text(text + "\n", encoding="utf-8")
        os.replace(temporary, self._path)


def _read(path: Path) -> dict:
    """The kept results; empty if no campaign has begun or the file is damaged."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def table(results: Results, faults: list[Fault]) -> str:
    """Markdown: the detected faults of each folder, a line for every other fault, and the commits, which
    include older ones. Which tests detect a fault is in its patch."""
    seen: dict[str, list[str]] = {}
    others = []
    for fault in faults:
        found = results.faults.get(fault.name)
        if found is None or found["digest"] != fault.digest:
            others.append(f"- {fault.name}: not tried")
        elif found["state"] == SEEN:
            seen.setdefault(fault.folder, []).append(fault.name)
        else:
            case = f": {found['case']}" if found["state"] == LONG else ""
            others.append(f"- {fault.name}: {found['state']}{case}")
    rows = [f"| {folder} | {', '.join(names)} |" for folder, names in sorted(seen.items())]
    commits = sorted({found["commit"][:8] for found in results.faults.values()})
    parts = ["\n".join(["| folder | detected faults |", "|---|---|", *rows]), "\n".join(others)]
    return "\n\n".join([*filter(None, parts), f"Commit: {', '.join(commits) or 'no results yet'}", ""])
