"""Mesostructures as outlines in real time."""

import bpy
import numpy as np

from . import realtime, scenes, viewport, window

_PATIENCE = 180  # seconds; a ray looks up to 160 times at an outline, here on a busy processor


def ball_in(structure, material, radius=4.0):
    """A ball of it whose outline is that of a mesostructure."""
    scenes.remove_all_but_camera()
    with window.override():
        bpy.ops.velour.add_mesostructure(type=structure, count=2, resolution=8)
        tile = bpy.context.object
        bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, segments=96, ring_count=48)
        ball = scenes._finish(material, smooth=True)
    bpy.ops.velour.add_votf(material=material.name, structure=tile.name, texels=32)
    bpy.data.objects.remove(tile)
    scenes.velour_node(material).velour.placement.repeats = (8, 4)
    return ball


def compared(folder, name, samples=512):
    """What is drawn, what the ray tracer makes of it, and the overlap of their alpha."""
    viewport.show_real_time()
    yield from viewport.real_time_finished(_PATIENCE)
    window.screenshot(folder, name)
    assert not viewport.the_one()._refusal, viewport.the_one()._refusal.sentence
    drawn = realtime.pixels()
    traced = realtime.traced(realtime.equirectangular(realtime.mixture()), samples=samples)
    overlap = _overlap(drawn, traced.mean)
    means = [picture[..., 3].mean() for picture in (drawn, traced.mean)]
    print(f"{name}: overlap {overlap:.4f}, mean alpha {means[0]:.4f} and {means[1]:.4f}", flush=True)
    return drawn, traced, overlap


def _overlap(drawn, traced):
    """Soft intersection over union of alpha."""
    a, b = drawn[..., 3], traced[..., 3]
    return np.minimum(a, b).sum() / np.maximum(a, b).sum()
