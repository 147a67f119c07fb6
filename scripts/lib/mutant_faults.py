"""The faults of scripts/mutants: patches, each with a header of lines "Fault:", "Reason:" and "Nearest:", and
the tests that they name.

Only KINDS knows how a test is run. A native test is named by its source file, so that programs may be split
and merged without a change to any fault.
"""

from __future__ import annotations

import hashlib
import re
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from checks import cases

PRESET = "release"
GROUPS = ("native", "python", "blender", "scenes")  # groups of scripts/test
LONG_SUITE = "--all"  # an option of scripts/test
LEAST_FAULTS = 40
_KEYS = ("Fault", "Reason", "Nearest")
_CODE = {"native/src": (".cpp", ".h"), "addon/velour": (".py",)}  # every folder with such files needs a fault
_CHANGED = re.compile(r"^\+\+\+ b/(\S+)$", re.MULTILINE)

_BUILD = f"build/{PRESET}"
_REPORT = "build/report.xml"  # report of the last single run
_SECONDS, _GROUP_SECONDS, _LONG_SECONDS = 600, 7200, 6 * 3600  # only hanging tests take longer
_PROGRAM = re.compile(r"velour_test\(\s*(\w+)\s+FILES\s+(.*?)\s(?:LINK|LABEL)\b", re.DOTALL)
_SUITE = re.compile(r"^\s*(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+)\s*,", re.MULTILINE)
_BEGUN = re.compile(r"^\[ RUN      \] (\S+)", re.MULTILINE)  # GoogleTest's start of a case


class MutantsError(RuntimeError):
    """Its message says in one sentence why something cannot be done."""


class Entry(NamedTuple):
    """A test that a fault names: all cases of a file or scene."""

    kind: str  # a key of KINDS
    what: str

    def __str__(self) -> str:
        return f"{self.kind}:{self.what}" if self.what else self.kind


class Fault(NamedTuple):
    name: str
    planted: str  # description of the fault
    reason: str  # effect on a user
    nearest: tuple[Entry, ...]  # in the order to try them
    patch: Path
    files: tuple[str, ...]  # files that the patch changes, relative to the root
    digest: str  # hash of the patch

    @property
    def folder(self) -> str:
        return str(Path(self.files[0]).parent)

    @property
    def groups(self) -> tuple[str, ...]:
        """The GROUPS that may detect it."""
        return GROUPS if self.files[0].startswith("native/") else GROUPS[1:]


def read(path: Path) -> Fault:
    text = path.read_text(encoding="utf-8")
    head, _, diff = text.partition("\n\n")
    values: dict[str, list[str]] = {key: [] for key in _KEYS}
    for line in head.splitlines():
        key, separator, value = line.partition(": ")
        if key not in values or not separator or not value.strip():
            raise MutantsError(f"{path.name}: the header has {', '.join(_KEYS)}, and not {line!r}")
        values[key].append(value.strip())
    for key, found in values.items():
        if not found or (len(found) > 1 and key != "Nearest"):
            raise MutantsError(f"{path.name}: the header has {len(found)} lines {key!r}")
    files = tuple(_CHANGED.findall(diff))
    if not files:
        raise MutantsError(f"{path.name}: no diff follows an empty line behind the header")
    try:
        nearest = tuple(entry for line in values["Nearest"] for entry in entries(line))
    except MutantsError as error:
        raise MutantsError(f"{path.name}: {error}") from error
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    return Fault(path.stem, values["Fault"][0], values["Reason"][0], nearest, path, files, digest)


def read_all(folder: Path) -> list[Fault]:
    return [read(path) for path in sorted(folder.glob("*.patch"))]


def problems(root: Path, folder: Path) -> Iterator[str]:
    """A sentence for each reason why scripts/mutants could not plant or judge its faults."""
    faults = []
    for path in sorted(folder.glob("*.patch")):
        try:
            faults.append(read(path))
        except MutantsError as error:
            yield str(error)
    for fault in faults:
        if why := refusal(root, fault.patch):
            yield f"{fault.patch.name} does not apply: {why}"
        for entry in fault.nearest:
            try:
                run_of(root, entry)
            except MutantsError as error:
                yield f"{fault.patch.name}: {error}"
    if len(faults) < LEAST_FAULTS:
        yield f"there are {len(faults)} faults, and {LEAST_FAULTS} are needed"
    covered = {_folder_of(Path(file)) for fault in faults for file in fault.files}
    code = {
        _folder_of(path.relative_to(root))
        for top, endings in _CODE.items()
        for path in (root / top).rglob("*")
        if path.suffix in endings
    }
    for missing in sorted(code - covered):
        yield f"no fault is planted in {missing}"


