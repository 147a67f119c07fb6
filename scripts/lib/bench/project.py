"""The project's folders, command line and test data, and the conditions that numbers are measured under."""

from __future__ import annotations

import datetime
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from velour.core.machine import machine

ROOT = Path(__file__).resolve().parents[3]
RESULTS = ROOT / "docs/results"
BUILT = ROOT / "build/release/native"
_EXPANDED, _SMOOTH = ROOT / "build/merl", ROOT / "build/meshes"


def velour(*arguments) -> dict:
    """Calls the command line as a user would and returns its report; messages go to the terminal. Raises
    CalledProcessError."""
    return json.loads(_run(*arguments, "--json").stdout)


def _run(*arguments) -> subprocess.CompletedProcess:
    command = [ROOT / "scripts/velour", *map(str, arguments), "--log-level", "error"]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE)


def flags(parameters: dict) -> list[str]:
    # One word per option: a value may begin with a minus.
    return [f"--{name}={value}" for name, value in parameters.items()]


def conditions(seed: int, threads: int) -> dict:
    today = datetime.datetime.now(datetime.timezone.utc).date().isoformat()
    return {"machine": machine(), "date": today, "commit": _commit(), "seed": seed, "threads": threads}


def sentence(c: dict) -> str:
    """Kept numbers may name other runs whose rows they have, and what a reader must know."""
    origin = (
        f"Some rows: {c['added_to']}; this page" if c.get("added_to") else "All numbers come from one run"
    )
    machine = f"{c['machine'].split(',')[0]}, {c['threads']} threads, seed {c['seed']}. {c.get('note') or ''}"
    return f"{origin}: {c['date']}, commit {c['commit']},\n{machine}".rstrip()


def busy_threads() -> float:
    """Number of processors that other programs keep busy, measured over two seconds."""

    def spent() -> tuple[int, int]:
        line = Path("/proc/stat").read_text(encoding="ascii").splitlines()[0]
        ticks = [int(number) for number in line.split()[1:9]]
        return sum(ticks), ticks[3] + ticks[4]  # all, idle

    all_before, idle_before = spent()
    time.sleep(2)
    all_after, idle_after = spent()
    return (os.cpu_count() or 1) * (1 - (idle_after - idle_before) / (all_after - all_before))


def busy(load: float | str) -> str:
    """What a page says, after a sentence, of busy_threads() before its measurements."""
    load = float(load)
    return "" if load < 0.2 else f" **Other programs kept {load:.1f} processors busy**; times are too long."


def _commit() -> str:
    commit = _git("rev-parse", "--short=12", "HEAD") or "unknown"
    return commit + " with changes" if _git("status", "--porcelain", "--", "native", "addon") else commit


def _git(*arguments) -> str:
    return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True).stdout.strip()


class MissingError(RuntimeError):
    """Something that a page needs is not here; its message is a sentence."""


def data_folder() -> Path:
    data = Path(os.environ.get("VELOUR_DATA", ROOT.parent / "shared/data"))
    if not data.is_dir():
        raise MissingError(f"skipped, there is no test data in {data}; set VELOUR_DATA to its folder.")
    return data.resolve()  # scripts/blenders shows other Blenders the real folder


def merl(data: Path, name: str) -> Path:
    """A MERL-layout file, expanded on first use. Concurrent callers may each expand it; it appears whole."""
    path = _EXPANDED / f"{name}.binary"
    if not path.is_file():
        _EXPANDED.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=_EXPANDED, prefix="partial-") as own:
            expand = [sys.executable, data / "brdf/expand_merl.py", own, name]
            subprocess.run(expand, check=True, stdout=subprocess.DEVNULL)
            os.replace(Path(own) / path.name, path)
    return path


def materials(data: Path) -> list[tuple[str, Path]]:
    """Names and files of all measurements in the data."""
    stand_ins = sorted(path.name.removesuffix(".nbrdf.npz") for path in (data / "brdf").glob("*.nbrdf.npz"))
    found = [(name, merl(data, name)) for name in stand_ins]
    for ending in ("bsdf", "brdf"):
        found += [(path.stem, path) for path in sorted((data / "brdf").glob(f"*.{ending}"))]
    return found


def mesh(data: Path, name: str) -> Path:
    """The mesh as one smoothing group: meshes of the data have neither normals nor smoothing groups."""
    content = b"s 1\n" + (data / f"mesh/{name}.obj").read_bytes()
    # By content: another folder of data may have another mesh of this name.
    path = _SMOOTH / hashlib.sha256(content).hexdigest()[:16] / f"{name}.obj"
    if not path.is_file():
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix="partial-", delete=False) as file:
            file.write(content)
        os.replace(file.name, path)
    return path


def world(data: Path, name: str) -> Path:
    return data / f"hdr/{name}_1k.hdr"
