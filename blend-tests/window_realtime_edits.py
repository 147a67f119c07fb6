"""The viewport in real time follows edits, as far as it sees."""

import bpy
import numpy as np

from support import realtime, scenes, viewport, window

SCREEN = "700x460"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (far_ground, edits), viewport=True)


def far_ground(folder):
    """A surface near the end of the view hides the sky, however close the view begins."""
    scenes.set_world((1, 1, 1))
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    with window.override():
        scenes.add_plane(scenes.diffuse_material((0.8, 0.3, 0.1)), size=50000).location.z = -9000
    view = viewport.space()
    view.clip_start, view.clip_end = 0.01, 10000
    view.region_3d.view_rotation = 1, 0, 0, 0
    viewport.show_real_time()
    with viewport.few_images():
        yield from viewport.real_time_finished()
    window.screenshot(folder, "far")
    blue = realtime.pixels()[..., 2]
    assert blue.max() < 0.2, blue.max()


def edits(folder):
    """Moving, recoloring and relighting objects updates the real-time viewport."""
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    cube = bpy.data.objects["Cube"]
    cube.active_material = bpy.data.materials["Material"]

    def turn():
        cube.rotation_euler.z = 0.5

    def paint():
        node = cube.active_material.node_tree.nodes["Principled BSDF"]
        node.inputs["Base Color"].default_value = (0.8, 0.1, 0.1, 1)

    def brighten():
        bpy.data.objects["Light"].data.energy *= 3

    def darken():
        scenes.set_world((0.1, 0.1, 0.1))

    def link():
        world = bpy.context.scene.world.node_tree
        world.links.new(
            world.nodes.new("ShaderNodeTexGradient").outputs[0], world.nodes["Background"].inputs[0]
        )

    def reverse():
        gradient = bpy.context.scene.world.node_tree.nodes["Gradient Texture"]
        gradient.gradient_type = "SPHERICAL"

    viewport.show_real_time()
    with viewport.few_images():
        yield from viewport.real_time_finished()
        last = realtime.pixels()
        for edit in (turn, paint, brighten, darken, link, reverse):
            edit()
            yield 0.3
            yield from viewport.real_time_finished()
            seen = realtime.pixels()
            assert np.abs(seen - last).max() > 0.02, edit.__name__
            window.screenshot(folder, f"edit-{edit.__name__}")
            last = seen
