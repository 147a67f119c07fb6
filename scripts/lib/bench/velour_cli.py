"""Runs the command line of Velour as a user would, and returns its reports."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def velour(*arguments) -> dict:
    """Returns the report of a call. Messages go to the terminal. Raises CalledProcessError on failure."""
    return json.loads(_run(*arguments, "--json").stdout)


def _run(*arguments) -> subprocess.CompletedProcess:
    command = [ROOT / "scripts/velour", *map(str, arguments), "--log-level", "error"]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE)
