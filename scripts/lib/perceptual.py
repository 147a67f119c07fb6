"""What a tolerance of the fit looks like: FLIP between renders of models and of their measurements."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import flip_metric
import perceptual_text
import script
from perceptual_runs import QUICK, THRESHOLDS, Extent, Seen, Study
from renders import Settings
from velour_cli import ROOT


def main() -> int:
    args = script.arguments("perceptual", ROOT / "docs/results")
    extent = QUICK if args.quick else Extent()
    run = script.start(args, Settings(args.work / "kept", extent.size, args.threads, args.seed))
    thresholds = Seen(*map(flip_metric.of_lightness, THRESHOLDS))
    rows = Study(run.renders, run.data, extent).rows()
    perceptual_text.write(args.output, rows, thresholds, run.conditions, extent)
    print(args.output / "perceptual.md")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(script.guarded("perceptual", main))
    except flip_metric.NoFlipError as absent:
        print(f"perceptual: {absent}")
