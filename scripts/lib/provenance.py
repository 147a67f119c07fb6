"""What numbers were taken on, and from what: a number without that says little."""

from __future__ import annotations

import datetime
import subprocess

from velour.core.machine import machine
from velour_cli import ROOT


def conditions(seed: int, threads: int) -> dict:
    today = datetime.datetime.now(datetime.timezone.utc).date().isoformat()
    return {"machine": machine(), "date": today, "commit": _commit(), "seed": seed, "threads": threads}


def sentence(c: dict) -> str:
    return (
        f"All numbers come from one run: {c['date']}, commit {c['commit']},\n"
        f"{c['machine']}; {c['threads']} threads used, seed {c['seed']}."
    )


def _commit() -> str:
    commit = _git("rev-parse", "--short=12", "HEAD") or "unknown"
    return commit + " with changes" if _git("status", "--porcelain", "--", "native", "addon") else commit


def _git(*arguments) -> str:
    return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True).stdout.strip()
