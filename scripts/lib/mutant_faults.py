"""The faults of scripts/mutants: patches, each with a header of lines "Fault:", "Reason:" and "Nearest:"."""

from __future__ import annotations

import hashlib
import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from mutant_tests import GROUPS, Entry, MutantsError, UnknownTestError, entries, run_of

LEAST_FAULTS = 40
_KEYS = ("Fault", "Reason", "Nearest")
_CODE = {"native/src": (".cpp", ".h"), "addon/velour": (".py",)}  # every folder with such files needs a fault
_CHANGED = re.compile(r"^\+\+\+ b/(\S+)$", re.MULTILINE)


class FaultError(MutantsError):
    """Something is wrong with the file of a fault."""


@dataclass(frozen=True)
class Fault:
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
    values = _header(path, head)
    files = tuple(_CHANGED.findall(diff))
    if not files:
        raise FaultError(f"{path.name}: no diff follows an empty line behind the header")
    try:
        nearest = tuple(entry for line in values["Nearest"] for entry in entries(line))
    except UnknownTestError as error:
        raise FaultError(f"{path.name}: {error}") from error
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    return Fault(path.stem, values["Fault"][0], values["Reason"][0], nearest, path, files, digest)


def _header(path: Path, head: str) -> dict[str, list[str]]:
    values: dict[str, list[str]] = {key: [] for key in _KEYS}
    for line in head.splitlines():
        key, separator, value = line.partition(": ")
        if key not in values or not separator or not value.strip():
            raise FaultError(f"{path.name}: the header has {', '.join(_KEYS)}, and not {line!r}")
        values[key].append(value.strip())
    for key, count in {key: len(found) for key, found in values.items()}.items():
        if count == 0 or (count > 1 and key != "Nearest"):
            raise FaultError(f"{path.name}: the header has {count} lines {key!r}")
    return values


def read_all(folder: Path) -> list[Fault]:
    return [read(path) for path in sorted(folder.glob("*.patch"))]


def problems(root: Path, folder: Path) -> Iterator[str]:
    """A sentence for each reason why scripts/mutants could not plant or judge its faults."""
    faults = []
    for path in sorted(folder.glob("*.patch")):
        try:
            faults.append(read(path))
        except FaultError as error:
            yield str(error)
    for fault in faults:
        if why := refusal(root, fault.patch):
            yield f"{fault.patch.name} does not apply: {why}"
        yield from _unknown_tests(root, fault)
    if len(faults) < LEAST_FAULTS:
        yield f"there are {len(faults)} faults, and {LEAST_FAULTS} are needed"
    covered = {folder_of(file) for fault in faults for file in fault.files}
    for missing in sorted(code_folders(root) - covered):
        yield f"no fault is planted in {missing}"


def refusal(root: Path, patch: Path) -> str:
    """Why a fault cannot be planted in a tree, or ""."""
    command = ["git", "apply", "--check", str(patch)]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    return " ".join(done.stderr.split()) if done.returncode else ""


def _unknown_tests(root: Path, fault: Fault) -> Iterator[str]:
    for entry in fault.nearest:
        try:
            run_of(root, entry)
        except UnknownTestError as error:
            yield f"{fault.patch.name}: {error}"


def folder_of(file: str | Path) -> str:
    """The folder that a file counts for: in native/src the one at the top, elsewhere its own."""
    parts = Path(file).parent.parts
    return "/".join(parts[:3] if parts[:2] == ("native", "src") else parts)


def code_folders(root: Path) -> set[str]:
    return {
        folder_of(path.relative_to(root))
        for top, endings in _CODE.items()
        for path in (root / top).rglob("*")
        if path.suffix in endings
    }
