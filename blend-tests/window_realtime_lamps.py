"""The viewport in real time under lamps: beside the ray tracer, without shadows."""

from pathlib import Path

import bpy
import numpy as np

from support import realtime, scenes, viewport, window

_DATA = Path(__file__).parent / "scenes/data"

LONG = "many pictures in real time, drawn without a graphics card"
SCREEN = "1400x720"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (lamps, shaped_lamps), viewport=True)


def lamps(folder):
    """Sun, point, spot and area as the ray tracer's, on a ball that casts no shadow on itself."""
    realtime.ball(scenes.measured_material((_DATA / "paint.velour").read_bytes()))
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


def shaped_lamps(folder):
    """What leaves a lamp to the sides: all of it falls on a plane, beside what it does not reach."""
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    with window.override():
        scenes.add_plane(scenes.diffuse_material((0.8, 0.6, 0.4)), size=9.0)
    scenes.set_world((0, 0, 0))
    bpy.context.scene.render.film_transparent = True
    lights = viewport.addon("export.lights")
    made = lights._DESCRIBE["SPOT"]
    cases = {
        "spread": ("AREA", {"spread": np.radians(30), "size": 0.8}, 7.0, {}),
        "wide-spread": ("AREA", {"spread": np.radians(120), "size": 0.8}, 2.5, {}),
        "cosine": ("SPOT", {"spot_size": 2.6, "spot_blend": 0.3}, 2.5, {"cosine": 1}),
        "scaled": (
            "SPOT",
            {"spot_size": 0.9, "shadow_soft_size": 0.0},
            4.0,
            {"cone_scale": (1.6, 0.5), "cosine": 0},
        ),
    }
    for name, (kind, settings, height, values) in cases.items():
        lamp = bpy.data.lights.new(name, kind)
        lamp.energy = 800.0
        for setting, value in settings.items():
            setattr(lamp, setting, value)
        obj = bpy.data.objects.new(name, lamp)
        obj.location, obj.rotation_euler = (0.5, -0.3, height), (0.2, 0.1, 0.4)
        bpy.context.scene.collection.objects.link(obj)
        lights._DESCRIBE["SPOT"] = _describing(made, values)  # as other Blenders do
        try:
            viewport.show_real_time()
            yield from viewport.real_time_finished()
            yield 0.3
            window.screenshot(folder, f"shaped-{name}")
            error = realtime.error(realtime.pixels(), realtime.traced())
        finally:
            lights._DESCRIBE["SPOT"] = made
        print(f"relative L2 under {name}: {error:.4f}", flush=True)
        assert error < 0.03, (name, error)
        bpy.data.objects.remove(obj)


def _describing(made, values):
    def describe(lamp, matrix):
        kind, factor, known = made(lamp, matrix)
        return kind, factor, {**known, **values}

    return describe
