"""The groups of tests: each function runs its tools and returns the cases that they report."""

from __future__ import annotations

import json
import os
import re
import shutil
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from . import cases, running
from .cases import FAILED, PASSED, SKIPPED, Case

ROOT = Path(__file__).resolve().parents[3]
PYTHON = "/usr/bin/python3"
_NOT_HERE = (3, 124)  # exit statuses of scripts/blenders and scripts/fuzz if unavailable, and of timeout
_SETUP_SECONDS = 1800
# 300 frames, so that memory and bits are judged over a whole night; small, for ten minutes on two cores.
_SHORT_NIGHT = ("--size", "96x54", "--samples", "16", "--still-samples", "4")
# Lines of blend-tests/run that are omitted after a failure.
_PASSED = r": ok, [0-9]+ passed|^Warning: [0-9]+ x |^ *(Fra|Saved|Time): ?"


@dataclass
class Run:
    """Options that all groups share."""

    preset: str = "release"
    long: bool = False  # run the tests that only scripts/test --all runs
    scenes: Sequence[str] = ()
    update: bool = False
    sources: str = ""  # their hash, if files of tests in Blender that passed before are not run again

    @property
    def build(self) -> Path:
        return ROOT / "build" / self.preset

    @property
    def results(self) -> Path:
        return self.build / "tests"

    @property
    def variables(self) -> dict[str, str]:
        found = {
            "VELOUR_STAGE": str(self.build / "blender"),
            "VELOUR_TEST_ARTIFACTS": str(self.results / "artifacts"),
        }
        return {**found, "VELOUR_LONG_TESTS": "1"} if self.long else found


def check(run: Run, name: str, *command: str | Path) -> Case:
    """Runs a command as one test, which passes if its exit status is 0."""
    log, start = run.results / f"{name}.log", time.monotonic()
    status = running.run(command, log, **run.variables)
    if status != 0:
        running.say(f"FAILED: {name}")
        running.show_end(log)
    return Case(name, PASSED if status == 0 else FAILED, time.monotonic() - start)


def skipped(name: str, reason: str) -> Case:
    return Case(name, SKIPPED, reason=f"{name}: {reason}")


def style(run: Run) -> list[Case]:
    native = sorted(path for end in ("h", "cpp", "c") for path in (ROOT / "native").rglob(f"*.{end}"))
    found = [
        check(run, "clang-format", "clang-format", "--dry-run", "-Werror", *native),
        check(run, "layers", ROOT / "scripts/check_layers"),
        check(run, "language", ROOT / "scripts/check_language"),
        check(run, "mutants", ROOT / "scripts/mutants", "--check"),
    ]
    own = ROOT / "build/tools/bin/ruff"
    ruff = own if os.access(own, os.X_OK) else shutil.which("ruff")
    if ruff is None:
        return [*found, skipped("ruff", "it is not installed and cannot be had from PyPI")]
    places = [*(ROOT / name for name in ("addon", "scripts", "blend-tests", "native")), *_python_programs()]
    found.append(check(run, "ruff", ruff, "check", "--no-cache", *places))
    found.append(check(run, "ruff-format", ruff, "format", "--no-cache", "--check", *places))
    return found


def _python_programs() -> list[Path]:
    """Python programs without a suffix."""
    files = [
        path for folder in ("scripts", "blend-tests") for path in (ROOT / folder).iterdir() if path.is_file()
    ]
    heads = {path: path.read_bytes()[:64].splitlines() for path in files if not path.suffix}
    return sorted(
        path for path, head in heads.items() if head and head[0].startswith(b"#!") and b"python3" in head[0]
    )


def native(run: Run) -> list[Case]:
    programs, jobs = run.results / "native", str(os.cpu_count() or 1)
    shutil.rmtree(programs, ignore_errors=True)
    command = ["ctest", "--test-dir", run.build, "-j", jobs, "--output-on-failure", "--output-junit"]
    progress, variables = (
        running.last(r"(\d+/\d+) Test ", "test programs"),
        {"GTEST_OUTPUT": f"xml:{programs}/"},
    )
    read = lambda report: cases.of_ctest(report, programs)  # noqa: E731
    return _reported(run, "native", command, progress, read, **variables)


def python(run: Run) -> list[Case]:
    # loadfile: the tests of a file share expensive fixtures.
    command = [PYTHON, "-m", "pytest", "-n", "2", "--dist", "loadfile", "--junitxml"]
    return _reported(run, "python", command, running.last(r"\[ *(\d+%)\]", "of the tests"))


def blender(run: Run) -> list[Case]:
    package = check(run, "package", ROOT / "scripts/package")  # one test has Blender install it
    return [package, *_in_blender(run, "blender")]


