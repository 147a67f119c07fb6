"""What the processors do during the tests: shares of their time by group, from samples of the whole machine.

Needs perf (Debian: linux-perf). Counts of samples are kept in build/test_shares.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections import Counter
from pathlib import Path

from velour.core import files

from ..project import BUILT, ROOT, MissingError
from ..run import Run

SETTINGS = {"groups": (("native", "python", "blender", "scenes"), ("scenes",))}
PAGES = {"test_shares.md": "test_shares"}

# Layers of the library by what they are for; those of mathematics serve both.
_RENDERING = {"render", "scene", "light", "material", "brdf_eval", "btf_eval", "votf_eval", "realtime"}
_FITTING = ("brdf_fit", "verdict", "btf_fit", "capture", "votf_capture", "math_optimize", "math_tensor")
# Parts of the names of programs and of files of code.
_PROGRAMS = {"idle": ("swapper",), "drawing": ("llvmpipe", "Xvfb")}
_FILES = {
    "starting": ("ld-linux", "ld.so"),
    "Python": ("python", "_multiarray"),
    "drawing": ("[JIT]", "libLLVM", "swrast", "libGL"),
    "rendering": ("libembree",),
    "Blender": ("blender",),
}
_OURS = ("libvelour", "test_")
_SHARES = ("idle", "starting", "Python", "rendering", "fitting", "library", "drawing", "Blender", "system")
_SAMPLE = re.compile(r"^\s*(\d+)\s*\|([^|]*)\|([^|]*)\|\[.\] (.*)$", re.MULTILINE)


def measure(run: Run) -> dict:
    if shutil.which("perf") is None:
        raise MissingError("perf is missing; install linux-perf.")
    layers, rows = _layers(), []
    for group in run.settings.groups:
        kept = run.work / f"{group}.txt"
        if run.fresh or not kept.is_file():
            _record(group, kept)
        counts = _counts(kept.read_text(encoding="utf-8"), layers)
        total = counts.total()
        rows.append({"group": group, **{share: 100 * counts[share] / total for share in _SHARES}})
    return {"conditions": run.conditions(), "groups": rows}


def values(found: dict) -> dict:
    return {"rows": found["groups"]}


def _record(group: str, kept: Path) -> None:
    """Keeps the numbers of samples by function, while the programs with their names are still there."""
    data = kept.with_suffix(".data")
    data.parent.mkdir(parents=True, exist_ok=True)
    options = ["-a", "-F", "199", "-e", "cpu-clock", "-o", data]
    subprocess.run(["perf", "record", *options, "--", ROOT / "scripts/test", group], check=True)
    columns = ["--no-children", "-F", "sample,comm,dso,sym", "--stdio", "-t", "|"]
    report = ["perf", "report", "-i", data, *columns]
    files.write_text(kept, subprocess.run(report, check=True, capture_output=True, text=True).stdout)
    data.unlink()


def _counts(text: str, layers: dict[str, str]) -> Counter:
    """Numbers of samples by share."""
    counts = Counter()
    for number, program, file, symbol in _SAMPLE.findall(text):
        counts[_share(program.strip(), file.strip(), symbol.strip(), layers)] += int(number)
    return counts


def _share(program: str, file: str, symbol: str, layers: dict[str, str]) -> str:
    if any(part in file for part in _OURS):
        return layers.get(_name(symbol), "library")
    for names, text in ((_PROGRAMS, program), (_FILES, file)):
        for share, parts in names.items():
            if any(part in text for part in parts):
                return share
    return "system"


def _layers() -> dict[str, str]:
    """The share of each of the library's functions, by its name without parameters."""
    found = {}
    for archive in sorted(BUILT.glob("libvelour_*.a")):
        layer = archive.stem.removeprefix("libvelour_")
        share = "rendering" if layer in _RENDERING else "fitting" if layer.startswith(_FITTING) else "library"
        command = ["nm", "--demangle", "--defined-only", archive]
        lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
        found |= {_name(line[19:]): share for line in lines if line[17:18] in "tTwW"}
    return found


def _name(symbol: str) -> str:
    return symbol.replace("(anonymous namespace)::", "").split("(")[0]
