"""Compares ways to store the view-dependent occlusion of tiles: their errors and costs."""

from __future__ import annotations

import dataclasses
import json
import subprocess
import sys
import zlib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import provenance
import script
import votf_tables_text
from progress import Progress
from velour.core import files
from velour.core.machine import threads
from velour_cli import ROOT

_PROGRAM = ROOT / "build/release/native/bench/occlusion_tables"


@dataclasses.dataclass(frozen=True)
class Case:
    """The default net is periodic within its tile, which favors tables; the irregular one is not."""

    tile: str
    irregularity: float
    texels: int
    views: int
    unseen: int


_IRREGULAR = Case("net", 0.5, 64, 100, 16)
WHOLE = (Case("net", 0, 256, 300, 64), _IRREGULAR, Case("chainmail", 0, 256, 300, 64))
QUICK = (Case("net", 0, 64, 100, 16), _IRREGULAR, Case("chainmail", 0, 64, 100, 16))


def main() -> int:
    args = script.arguments("votf_tables", ROOT / "docs/results")
    args.output.mkdir(parents=True, exist_ok=True)
    progress = Progress()
    results = []
    for case in QUICK if args.quick else WHOLE:
        with progress.work(f"{case.tile}, irregularity {case.irregularity:g}", case.texels**2 * case.views):
            results.append(_compared(case, args))
    votf_tables_text.write(args.output, results, provenance.conditions(args.seed, threads()))
    print(args.output / "votf_tables.md")
    return 0


def _compared(case: Case, args) -> dict:
    words = [*dataclasses.astuple(case), args.seed]
    folder = args.work / "-".join(map(str, words))
    kept = folder / "result.json"
    if kept.exists() and not args.fresh:
        return json.loads(kept.read_text(encoding="utf-8"))
    folder.mkdir(parents=True, exist_ok=True)
    command = [_PROGRAM, *words, folder]
    output = subprocess.run([str(c) for c in command], check=True, stdout=subprocess.PIPE).stdout
    result = json.loads(output)
    for i, candidate in enumerate(result["candidates"]):
        stored = folder / f"{i}.bin"
        candidate["packed"] = len(zlib.compress(stored.read_bytes(), 9))
        stored.unlink()
    files.write_json(kept, result)
    return result


if __name__ == "__main__":
    sys.exit(script.guarded("votf_tables", main))
