"""The viewport in real time: pictures of base colors, and what is put in the place of what is shown."""

from pathlib import Path

import bpy
import numpy as np

from support import realtime, scenes, viewport, window

_DATA = Path(__file__).parent / "scenes/data"

LONG = "many pictures in real time, drawn without a graphics card"
SCREEN = "1400x720"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (base_colors, other_model), viewport=True)


def _checks(name, *colors):
    """An image of 4 x 4 squares of these two colors, and a ramp over them."""
    image = bpy.data.images.new(name, 16, 16, float_buffer=True)
    image.colorspace_settings.is_data = True
    y, x = np.mgrid[:16, :16]
    pixels = np.ones((16, 16, 4), np.float32)
    pixels[..., :3] = (
        np.where(((x // 4 + y // 4) % 2)[..., None], *np.array(colors)) * (0.3 + 0.7 * x / 15)[..., None]
    )
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    return image


def _plane(image, extension):
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    material = bpy.data.materials["Material"]
    tree = material.node_tree
    principled = tree.nodes["Principled BSDF"]
    principled.inputs["Roughness"].default_value = 0.9
    node = tree.nodes.new("ShaderNodeTexImage")
    place = tree.nodes.new("ShaderNodeMapping")
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    node.image, node.extension = image, extension
    place.inputs["Scale"].default_value = (2, 1.5, 1)
    place.inputs["Location"].default_value = (0.2, -0.1, 0)
    tree.links.new(coordinates.outputs["UV"], place.inputs["Vector"])
    tree.links.new(place.outputs["Vector"], node.inputs["Vector"])
    tree.links.new(node.outputs["Color"], principled.inputs["Base Color"])
    with window.override():
        scenes.add_plane(material, size=9.0)
    return node


def _error(samples=256):
    light = realtime.equirectangular(realtime.mixture())
    return realtime.error(realtime.pixels(), realtime.traced(light, samples))


def base_colors(folder):
    """Within three hundredths of the ray tracer, whatever lies beyond the picture, and of another one."""
    realtime.sky(folder)
    node = _plane(_checks("Warm", (0.9, 0.5, 0.1), (0.1, 0.2, 0.3)), "REPEAT")
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    window.screenshot(folder, "picture")
    assert "simplified" not in viewport.real_time()._line()
    for change in ("REPEAT", "EXTEND", "CLIP", "other image"):
        if change == "other image":
            before = realtime.pixels()
            node.image = _checks("Cold", (0.1, 0.5, 0.9), (0.7, 0.7, 0.7))
        else:
            node.extension = change
        yield 0.3
        yield from viewport.real_time_finished()
        error = _error()
        print(f"relative L2, {change}: {error:.4f}", flush=True)
        assert error < 0.03, (change, error)
    assert realtime.difference(before, realtime.pixels()) > 0.2, (
        "the bound would not tell one picture from another"
    )


def other_model(folder):
    """A model that is chosen as the image of a material that is shown."""
    realtime.sky(folder)
    material = scenes.measured_material((_DATA / "paint.velour").read_bytes())
    weave = scenes.measured_material((_DATA / "weave.velour").read_bytes(), "Weave")
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    with window.override():
        scenes.add_plane(material, size=9.0)
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    before = realtime.pixels()
    scenes.velour_node(material).image = scenes.velour_node(weave).image
    yield 1.0  # until Blender's messages are handed on, and the scene is taken up
    yield from viewport.real_time_finished()
    error = _error(1024)
    print(f"relative L2 of another model: {error:.4f}", flush=True)
    assert error < 0.03, error
    assert realtime.difference(before, realtime.pixels()) > 0.1
