"""Ways to keep the view-dependent occlusion of tiles: what each gets wrong, and what it costs."""

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
class Extent:
    texels: int = 256
    views: int = 300
    unseen: int = 64
    # Name and irregularity. The net as it comes repeats itself in its tile, which suits tables.
    tiles: tuple[tuple[str, float], ...] = (("net", 0.0), ("net", 0.5), ("chainmail", 0.0))


QUICK = Extent(texels=64, views=100, unseen=16)


def main() -> int:
    args = script.arguments("votf_tables", ROOT / "docs")
    extent = QUICK if args.quick else Extent()
    args.output.mkdir(parents=True, exist_ok=True)
    progress = Progress()
    results = []
    for tile, irregularity in extent.tiles:
        with progress.work(f"{tile}, irregularity {irregularity:g}", extent.texels**2 * extent.views):
            results.append(_compared(tile, irregularity, extent, args))
    votf_tables_text.write(args.output, results, provenance.conditions(args.seed, threads()))
    print(args.output / "votf_tables.md")
    return 0


def _compared(tile: str, irregularity: float, extent: Extent, args) -> dict:
    folder = args.work / f"{tile}-{irregularity:g}-{args.seed}"
    kept = folder / "result.json"
    if kept.exists() and not args.fresh:
        return json.loads(kept.read_text(encoding="utf-8"))
    folder.mkdir(parents=True, exist_ok=True)
    sizes = extent.texels, extent.views, extent.unseen, args.seed
    command = [_PROGRAM, tile, irregularity, *sizes, folder]
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
