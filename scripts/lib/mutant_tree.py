"""A copy of a commit with its own build folder, in which one fault at a time is planted."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import mutant_faults
from checks import running
from mutant_faults import PRESET, MutantsError, Outcome, Run

PLANTED = "VELOUR_MUTANT"  # the fault's name in the environment of its tests
_BUILD_SECONDS = 7200


class BuildError(MutantsError):
    """The fault, or the commit without one, does not compile; the log says why."""


class Tree:
    """`root`: the repository; `folder`: its copy."""

    def __init__(self, root: Path, folder: Path):
        self.root, self.folder = root, folder

    def prepare(self, commit: str) -> None:
        """Checks out `commit` in the copy, which shares the repository's objects and adds nothing to it."""
        if not (self.folder / ".git").is_dir():
            shutil.rmtree(self.folder, ignore_errors=True)
            _git(self.root, "clone", "--quiet", "--shared", "--no-checkout", str(self.root), str(self.folder))
        _git(self.folder, "checkout", "--quiet", "--force", "--detach", commit)
        self.restore()
        # Links the tools that scripts/setup installed from PyPI, so that they are not downloaded again.
        tools, shared = self.folder / "build/tools", self.root / "build/tools"
        tools.parent.mkdir(exist_ok=True)
        if shared.is_dir() and not tools.exists():
            tools.symlink_to(shared)

    @contextlib.contextmanager
    def planted(self, patch: Path) -> Iterator[None]:
        """Within this context, the copy has the fault."""
        try:
            _git(self.folder, "apply", str(patch))
            yield
        finally:
            self.restore()

    def restore(self) -> None:
        """Reverts the planted fault. Raises MutantsError if the copy is not clean then."""
        _git(self.folder, "checkout", "--quiet", "--", ".")
        left = _git(self.folder, "status", "--porcelain")
        if left:
            raise MutantsError(f"{self.folder} is not clean: {', '.join(left.split())}; remove that folder.")

    def build(self, targets: tuple[str, ...], log: Path) -> None:
        """Raises BuildError."""
        command = ("scripts/build", PRESET, *targets)
        if self._execute(command, log, _BUILD_SECONDS)[0] != 0:
            raise BuildError(f"{' '.join(command)} failed; {log} has what it said.")

    def run(self, run: Run, log: Path, fault: str = "") -> Outcome:
        """Builds the targets of the run and runs it; appends all output to `log`. Raises BuildError."""
        if run.targets:
            self.build(run.targets, log)
        report = self.folder / run.report
        if report.is_dir():  # of an earlier run
            shutil.rmtree(report)
        report.unlink(missing_ok=True)
        report.parent.mkdir(parents=True, exist_ok=True)
        status, own_log = self._execute(run.command, log, run.seconds, **self._variables(fault))
        return mutant_faults.outcome(self.folder, run, status, own_log)

    def _execute(
        self, command: tuple[str, ...], log: Path, seconds: float, **variables: str
    ) -> tuple[int | None, Path]:
        """The exit status (None: it took too long), and the file of the output, which `log` receives, too."""
        own_log = log.with_suffix(".last")
        status = running.run(command, own_log, folder=self.folder, seconds=seconds, **variables)
        with log.open("ab") as whole:
            whole.write(own_log.read_bytes())
        return status, own_log

    def _variables(self, fault: str) -> dict[str, str]:
        found = {"VELOUR_STAGE": str(self.folder / f"build/{PRESET}/blender")}
        data = self.root.parent / "shared/data"
        if "VELOUR_DATA" not in os.environ and data.is_dir():
            found["VELOUR_DATA"] = str(data)  # is beside the repository, but not beside its copy
        return {**found, PLANTED: fault} if fault else found


def head(root: Path) -> str:
    return _git(root, "rev-parse", "HEAD")


def _git(folder: Path, *arguments: str) -> str:
    done = subprocess.run(["git", *arguments], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise MutantsError(f"git {arguments[0]} failed in {folder}: {' '.join(done.stderr.split())}")
    return done.stdout.strip()
