"""Runs the command line of Velour as a user would, and returns its reports."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def velour(*arguments) -> dict:
    """Returns the report of a call. Messages go to the terminal. Raises CalledProcessError on failure."""
    return json.loads(_run(*arguments, "--json", stdout=subprocess.PIPE).stdout)


def velour_to_file(json_file: Path, *arguments) -> dict:
    """Like velour(), but also leaves the report in `json_file`, which appears after all other output."""
    _run(*arguments, "--json-file", json_file, "--quiet")
    return json.loads(json_file.read_text(encoding="utf-8"))


def _run(*arguments, **options) -> subprocess.CompletedProcess:
    command = [ROOT / "scripts/velour", *map(str, arguments), "--log-level", "error"]
    return subprocess.run(command, check=True, **options)
