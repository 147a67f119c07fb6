"""scripts/test: sets up, builds, runs the groups of tests, and counts the results."""

from __future__ import annotations

import argparse
import json
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from checks import campaign, cases, groups, measured_pages
from checks.cases import FAILED, PASSED, SKIPPED, Case
from checks.groups import GROUPS, ROOT, Run
from checks.running import say

SLOWEST = 20
ONLY_LONG = ("night", "fuzz")  # groups of --all
OTHER_BLENDERS = ("4.3", "5.2", "4.5")


class Clock:
    """Seconds since its creation, and the processor seconds of child processes."""

    def __init__(self) -> None:
        self._start = self._now()

    def read(self) -> tuple[float, float]:
        now = self._now()
        return now[0] - self._start[0], now[1] - self._start[1]

    @staticmethod
    def _now() -> tuple[float, float]:
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return time.monotonic(), used.ru_utime + used.ru_stime


class Total:
    """Collects and prints all cases so far. Times are kept for scripts/test_times."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self.cases: list[Case] = []
        self._groups: dict[str, dict] = {}

    def add(self, name: str, found: list[Case], clock: Clock) -> None:
        self.cases += found
        counts, (seconds, processor) = cases.count(found), clock.read()
        slowest = [(case.name, case.seconds) for case in cases.slowest(found, SLOWEST)]
        for case, its in slowest:
            say(f"  {its:7.1f} s  {case}")
        for sentence in cases.reasons(found):
            say(sentence)
        told = ", ".join(f"{counts[outcome]} {outcome}" for outcome in (PASSED, FAILED, SKIPPED))
        say(f"{name}: {told}, {seconds:.0f} s, {processor:.0f} s of processor time")
        times = {"tests": len(found), "seconds": seconds, "processor": processor}
        self._groups[name] = times | {"slowest": slowest, "files": cases.by_file(found, SLOWEST)}
        self._file.write_text(json.dumps(self._groups, indent=1))


def main() -> int:
    arguments = _arguments()
    clock = Clock()
    run = Run(arguments.preset, arguments.all, arguments.scene, arguments.update)
    run.results.mkdir(parents=True, exist_ok=True)
    total = Total(run.results / "times.json")
    kept = campaign.Campaign(run.results / "all.json") if arguments.all else None
    if subprocess.run([ROOT / "scripts/setup", "--tests"]).returncode != 0:
        return 1
    _name_denoiser()
    say(f"set-up took {clock.read()[0]:.0f} s")
    built = True
    if arguments.groups != ["style"] or arguments.blender:
        built = _build(run, total, "native" in arguments.groups)
    for name, work in _steps(arguments).items():
        needs_build = name != "style"
        _step(name, run, kept, total, built or not needs_build, work)
    if arguments.all:
        for sentence in measured_pages.told(ROOT):
            say(sentence)
    seconds, processor = clock.read()
    say(f"{seconds / 60:.1f} minutes in all, {processor / 60:.1f} of processor time")
    counts = cases.count(total.cases)
    say(f"{counts[PASSED]} passed, {counts[FAILED]} failed, {counts[SKIPPED]} not run")
    return 1 if counts[FAILED] else 0


def _steps(arguments: argparse.Namespace) -> dict[str, Callable[[Run], list[Case]]]:
    """What runs the chosen groups, in their order."""
    other = {f"blender {v}": partial(groups.other_blender, version=v) for v in arguments.blender}
    known = {**GROUPS, "night": groups.night, **other, "fuzz": groups.fuzz}
    return {name: work for name, work in known.items() if name in arguments.groups or name in other}


def _name_denoiser() -> None:
    """Sets VELOUR_OIDN to the denoiser that the setup may just have installed, as common.sh does."""
    wheel = "python3*/site-packages/pyoidn/oidn/lib/libOpenImageDenoise.so.2"
    for file in (ROOT / "build/tools/lib").glob(wheel):
        os.environ.setdefault("VELOUR_OIDN", str(file))


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="scripts/test", add_help=False)
    parser.add_argument("--preset", default="release")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--blender", action="append", default=[], metavar="VERSION")
    parser.add_argument("--scene", action="append", default=[], metavar="NAME")
    parser.add_argument("--update", action="store_true")
    parser.add_argument("groups", nargs="*", metavar="GROUP")
    arguments = parser.parse_args()
    known = [*GROUPS, *(ONLY_LONG if arguments.all else ())]
    for unknown in set(arguments.groups) - set(known):
        parser.error(f"there is no group {unknown!r}; the groups are {', '.join(known)}")
    if arguments.scene and "scenes" not in arguments.groups:
        arguments.groups.append("scenes")
    if not arguments.groups and not arguments.blender:
        arguments.groups = known
        arguments.blender = list(OTHER_BLENDERS) if arguments.all else []
    if arguments.update and "scenes" not in arguments.groups:
        parser.error("--update is for the group scenes")
    return arguments


def _build(run: Run, total: Total, with_native_tests: bool) -> bool:
    clock = Clock()
    targets = ["all" if with_native_tests else "velour"]
    status = subprocess.run([ROOT / "scripts/build", run.preset, *targets]).returncode
    total.add("build", [Case("build", FAILED if status else PASSED, clock.read()[0])], clock)
    return status == 0


def _step(
    name: str,
    run: Run,
    kept: campaign.Campaign | None,
    total: Total,
    is_built: bool,
    work: Callable[[Run], list[Case]],
) -> None:
    say(f"== {name}")
    clock = Clock()
    found = kept.kept(name) if kept else None
    if found is not None:
        say(f"{name} passed in an earlier run of these sources")
    elif is_built:
        found = work(replace(run, sources=kept.sources_but_files(name)) if kept else run)
        if kept:
            kept.keep(name, found)
    else:
        found = [groups.skipped(name, "nothing was built")]
    total.add(name, found, clock)


def _interrupt(*_: object) -> None:
    raise KeyboardInterrupt


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, _interrupt)  # as Ctrl-C: the programs that it has started end, too
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
