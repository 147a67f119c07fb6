"""What exact product sampling would save, by a program that tabulates f cos times radiance at some hits."""

from __future__ import annotations

import json
import subprocess

from renders import Renders
from scenes import Scene
from velour.core import files
from velour_cli import ROOT

_PROGRAM = ROOT / "build/release/native/bench/product_bound"


def of(scene: Scene, renders: Renders, hits: int) -> dict | None:
    """Variances of one direction by `mis`, `product` and `exact`; None if the program is not built."""
    if not _PROGRAM.is_file():
        return None
    size = "{}x{}".format(*renders.settings.size)
    arguments = {"mesh": scene.mesh, "material": scene.material, "world": scene.world}
    arguments |= {"size": size, "hits": hits, "seed": renders.settings.seed}
    command = [_PROGRAM, *(str(part) for name, value in arguments.items() for part in (f"--{name}", value))]

    def run(report) -> dict:
        done = subprocess.run(command, check=True, stdout=subprocess.PIPE)
        files.write_json(report, json.loads(done.stdout))
        return json.loads(done.stdout)

    parameters = {**arguments, "program": _PROGRAM}
    label = f"{scene.name}, bound at {hits} hits"
    return renders.keep(label, "bound", parameters, run)["variance"]
