"""Plots the errors of all methods against bytes, tile by tile."""

from __future__ import annotations

from pathlib import Path

import plots
from btf_chart_numbers import Results

# Plotted values and their axis labels.
VALUES = {
    "psnr": "PSNR of fitted pairs, dB",
    "psnr_unseen": "PSNR of unseen pairs, dB",
    "picture": "picture error",
}


def draw(path: Path, results: Results) -> None:
    panels = {
        (words, tile): {
            method: [
                (ratio, getattr(entry, value))
                for ratio in results.ratios()
                if (entry := results.get(tile, method, ratio)) and getattr(entry, value) is not None
            ]
            for method in results.methods()
        }
        for value, words in VALUES.items()
        for tile in results.tiles()
    }
    plots.grid(path, panels, "raw bytes / bytes of the file")
