"""Compares all models of all materials: error, size, fit time, and nanoseconds per direction pair."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import data_files
import model_runs
import models_plot
import models_text
import provenance
import script
from renders import Settings
from velour_cli import ROOT


@dataclass(frozen=True)
class Extent:
    """How much is fitted."""

    materials: int = 99
    lobes: tuple[int, ...] = (1, 2, 4, 8, 16, 32)
    bytes: tuple[int, ...] = (3000, 4000, 5000, 6000, 8000, 12000, 16000, 24000, 32000)


QUICK = Extent(1, (1, 4), (2000, 8000))


def main() -> int:
    args = script.arguments("models", ROOT / "docs/results")
    extent = QUICK if args.quick else Extent()
    load = provenance.busy_threads()
    run = script.start(args, Settings(args.work / "kept", (0, 0), args.threads, args.seed))
    subjects = data_files.materials(run.data)[: extent.materials]
    runs = model_runs.ModelRuns(run.renders)
    runs.announce(len(subjects), len(extent.lobes) + len(extent.bytes))
    results = [runs.result(name, path, extent) for name, path in subjects]
    floor = runs.floor()
    models_plot.draw(args.output / "models", results)
    models_text.write(ROOT / "docs/results", args.output, results, floor, {**run.conditions, "load": load})
    print(args.output / "models.md")
    return 0


if __name__ == "__main__":
    sys.exit(script.guarded("models", main))
