"""The preview of a preset in the asset browser: a ball in a studio, rendered by Velour."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from preset_table import Preset, Weave
from velour.core.ball import ROWS, ball_job, ball_scene, shown
from velour.native import Model

SIDE = 256  # pixels


def picture(preset: Preset, model_path: Path, spp: int) -> np.ndarray:
    """[SIDE x SIDE x 4] float32, sRGB as displayed, opaque; row 0 at the bottom, as in Blender's previews."""
    made_of = preset.made_of
    rows = made_of.repeats // 2 if isinstance(made_of, Weave) else ROWS
    with (
        Model.load(model_path) as model,
        ball_scene(lambda scene: scene.add_model_material(model), rows) as scene,
        ball_job(scene, SIDE, spp) as job,
    ):
        job.run()
        return shown(job.read_pass("Combined"))
