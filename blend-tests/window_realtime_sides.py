"""The viewport in real time: both sides of a BTF, of what is mirrored as well."""

import bpy
import numpy as np

from support import realtime, scenes, viewport, window

# Whether it is smooth, its turn about x, and its scale along x.
_PLANES = ((False, 0, 1), (False, np.pi, 1), (False, 0, -1), (False, np.pi, -1), (True, np.pi, -1))

LONG = "many pictures in real time, drawn without a graphics card"
SCREEN = "1400x720"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (both_sides,), viewport=True)


def both_sides(folder):
    """A plane whose BTF is red above and blue below, from both sides; flat and smooth, mirrored and not."""
    realtime.sky(folder)
    material = _two_sided(folder)
    for smooth, turn, scale in _PLANES:
        scenes.remove_all_but_camera()
        with window.override():
            plane = scenes.add_plane(material, size=9.0)
        plane.data.polygons[0].use_smooth = smooth
        plane.rotation_euler.x, plane.scale.x = turn, scale
        viewport.show_real_time()
        yield from viewport.real_time_finished()
        drawn = realtime.pixels()
        traced = realtime.traced(realtime.equirectangular(realtime.mixture()), samples=256)
        colors = [picture[picture[..., 3] > 0.999][:, :3].mean(axis=0) for picture in (drawn, traced.mean)]
        error = realtime.error(drawn, traced)
        print(
            f"smooth {smooth}, turned {turn:.0f}, scale {scale}: {colors}, relative L2 {error:.4f}",
            flush=True,
        )
        assert error < 0.03, error
        assert (colors[0][0] > colors[0][2]) == (turn == 0), colors


def _two_sided(folder):
    """The material of a tile: a red square over a blue one."""
    mesh = bpy.data.meshes.new("Tile")
    corners = [(x, y, z) for z in (0.0, -0.1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3), (7, 6, 5, 4)])
    for color in ((0.8, 0.2, 0.1), (0.1, 0.2, 0.8)):
        mesh.materials.append(scenes.diffuse_material(color))
    mesh.polygons[1].material_index = 1
    tile = bpy.data.objects.new("Tile", mesh)
    bpy.context.scene.collection.objects.link(tile)
    with window.override():
        bpy.context.view_layer.objects.active = tile
        settings = {"texels": 8, "views": 24, "lights": 24, "samples": 16, "bounces": 0, "sides": "TWO"}
        path = folder / "Sides.btf"
        assert bpy.ops.velour.capture_btf(directory=str(path), **settings) == {"FINISHED"}
        assert bpy.ops.velour.compress_btf(filepath=str(path)) == {"FINISHED"}
    return bpy.data.materials["Sides"]
