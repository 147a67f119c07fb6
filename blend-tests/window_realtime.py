"""The viewport in real time: beside the ray tracer under the same light, without shadows."""

from pathlib import Path

import bpy
import numpy as np

from support import realtime, scenes, viewport, window

_DATA = Path(__file__).parent / "scenes/data"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (ball_in_a_sky, btf, lamps, grey, edits))


def _ball(material):
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    with window.override():
        bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=2.0)
        ball = scenes._finish(material, smooth=True)
    return ball


def ball_in_a_sky(folder):
    """Within three hundredths of the ray tracer that is lit by the same mixture."""
    realtime.sky(folder)
    _ball(scenes.measured_material((_DATA / "paint.velour").read_bytes()))
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    window.screenshot(folder, "ball")
    drawn = realtime.pixels()
    traced = realtime.traced(realtime.equirectangular(realtime.mixture()))
    same = realtime.error(drawn, traced)
    picture = realtime.error(drawn, realtime.traced())
    print(f"relative L2: {same:.4f} under the mixture, {picture:.4f} under the picture", flush=True)
    assert same < 0.02, same
    assert picture < 0.05, picture
    off = realtime.error(1.04 * drawn, traced)
    assert 0.03 < off < 0.06, off  # what is off by more would be seen


def btf(folder):
    """A plane of a weave by its maps, within three hundredths of the ray tracer as well."""
    realtime.sky(folder)
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    with window.override():
        scenes.add_plane(scenes.measured_material((_DATA / "weave.velour").read_bytes(), "Weave"), size=9.0)
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    window.screenshot(folder, "btf")
    assert not viewport.the_one()._refusal, viewport.the_one()._refusal.sentence
    error = realtime.error(realtime.pixels(), realtime.traced(realtime.equirectangular(realtime.mixture())))
    print(f"relative L2 of a BTF: {error:.4f}", flush=True)
    assert error < 0.03, error


def lamps(folder):
    """Sun, point, spot and area as the ray tracer's, on a ball that casts no shadow on itself."""
    _ball(scenes.measured_material((_DATA / "paint.velour").read_bytes()))
    scenes.set_world((0, 0, 0))
    bpy.context.scene.render.film_transparent = True
    for kind, energy in (("SUN", 2.0), ("POINT", 800.0), ("SPOT", 800.0), ("AREA", 800.0)):
        lamp = bpy.data.lights.new(kind, kind)
        lamp.energy = energy
        if kind == "SPOT":
            lamp.spot_size, lamp.spot_blend = 1.2, 0.3
        obj = bpy.data.objects.new(kind, lamp)
        obj.location = (5, -4, 4)
        obj.rotation_euler = (0.98, 0, 0.9)  # towards the middle
        bpy.context.scene.collection.objects.link(obj)
        viewport.show_real_time()
        yield from viewport.real_time_finished()
        yield 0.3
        window.screenshot(folder, f"lamp-{kind.lower()}")
        error = realtime.error(realtime.pixels(), realtime.traced())
        print(f"relative L2 under {kind}: {error:.4f}", flush=True)
        assert error < 0.02, (kind, error)
        bpy.data.objects.remove(obj)


def grey(folder):
    """Scene-linear 0.18 is 118 of 255 under Standard."""
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    scenes.set_world((0.18, 0.18, 0.18))
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    values = 255 * viewport.middle(window.screenshot(folder, "grey"))
    assert np.abs(values - 118).max() <= 1, (values.min(), values.max())


def edits(folder):
    """What is moved, coloured or lit anew is drawn anew."""
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    cube = bpy.data.objects["Cube"]
    cube.active_material = bpy.data.materials["Material"]
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    last = realtime.pixels()

    def turn():
        cube.rotation_euler.z = 0.5

    def paint():
        node = cube.active_material.node_tree.nodes["Principled BSDF"]
        node.inputs["Base Color"].default_value = (0.8, 0.1, 0.1, 1)

    def brighten():
        bpy.data.objects["Light"].data.energy *= 3

    def darken():
        scenes.set_world((0.1, 0.1, 0.1))

    for edit in (turn, paint, brighten, darken):
        edit()
        yield 0.3
        yield from viewport.real_time_finished()
        seen = realtime.pixels()
        assert np.abs(seen - last).max() > 0.02, edit.__name__
        window.screenshot(folder, f"edit-{edit.__name__}")
        last = seen
