"""A net in the real-time viewport on a virtual screen, beside the ray tracer's picture, with the error.

The third picture shows ten times their difference about gray. scripts/viewport measures the speed.
"""

from __future__ import annotations

import numpy as np

from .. import blender, charts
from ..run import Run

SETTINGS = {"screen_size": ((1400, 1000), (1400, 1000))}
_TIMES, _GRAY = 10, 0.214  # factor of the difference, around middle gray (linear)
_SHOWN = 0.82  # share of the height: above it is the shell's hem, which has no sides in real time


def measure(run: Run) -> dict:
    folder = run.work / "blender"
    found = blender.in_window("bench.inside.realtime", {}, folder, run.settings.screen_size)
    print(f"relative L2 {found['relative_l2']:.4f}")
    traced, drawn = np.load(folder / "net.npy")[..., :3]
    white, rows = np.percentile(traced, 99.5), round(_SHOWN * traced.shape[0])
    difference = _GRAY + _TIMES * (drawn - traced) / white
    titles = ("ray traced", "real time", f"{_TIMES} times the difference")
    pictures = (traced / white, drawn / white, difference)
    cells = [(title, charts.display(pixels[:rows])) for title, pixels in zip(titles, pictures, strict=True)]
    charts.sheet(run.output / "images/realtime.png", [cells], (2.9, 2.9 * rows / traced.shape[1] + 0.25))
    return {"conditions": run.conditions(), **found}
