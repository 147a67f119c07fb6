"""What a fit for a scene saves and costs, for every material of the test data."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import data_files
import for_scene_text
import script
from for_scene_runs import QUICK, Extent, Study
from renders import Settings
from velour_cli import ROOT


def main() -> int:
    args = script.arguments("for_scene", ROOT / "docs/results")
    extent = QUICK if args.quick else Extent()
    run = script.start(args, Settings(args.work / "kept", extent.size, args.threads, args.seed))
    subjects = data_files.materials(run.data)[: extent.materials]
    study = Study(run.renders, extent)
    study.announce(len(subjects))
    rows = [study.row(name, measurement) for name, measurement in subjects]
    for_scene_text.write(ROOT / "docs/results", args.output, rows, run.conditions, extent)
    print(args.output / "for_scene.md")
    return 0


if __name__ == "__main__":
    sys.exit(script.guarded("for_scene", main))
