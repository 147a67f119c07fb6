"""The machine, commit and settings that numbers were measured with."""

from __future__ import annotations

import datetime
import os
import subprocess
import time
from pathlib import Path

from velour.core.machine import machine

from .velour_cli import ROOT


def conditions(seed: int, threads: int) -> dict:
    today = datetime.datetime.now(datetime.timezone.utc).date().isoformat()
    return {"machine": machine(), "date": today, "commit": _commit(), "seed": seed, "threads": threads}


def sentence(c: dict) -> str:
    return (
        f"All numbers come from one run: {c['date']}, commit {c['commit']},\n"
        f"{c['machine']}; {c['threads']} threads used, seed {c['seed']}."
    )


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


def _commit() -> str:
    commit = _git("rev-parse", "--short=12", "HEAD") or "unknown"
    return commit + " with changes" if _git("status", "--porcelain", "--", "native", "addon") else commit


def _git(*arguments) -> str:
    return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True).stdout.strip()
