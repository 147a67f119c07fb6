"""Outlines in real time beside those of the ray tracer."""

from pathlib import Path

import bpy
import numpy as np

from support import realtime, scenes, viewport, window

_DATA = Path(__file__).parent / "scenes/data"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (net_of_paint, stones_of_a_btf, outline_comes_and_goes))


def _ball_in(structure, material, radius=4.0):
    """A ball of it whose outline is that of a mesostructure."""
    for obj in list(bpy.data.objects):
        if obj.type != "CAMERA":
            bpy.data.objects.remove(obj)
    with window.override():
        bpy.ops.velour.add_mesostructure(type=structure, count=2, resolution=8)
        tile = bpy.context.object
        bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, segments=96, ring_count=48)
        ball = scenes._finish(material, smooth=True)
    bpy.ops.velour.add_votf(material=material.name, structure=tile.name, texels=32)
    bpy.data.objects.remove(tile)
    scenes.velour_node(material).velour.placement.repeats = (8, 4)
    return ball


def _overlap(drawn, traced):
    """Soft intersection over union of alpha."""
    a, b = drawn[..., 3], traced[..., 3]
    return np.minimum(a, b).sum() / np.maximum(a, b).sum()


def _compared(folder, name):
    """What is drawn, what the ray tracer makes of it, and the overlap of their alpha."""
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    window.screenshot(folder, name)
    assert not viewport.the_one()._not_real_time, viewport.the_one()._not_real_time
    drawn = realtime.pixels()
    traced = realtime.traced(realtime.equirectangular(realtime.mixture()), samples=512)
    overlap, means = _overlap(drawn, traced), [picture[..., 3].mean() for picture in (drawn, traced)]
    print(f"{name}: overlap {overlap:.4f}, mean alpha {means[0]:.4f} and {means[1]:.4f}", flush=True)
    return drawn, traced, overlap


def net_of_paint(folder):
    """Its holes show the world, its outline is the net's."""
    realtime.sky(folder)
    _ball_in("NET", scenes.measured_material((_DATA / "paint.velour").read_bytes()))
    drawn, _, overlap = yield from _compared(folder, "net")
    assert overlap > 0.97, overlap
    height, width = drawn.shape[:2]
    middle = drawn[height // 2 - 20 : height // 2 + 20, width // 2 - 20 : width // 2 + 20, 3]
    assert middle.min() < 0.5 < middle.max()


def stones_of_a_btf(folder):
    """A closed structure: no light beyond an outline is folded back."""
    realtime.sky(folder)
    _ball_in("GRAVEL", scenes.measured_material((_DATA / "weave.velour").read_bytes(), "Weave"))
    drawn, traced, overlap = yield from _compared(folder, "stones")
    error = realtime.error(drawn, traced)
    print(f"relative L2: {error:.4f}", flush=True)
    assert overlap > 0.98, overlap
    assert error < 0.06, error


def outline_comes_and_goes(folder):
    """A ball that is shown already gets an outline."""
    scenes.set_world()
    material = scenes.measured_material((_DATA / "paint.velour").read_bytes())
    ball = _ball_in("NET", material)
    plain = scenes.measured_material((_DATA / "paint.velour").read_bytes(), "Plain")
    ball.material_slots[0].material = plain
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    assert not any(group.in_shell for group in viewport.real_time()._live.scene.groups)
    ball.material_slots[0].material = material
    yield from viewport.real_time_finished()
    assert any(group.in_shell for group in viewport.real_time()._live.scene.groups)
