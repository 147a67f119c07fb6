"""One scene through either engine, set so that both are asked for the same picture."""

from typing import NamedTuple

import bpy
import numpy as np

from support import level, scenes


class Effort(NamedTuple):
    seeds: int
    samples: int  # a pixel and seed
    width: int
    height: int


WHOLE = Effort(4, 64, 128, 96)
# An eighth of the time, for error bars twice as wide: what they still see is held to a bound (case.py).
QUICK = Effort(2, 32, 96, 72)
USUAL = WHOLE if level.LONG else QUICK


def set_up(bounces=0, effort=USUAL):
    """Both engines: a small picture, no clamping, no denoising, one box a pixel."""
    scene = bpy.context.scene
    set_size(effort)
    scene.view_settings.view_transform = "Standard"
    set_up_cycles(scene.cycles, bounces)
    velour = scene.velour
    velour.bounces, velour.split = bounces, 1  # every direction has its own place in the pixel
    return scene


def set_size(effort):
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = effort.width, effort.height, 100


def set_up_cycles(cycles, bounces):
    """Without what is biased, and with a filter of one pixel."""
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    for name in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"):
        setattr(cycles, name, bounces)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.pixel_filter_type = "BOX"
    _keep_pixels_independent(cycles)
    cycles.blur_glossy = 0.0  # since Blender 5.2 it also blurs images for light that has met a rough surface


def _keep_pixels_independent(cycles):
    """Newer Blenders' blue noise makes neighbors differ, which the judge must not take for even pictures.

    They offer the other patterns to developers alone.
    """
    preferences = bpy.context.preferences
    if hasattr(preferences.experimental, "use_cycles_debug") and bpy.app.version >= (4, 2):
        preferences.experimental.use_cycles_debug = preferences.view.show_developer_ui = True
        cycles.sampling_pattern = "TABULATED_SOBOL"


def set_cycles_samples(cycles, count):
    """Without the first, which is in the middle of the pixel whatever the seed: edges are off by 1 / 2n."""
    cycles.samples, cycles.sample_offset = count, 1
    if hasattr(cycles, "use_sample_subset"):  # where the offset is one into the samples, not beyond them
        cycles.samples, cycles.use_sample_subset, cycles.sample_subset_length = count + 1, True, count


def pictures(engine, folder, samples=1, first_seed=0, effort=USUAL):
    """[seeds x height x width x 4] of independent seeds, linear. `samples`: times those of `effort`."""
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.velour.samples = int(effort.samples * samples)
    set_cycles_samples(scene.cycles, int(effort.samples * samples))
    found = []
    for seed in range(first_seed, first_seed + effort.seeds):
        scene.cycles.seed = scene.velour.seed = seed
        found.append(scenes.render(folder, f"{engine.lower()}{seed}"))
    return np.stack(found)
