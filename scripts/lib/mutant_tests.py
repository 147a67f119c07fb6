"""Runs the tests that a fault names, and finds which of them failed.

Only KINDS knows how a test is run. A native test is named by its source file, so that programs may be split
and merged without a change to any fault.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from checks import cases

PRESET = "release"
GROUPS = ("native", "python", "blender", "scenes")  # groups of scripts/test
LONG_SUITE = "--all"  # an option of scripts/test

_BUILD = f"build/{PRESET}"
_REPORT = "build/report.xml"  # report of the last single run
_GROUP_REPORTS = f"{_BUILD}/tests"
_SECONDS, _GROUP_SECONDS, _LONG_SECONDS = 600, 7200, 6 * 3600  # only hanging tests take longer
_PROGRAM = re.compile(r"velour_test\(\s*(\w+)\s+FILES\s+(.*?)\s(?:LINK|LABEL)\b", re.DOTALL)
_SUITE = re.compile(r"^\s*(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+)\s*,", re.MULTILINE)
_BEGUN = re.compile(r"^\[ RUN      \] (\S+)", re.MULTILINE)  # GoogleTest's start of a case


class MutantsError(RuntimeError):
    """Its message says in one sentence why something cannot be done."""


class UnknownTestError(MutantsError):
    """A test does not exist."""


class Entry(NamedTuple):
    """A test that a fault names: all cases of a file or scene."""

    kind: str  # a key of KINDS
    what: str

    def __str__(self) -> str:
        return f"{self.kind}:{self.what}" if self.what else self.kind


class Run(NamedTuple):
    """How tests are run in a tree; paths are relative to it."""

    targets: tuple[str, ...]  # targets to build first; empty: the command builds
    command: tuple[str, ...]
    report: str  # a JUnit report or a folder of them
    seconds: float  # time limit
    is_judged_by_status: bool = True  # counts a failed command without a failed case as a failure


class Outcome(NamedTuple):
    passed: int
    failed: tuple[str, ...]  # names of the cases


def entries(line: str) -> list[Entry]:
    """Parses "KIND:WHAT,WHAT". Raises UnknownTestError."""
    kind, _, names = line.strip().partition(":")
    if kind not in KINDS:
        raise UnknownTestError(f"{line}: there are no tests of the kind {kind!r}, only {', '.join(KINDS)}")
    return [Entry(kind, name.strip()) for name in names.split(",")]


def run_of(root: Path, entry: Entry) -> Run:
    """How an entry is run. Raises UnknownTestError if `root` has no such test."""
    return KINDS[entry.kind](root, entry.what)


def run_of_group(group: str) -> Run:
    """How one of GROUPS, or LONG_SUITE, is run. The latter also fails because of a fault's code style."""
    is_long = group == LONG_SUITE
    seconds = _LONG_SECONDS if is_long else _GROUP_SECONDS
    return Run((), ("scripts/test", group), _GROUP_REPORTS, seconds, is_judged_by_status=not is_long)


def _native(root: Path, what: str) -> Run:
    name, _, chosen = what.partition("=")
    source = root / "native/tests" / name
    if not source.is_file():
        raise UnknownTestError(f"native:{what}: there is no {source.relative_to(root)}")
    program, folder = _program_of(root, source)
    command = (
        f"{_BUILD}/{folder}/test_{program}",
        f"--gtest_filter={chosen or _filter_of(source)}",
        f"--gtest_output=xml:{_REPORT}",
    )
    return Run((f"test_{program}",), command, _REPORT, _SECONDS)


def _program_of(root: Path, source: Path) -> tuple[str, Path]:
    """The name of the first velour_test() that compiles `source`, and the folder of its CMakeLists.txt."""
    near = source.parent / "CMakeLists.txt"
    lists = [near, *sorted((root / "native/tests").rglob("CMakeLists.txt"))]
    for path in filter(Path.is_file, lists):
        for name, files in _PROGRAM.findall(path.read_text(encoding="utf-8")):
            if any((path.parent / file).resolve() == source.resolve() for file in files.split()):
                return name, path.parent.relative_to(root)
    raise UnknownTestError(f"native: no velour_test() compiles {source.relative_to(root)}")


def _filter_of(source: Path) -> str:
    """The filter for all cases of a file; typed suites are named SUITE/0, parameterized ones PREFIX/SUITE."""
    suites = dict.fromkeys(_SUITE.findall(source.read_text(encoding="utf-8")))
    if not suites:
        raise UnknownTestError(f"native: {source.name} has no tests")
    return ":".join(f"{suite}.*:{suite}/*:*/{suite}.*" for suite in suites)


def _python(root: Path, what: str) -> Run:
    if not what or not (root / "addon/tests" / what).is_file():
        raise UnknownTestError(f"python:{what}: there is no such file in addon/tests")
    pytest = ("/usr/bin/python3", "-m", "pytest", f"addon/tests/{what}", "-x", "-q")
    return Run(("velour",), (*pytest, f"--junitxml={_REPORT}"), _REPORT, _SECONDS)


def _blender(root: Path, what: str) -> Run:
    folder = root / "blend-tests"
    names = [
        str(path.relative_to(folder)) for top in (folder, folder / "parity") for path in top.glob("*_*.py")
    ]
    if not what or not any(what in name for name in names):
        raise UnknownTestError(f"blender:{what}: no file of blend-tests has that in its name")
    command = ("blend-tests/run", "--junit", _REPORT, what)
    return Run(("velour",), command, _REPORT, _SECONDS)


def _scenes(root: Path, what: str) -> Run:
    if what and not (root / "blend-tests/scenes" / f"{what}.py").is_file():
        raise UnknownTestError(f"scenes:{what}: blend-tests/scenes has no such scene")
    command = ("blend-tests/run_scenes", "--junit", _REPORT, *filter(None, [what]))
    return Run(("velour",), command, _REPORT, _SECONDS)


KINDS: dict[str, Callable[[Path, str], Run]] = {
    "native": _native,
    "python": _python,
    "blender": _blender,
    "scenes": _scenes,
}


def outcome(root: Path, run: Run, status: int | None, log: Path) -> Outcome:
    """Outcome of a run. `status`: None if it did not end in time."""
    report = root / run.report
    paths = sorted(report.rglob("*.xml")) if report.is_dir() else [report]
    found = [case for path in paths for case in cases.of_report(path)]
    failed = [case.name.removeprefix("addon.tests.") for case in found if case.outcome == cases.FAILED]
    if status != 0 and not failed and run.is_judged_by_status:
        said = log.read_text(encoding="utf-8", errors="replace")
        failed = [_culprit(said) + (" did not end" if status is None else "")]
    return Outcome(cases.count(found)[cases.PASSED], tuple(dict.fromkeys(failed)))


def _culprit(said: str) -> str:
    """The case that ran last, for a program that died before it could report."""
    begun = _BEGUN.findall(said)
    return begun[-1] if begun else "the run as a whole"