def refusal(root: Path, patch: Path) -> str:
    """Why a fault cannot be planted in a tree, or ""."""
    command = ["git", "apply", "--check", str(patch)]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    return " ".join(done.stderr.split()) if done.returncode else ""


def _folder_of(file: Path) -> str:
    """The folder that a file counts for: in native/src the one at the top, elsewhere its own."""
    parts = file.parent.parts
    return "/".join(parts[:3] if parts[:2] == ("native", "src") else parts)


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
    """Parses "KIND:WHAT,WHAT"."""
    kind, _, names = line.strip().partition(":")
    if kind not in KINDS:
        raise MutantsError(f"{line}: there are no tests of the kind {kind!r}, only {', '.join(KINDS)}")
    return [Entry(kind, name.strip()) for name in names.split(",")]


def run_of(root: Path, entry: Entry) -> Run:
    """How an entry is run. Raises MutantsError if `root` has no such test."""
    return KINDS[entry.kind](root, entry.what)


def run_of_group(group: str) -> Run:
    """How one of GROUPS, or LONG_SUITE, is run. The latter also fails because of a fault's code style."""
    is_long = group == LONG_SUITE
    seconds = _LONG_SECONDS if is_long else _GROUP_SECONDS
    return Run((), ("scripts/test", group), f"{_BUILD}/tests", seconds, is_judged_by_status=not is_long)


def _native(root: Path, what: str) -> Run:
    name, _, chosen = what.partition("=")
    source = root / "native/tests" / name
    if not source.is_file():
        raise MutantsError(f"native:{what}: there is no {source.relative_to(root)}")
    program, folder = _program_of(root, source)
    chosen, report = chosen or _filter_of(source), f"--gtest_output=xml:{_REPORT}"
    command = (f"{_BUILD}/{folder}/test_{program}", f"--gtest_filter={chosen}", report)
    return Run((f"test_{program}",), command, _REPORT, _SECONDS)


def _program_of(root: Path, source: Path) -> tuple[str, Path]:
    """The name of the first velour_test() that compiles `source`, and the folder of its CMakeLists.txt."""
    lists = [source.parent / "CMakeLists.txt", *sorted((root / "native/tests").rglob("CMakeLists.txt"))]
    for path in filter(Path.is_file, lists):
        for name, files in _PROGRAM.findall(path.read_text(encoding="utf-8")):
            if any((path.parent / file).resolve() == source.resolve() for file in files.split()):
                return name, path.parent.relative_to(root)
    raise MutantsError(f"native: no velour_test() compiles {source.relative_to(root)}")


def _filter_of(source: Path) -> str:
    """The filter for all cases of a file; typed suites are named SUITE/0, parameterized ones PREFIX/SUITE."""
    suites = dict.fromkeys(_SUITE.findall(source.read_text(encoding="utf-8")))
    if not suites:
        raise MutantsError(f"native: {source.name} has no tests")
    return ":".join(f"{suite}.*:{suite}/*:*/{suite}.*" for suite in suites)


def _python(root: Path, what: str) -> Run:
    if not what or not (root / "addon/tests" / what).is_file():
        raise MutantsError(f"python:{what}: there is no such file in addon/tests")
    return _reported("/usr/bin/python3", "-m", "pytest", f"addon/tests/{what}", "-x", "-q", "--junitxml")


def _blender(root: Path, what: str) -> Run:
    folder = root / "blend-tests"
    paths = [path for top in (folder, folder / "parity") for path in top.glob("*_*.py")]
    if not what or not any(what in str(path.relative_to(folder)) for path in paths):
        raise MutantsError(f"blender:{what}: no file of blend-tests has that in its name")
    return _reported("blend-tests/run", what, "--junit")


def _scenes(root: Path, what: str) -> Run:
    if what and not (root / "blend-tests/scenes" / f"{what}.py").is_file():
        raise MutantsError(f"scenes:{what}: blend-tests/scenes has no such scene")
    return _reported("blend-tests/run_scenes", *filter(None, [what]), "--junit")


def _reported(*command: str) -> Run:
    """`command`: ends with the option that names the report."""
    return Run(("velour",), (*command, _REPORT), _REPORT, _SECONDS)


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
        # A program died before it could report: the case that ran last.
        begun = _BEGUN.findall(log.read_text(encoding="utf-8", errors="replace"))
        case = begun[-1] if begun else "the run as a whole"
        failed = [case + (" did not end" if status is None else "")]
    return Outcome(cases.count(found)[cases.PASSED], tuple(dict.fromkeys(failed)))
