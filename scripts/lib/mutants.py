"""scripts/mutants: plants faults, and reports which tests detect them."""

from __future__ import annotations

import argparse
import contextlib
import fcntl
import json
import os
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parent))

import mutant_faults
import mutant_tree
from mutant_faults import GROUPS, LONG_SUITE, Fault, MutantsError, Outcome, Run, run_of, run_of_group
from mutant_tree import Tree

ROOT = Path(__file__).resolve().parents[2]
FAULTS = ROOT / "scripts/lib/mutants"
WORK = ROOT / "build/mutants"
MINUTES = 360.0
DONE, FAILED, UNFINISHED, INTERRUPTED = 0, 1, 3, 130  # exit statuses

# States of a fault.
SEEN = "seen"
UNSEEN = "not seen by the nearest tests"
SHORT_MISSED = "not seen by the short suite"  # the long suite has yet to run
LONG = "only the long suite"
MISSED = "missed"
BROKEN = "does not build"
UNPLANTED = "does not apply"


class Results:
    """Results so far. They count only for their commit, and those of a fault only for its patch."""

    def __init__(self, path: Path, commit: str):
        self._path, self.commit = path, commit
        try:
            kept = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError):  # no campaign has begun, or the file is damaged
            kept = {}
        self.faults: dict[str, dict] = kept.get("faults", {})
        # Outcomes of tests without a fault.
        self.clean: dict[str, dict] = kept.get("clean", {}) if kept.get("commit") == commit else {}

    def of(self, fault: Fault) -> dict:
        found = self.faults.get(fault.name, {})
        return found if (found.get("digest"), found.get("commit")) == (fault.digest, self.commit) else {}

    def state(self, fault: Fault) -> str | None:
        return self.of(fault).get("state")

    def keep(self, fault: Fault, state: str, seconds: float, by: str = "", case: str = "") -> None:
        """`by`: the tests that detected it, `case`: the first of them that failed."""
        seconds = round(self.of(fault).get("seconds", 0.0) + seconds, 1)
        found = {"state": state, "by": by, "case": case, "seconds": seconds}
        self.faults[fault.name] = {"digest": fault.digest, "commit": self.commit, **found}
        self._write()

    def keep_clean(self, tests: str, found: Outcome) -> None:
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

    def _write(self) -> None:
        text = json.dumps({"commit": self.commit, "clean": self.clean, "faults": self.faults}, indent=1)
        temporary = self._path.with_name(f".{self._path.name}.{os.getpid()}")
        self._path.parent.mkdir(parents=True, exist_ok=True)
        temporary.write_text(text + "\n", encoding="utf-8")
        os.replace(temporary, self._path)


def table(results: Results, faults: list[Fault]) -> str:
    """Markdown: the detected faults of each folder, a line for every other fault, and the commits, which
    include older ones. Which tests detect a fault is in its patch."""
    seen: dict[str, list[str]] = {}
    others = []
    for fault in faults:
        found = results.faults.get(fault.name, {})
        if found.get("digest") != fault.digest:
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


class TimeOverError(Exception):
    """The time is over: no further fault is started."""


class Stage(NamedTuple):
    """Tests that all faults in one state meet; each fault has its own."""

    before: str | None  # the state; None: new faults
    runs: Callable[[Fault], dict[str, Run]]  # by name, in the order to try
    seen: str  # state of a fault that they detect
    unseen: str


