"""The tables of docs/results/blender_parity.md (parity tests) and blender_export.md (export times)."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import export_seconds
import provenance
from generated import replaced
from markdown_table import table
from velour.core import files
from velour.core.machine import threads
from velour_cli import ROOT

PARITY_PAGE = ROOT / "docs/results/blender_parity.md"
EXPORT_PAGE = ROOT / "docs/results/blender_export.md"
ROWS = ROOT / "build/blend-tests/parity"
HEADER = ["feature", "verdict", "largest block difference, %", "in standard errors"]
SEED = 0  # seed of the first of each engine's four pictures


def main() -> int:
    parser = argparse.ArgumentParser(prog="blender_support")
    parser.add_argument("--last", action="store_true", help="of the last run of the tests")
    if not parser.parse_args().last:
        long = os.environ | {"VELOUR_LONG_TESTS": "1"}
        status = subprocess.run([ROOT / "blend-tests/run", "parity"], check=False, env=long).returncode
        if status:
            print("blender_support: tests of parity fail; the table stays as it is.", file=sys.stderr)
            return status
    rows = _rows()
    if not rows:
        print(f"blender_support: there is no row in {ROWS}; run without --last.", file=sys.stderr)
        return 1
    _write(PARITY_PAGE, "parity", _text(rows))
    seconds = f"\n{_conditions(rows)}\n\n{export_seconds.measured(ROOT / 'build/export_seconds')}\n"
    _write(EXPORT_PAGE, "export", seconds)
    return 0


def _write(page: Path, part: str, text: str) -> None:
    files.write_text(page, replaced(page.read_text(encoding="utf-8"), part, text, "blender_support"))


def _rows() -> list[dict]:
    lines = [line for file in sorted(ROWS.glob("*/rows.jsonl")) for line in file.open(encoding="utf-8")]
    return [json.loads(line) for line in lines]


def _text(rows: list[dict]) -> str:
    lines = [[r["feature"], r["verdict"], f"{r['percent']:.2f}", _errors(r["z"])] for r in rows]
    return f"\n{_conditions(rows)}\n\n" + table(HEADER, lines) + "\n"


def _conditions(rows: list[dict]) -> str:
    sentence = provenance.sentence(provenance.conditions(SEED, threads()))
    return f"{sentence} Blender and Cycles {rows[0]['blender']}."


def _errors(z: float | None) -> str:
    """`z`: None for pictures without noise."""
    if z is None:
        return "-"
    return f"{z:.1f}" if z < 100 else f"{z:.0f}"


if __name__ == "__main__":
    sys.exit(main())