def _in_blender(run: Run, name: str, *options: str | Path, before: Sequence[str | Path] = ()) -> list[Case]:
    command = [*before, PYTHON, ROOT / "blend-tests/run", *options, "--junit"]
    if run.sources:
        command[-1:] = ["--keep", run.results / f"{name}.json", "--sources", run.sources, "--junit"]
    return _reported(run, name, command, running.matches(r": (ok|FAILED), ", "files"), leave_out=_PASSED)


def scenes(run: Run) -> list[Case]:
    found = _scenes(run, "scenes", *(["--update"] if run.update else []), *run.scenes)
    if run.long and not run.scenes and not run.update:
        found.append(check(run, "check-bench", PYTHON, ROOT / "blend-tests/run_check_bench", "--afresh"))
    return found


def night(run: Run) -> list[Case]:
    """A night on a farm, at a reduced size: a case for each of its judgements."""
    log, output = run.results / "night.log", run.results / "night"
    shutil.rmtree(output, ignore_errors=True)
    command = [ROOT / "scripts/night", "--built", "--fresh", *_SHORT_NIGHT, "--output", output]
    command += ["--work", output / "work"]
    status = running.run(command, log, running.last(r"(?m)^\[ *\d+/\d+\] (.*)$", ""), **run.variables)
    if why := re.search(r"^night: skipped, (.*)\.$", log.read_text(errors="replace"), re.MULTILINE):
        return [skipped("night", why[1])]
    return _judged("night", status or 0, _judgements(output / "night.json"), log)


def _judgements(report: Path) -> list[Case]:
    """The cases of a measured page that judges; empty if it was not written."""
    if not report.is_file():
        return []
    outcomes = {True: PASSED, False: FAILED, None: SKIPPED}
    found = json.loads(report.read_text(encoding="utf-8"))["judgements"]
    return [Case(f"night.{each['name']}", outcomes[each["met"]], 0.0, each["measured"]) for each in found]


def _scenes(run: Run, name: str, *options: str | Path, before: Sequence[str | Path] = ()) -> list[Case]:
    command = [*before, PYTHON, ROOT / "blend-tests/run_scenes", *options, "--junit"]
    found = _reported(run, name, command, running.matches(r"^  [\d.]+ s$", "scenes"))
    if run.scenes or run.update:
        running.show_end(run.results / f"{name}.log")
    return found


def _reported(
    run: Run,
    name: str,
    command: Sequence[str | Path],
    progress: Callable[[str], str],
    read: Callable[[Path], list[Case]] = cases.of_report,
    leave_out: str | None = None,
    **variables: str,
) -> list[Case]:
    """The cases of a command that ends with the option that names its report."""
    report, log = run.results / f"{name}.xml", run.results / f"{name}.log"
    report.unlink(missing_ok=True)
    status = running.run([*command, report], log, progress, **run.variables, **variables)
    return _judged(name, status, read(report), log, leave_out)


def other_blender(run: Run, version: str) -> list[Case]:
    """The groups blender and scenes with the package, in a folder without the build dependencies. Omits the
    long tests, which only add samples."""
    run, log = replace(run, long=False), run.results / f"blender-{version}-setup.log"
    command = ["timeout", str(_SETUP_SECONDS), ROOT / "scripts/blenders", version]
    if running.run(command, log) in _NOT_HERE:
        return [skipped(f"Blender {version}", "it cannot be set up here")]
    package = check(run, "package", ROOT / "scripts/package")
    if package.outcome == FAILED:
        return [package]
    files, stage = ROOT / f"build/blend-tests-{version}", f"VELOUR_STAGE={ROOT / 'build/package/blender'}"
    before = [ROOT / "scripts/blenders", "--run", version, "env", stage]
    return [
        *_in_blender(run, f"blender-{version}", "--files", files, before=before),
        *_scenes(run, f"scenes-{version}", "--output", files / "scenes", before=before),
    ]


def fuzz(run: Run) -> list[Case]:
    """Every reader under libFuzzer."""
    log, start = run.results / "fuzz.log", time.monotonic()
    status = running.run([ROOT / "scripts/fuzz"], log, running.matches(r": \d+ minutes$", "readers"))
    if status in _NOT_HERE:
        return [skipped("fuzz", "clang cannot be installed here")]
    found = [Case("fuzz", FAILED if status else PASSED, time.monotonic() - start)]
    return _judged("fuzz", status, found, log)


def _judged(name: str, status: int, found: list[Case], log: Path, leave_out: str | None = None) -> list[Case]:
    """A run that failed without a failed test, or that has no tests, counts as a failed test."""
    if status == 0 and found:
        return found
    running.show_end(log, leave_out)
    running.say(f"all of it: {log}")
    if not any(case.outcome == FAILED for case in found):
        why = f"exit status {status}" if status else "no tests"
        found = [*found, Case(f"{name} ({why})", FAILED)]
    return found


GROUPS: dict[str, Callable[[Run], list[Case]]] = {
    "style": style,
    "native": native,
    "python": python,
    "blender": blender,
    "scenes": scenes,
}