class Campaign:
    """Tests all faults with their nearest tests, those not detected with the groups, then the long suite."""

    def __init__(self, tree: Tree, results: Results, faults: list[Fault], minutes: float):
        self._tree, self._results, self._faults = tree, results, faults
        self._begin = time.monotonic()
        self._end = self._begin + 60 * minutes
        self._logs = tree.folder.parent / "logs"

    def run(self) -> None:
        """Raises TimeOverError."""
        nearest = lambda fault: {str(e): run_of(self._tree.folder, e) for e in fault.nearest}  # noqa: E731
        groups = lambda fault: {group: run_of_group(group) for group in fault.groups}  # noqa: E731
        self._all(Stage(None, nearest, SEEN, UNSEEN))
        self._all(Stage(UNSEEN, groups, SEEN, SHORT_MISSED))
        self._all(Stage(SHORT_MISSED, lambda _: {LONG_SUITE: run_of_group(LONG_SUITE)}, LONG, MISSED))

    def _all(self, stage: Stage) -> None:
        faults = [fault for fault in self._faults if self._results.state(fault) == stage.before]
        runs = {name: run for fault in faults for name, run in stage.runs(fault).items()}
        self._know_clean({name: run for name, run in runs.items() if name not in self._results.clean})
        begin = time.monotonic()
        for number, fault in enumerate(faults, 1):
            self._check_time()
            start = time.monotonic()
            state, by, case = self._met(fault, stage)
            seconds = time.monotonic() - start
            self._results.keep(fault, state, seconds, by, case)
            left = (time.monotonic() - begin) / number * (len(faults) - number) / 60
            words = f"{fault.name}: {state}{f' by {by}: {case}' if by else ''}, {seconds:.0f} s"
            self._say(f"fault {number} of {len(faults)}: {words}; about {left:.0f} min left")

    def _know_clean(self, runs: dict[str, Run]) -> None:
        """Runs these tests without a fault: a test that fails then is no evidence."""
        for number, (name, run) in enumerate(runs.items(), 1):
            self._check_time()
            found = self._tree.run(run, self._logs / "clean.txt")
            self._results.keep_clean(name, found)
            words = f"{found.passed} passed, {len(found.failed)} failed"
            self._say(f"without a fault, {number} of {len(runs)}: {name}: {words}")

    def _met(self, fault: Fault, stage: Stage) -> tuple[str, str, str]:
        """The state of the fault, and the tests and the case that detected it."""
        log = self._logs / f"{fault.name}.txt"
        if mutant_faults.refusal(self._tree.folder, fault.patch):
            return UNPLANTED, "", ""
        try:
            with self._tree.planted(fault.patch):
                for name, run in stage.runs(fault).items():
                    if self._results.is_usable(name):
                        found = self._tree.run(run, log, fault.name)
                        if new := self._results.new_failures(name, found):
                            return stage.seen, name, new[0]
        except mutant_tree.BuildError:
            return BROKEN, "", ""
        return stage.unseen, "", ""

    def _check_time(self) -> None:
        if time.monotonic() >= self._end:
            raise TimeOverError

    def _say(self, words: str) -> None:
        print(f"[{(time.monotonic() - self._begin) / 60:4.0f} min] {words}", flush=True)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="mutants")
    for option in ("--check", "--table", "--fresh"):
        parser.add_argument(option, action="store_true")
    parser.add_argument("--minutes", type=float, default=MINUTES)
    parser.add_argument("name", nargs="*")
    given = parser.parse_args(arguments)
    try:
        if given.check:
            return _check()
        faults, commit = _chosen(given.name), mutant_tree.head(ROOT)
        if given.table:
            print(table(Results(WORK / "results.json", commit), faults), end="")
            return DONE
        with _alone():
            if given.fresh:
                (WORK / "results.json").unlink(missing_ok=True)
            return _campaign(commit, faults, given.minutes)
    except KeyboardInterrupt:
        print("mutants: interrupted; the next run continues from here.", file=sys.stderr)
        return INTERRUPTED
    except MutantsError as error:
        print(f"mutants: {error}", file=sys.stderr)
        return FAILED


def _check() -> int:
    if mutant_tree.PLANTED in os.environ:
        print("A fault is planted in this tree; nothing is checked.")
        return DONE
    found = list(mutant_faults.problems(ROOT, FAULTS))
    for problem in found:
        print(f"mutants: {problem}", file=sys.stderr)
    if not found:
        print(f"All {len(mutant_faults.read_all(FAULTS))} faults can be planted.")
    return FAILED if found else DONE


def _chosen(names: list[str]) -> list[Fault]:
    """The faults with these names; all if there are none."""
    faults = {fault.name: fault for fault in mutant_faults.read_all(FAULTS)}
    for name in names:
        if name not in faults:
            raise MutantsError(f"there is no fault {name!r} in {FAULTS}")
    return [faults[name] for name in names] if names else list(faults.values())


@contextlib.contextmanager
def _alone() -> Iterator[None]:
    """Excludes other campaigns, which would plant their faults in the same tree."""
    WORK.mkdir(parents=True, exist_ok=True)
    with (WORK / "lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise MutantsError(f"another campaign runs in {WORK}") from error
        yield


def _campaign(commit: str, faults: list[Fault], minutes: float) -> int:
    results = Results(WORK / "results.json", commit)
    if subprocess.run([ROOT / "scripts/setup", "--tests"], check=False).returncode:
        raise MutantsError("scripts/setup failed")
    tree = Tree(ROOT, WORK / "tree")
    tree.prepare(commit)
    tree.build(("velour",), WORK / "logs/clean.txt")  # scripts/build stages it, whatever else it builds
    status = DONE
    try:
        Campaign(tree, results, faults, minutes).run()
    except TimeOverError:
        print("mutants: the time is over; the next run continues from here.", file=sys.stderr)
        status = UNFINISHED
    for line in results.unusable():
        print(line)
    states = Counter(results.state(fault) or "not tried" for fault in faults)
    print(", ".join(f"{count} {state}" for state, count in states.most_common()))
    return status or (DONE if set(states) <= {SEEN} else FAILED)


if __name__ == "__main__":
    sys.exit(main())
