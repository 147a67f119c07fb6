"""scripts/mutants: plants faults, and reports which tests detect them."""

from __future__ import annotations

import argparse
import contextlib
import fcntl
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parent))

import mutant_faults
import mutant_results
import mutant_tests
import mutant_tree
from mutant_faults import Fault
from mutant_results import Results
from mutant_tests import LONG_SUITE, MutantsError, Run
from mutant_tree import Tree

ROOT = Path(__file__).resolve().parents[2]
FAULTS = ROOT / "scripts/lib/mutants"
WORK = ROOT / "build/mutants"
MINUTES = 360.0
DONE, FAILED, UNFINISHED, INTERRUPTED = 0, 1, 3, 130  # exit statuses


class TimeOverError(Exception):
    """The time is over: no further fault is started."""


class Pass(NamedTuple):
    """One stage of the tests; each fault has its own."""

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
        self._pass(None, Pass(self._nearest, mutant_results.SEEN, mutant_results.UNSEEN))
        self._pass(mutant_results.UNSEEN, Pass(_groups, mutant_results.SEEN, mutant_results.SHORT_MISSED))
        self._pass(mutant_results.SHORT_MISSED, Pass(_long, mutant_results.LONG, mutant_results.MISSED))

    def _nearest(self, fault: Fault) -> dict[str, Run]:
        return {str(entry): mutant_tests.run_of(self._tree.folder, entry) for entry in fault.nearest}

    def _pass(self, state: str | None, tests: Pass) -> None:
        """Runs a stage for all faults in `state`; None: new faults."""
        faults = [fault for fault in self._faults if self._results.state(fault) == state]
        runs = {name: run for fault in faults for name, run in tests.runs(fault).items()}
        self._know_clean({name: run for name, run in runs.items() if name not in self._results.clean})
        begin = time.monotonic()
        for number, fault in enumerate(faults, 1):
            words = self._judge(fault, tests)
            seconds = time.monotonic() - begin
            left = seconds / number * (len(faults) - number)
            self._say(f"fault {number} of {len(faults)}: {words}; about {left / 60:.0f} min left")

    def _know_clean(self, runs: dict[str, Run]) -> None:
        """Runs these tests without a fault: a test that fails then is no evidence."""
        for number, (name, run) in enumerate(runs.items(), 1):
            self._check_time()
            found = self._tree.run(run, self._logs / "clean.txt")
            self._results.keep_clean(name, found)
            words = f"{found.passed} passed, {len(found.failed)} failed"
            self._say(f"without a fault, {number} of {len(runs)}: {name}: {words}")

    def _judge(self, fault: Fault, tests: Pass) -> str:
        """Plants a fault, keeps its outcome, and returns a message."""
        self._check_time()
        begin = time.monotonic()
        state, by, case = self._met(fault, tests)
        seconds = time.monotonic() - begin
        self._results.keep(fault, state, seconds, by, case)
        return f"{fault.name}: {state}{f' by {by}: {case}' if by else ''}, {seconds:.0f} s"

    def _met(self, fault: Fault, tests: Pass) -> tuple[str, str, str]:
        """The state of the fault, and the tests and the case that detected it."""
        log = self._logs / f"{fault.name}.txt"
        if mutant_faults.refusal(self._tree.folder, fault.patch):
            return mutant_results.UNPLANTED, "", ""
        try:
            with self._tree.planted(fault.patch):
                for name, run in tests.runs(fault).items():
                    if not self._results.is_usable(name):
                        continue
                    new = self._results.new_failures(name, self._tree.run(run, log, fault.name))
                    if new:
                        return tests.seen, name, new[0]
        except mutant_tree.BuildError:
            return mutant_results.BROKEN, "", ""
        return tests.unseen, "", ""

    def _check_time(self) -> None:
        if time.monotonic() >= self._end:
            raise TimeOverError

    def _say(self, words: str) -> None:
        print(f"[{(time.monotonic() - self._begin) / 60:4.0f} min] {words}", flush=True)


def _groups(fault: Fault) -> dict[str, Run]:
    return {group: mutant_tests.run_of_group(group) for group in fault.groups}


def _long(_fault: Fault) -> dict[str, Run]:
    return {LONG_SUITE: mutant_tests.run_of_group(LONG_SUITE)}


def main(arguments: list[str] | None = None) -> int:
    given = _parse(arguments)
    try:
        if given.check:
            return _check()
        faults = _chosen(given.name)
        commit = mutant_tree.head(ROOT)
        if given.table:
            print(mutant_results.table(Results(WORK / "results.json", commit), faults), end="")
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


def _parse(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="mutants")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--minutes", type=float, default=MINUTES)
    parser.add_argument("name", nargs="*")
    return parser.parse_args(arguments)


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
    print(results.counts(faults))
    return status or (DONE if all(results.state(f) == mutant_results.SEEN for f in faults) else FAILED)


if __name__ == "__main__":
    sys.exit(main())
