"""Runs the command line of Velour as a user would, and says what it said."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def velour(*arguments) -> dict:
    """The report of one call; its message goes through to the terminal, its failure ends the run."""
    return json.loads(_run(*arguments, "--json", stdout=subprocess.PIPE).stdout)


def velour_to_file(json_file: Path, *arguments) -> dict:
    """The same; the report also lies in `json_file`, which appears when everything else is written."""
    _run(*arguments, "--json-file", json_file, "--quiet")
    return json.loads(json_file.read_text(encoding="utf-8"))


def _run(*arguments, **options) -> subprocess.CompletedProcess:
    command = [ROOT / "scripts/velour", *map(str, arguments), "--log-level", "error"]
    return subprocess.run(command, check=True, **options)
