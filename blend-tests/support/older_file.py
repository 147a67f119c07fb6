"""The file that was saved in Blender 3.4 once and stays: what is in it, and how it was made.

`blender -b --factory-startup --addons velour,cycles --python THIS -- PATH`, by scripts/older_file, in 3.4.
"""

import sys
from pathlib import Path

import bpy

TESTS = Path(__file__).resolve().parent.parent
BLEND = TESTS / "scenes/data/blender_3_4.blend"
SAVED_BY = (3, 4)
BEFORE_SPOT, WITH_SPOT = 1, 2  # frames: what light a spot sends differs between Blenders


def open_it():
    bpy.ops.wm.open_mainfile(filepath=str(BLEND), load_ui=False)


def open_with_old_index():
    """Since 4.0 the IOR of a Principled BSDF counts for what it reflects; before, all reflect as 1.5 does.

    Blender opens old files without a change: their IOR is 1.45 unless somebody set it.
    """
    open_it()
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.use_nodes else ():
            if "Specular IOR Level" in node.inputs:
                node.inputs["IOR"].default_value = 1.5


def make(path):
    """Raises RuntimeError in other Blenders."""
    from support import scenes

    if bpy.app.version[:2] != SAVED_BY:
        said = ".".join(map(str, SAVED_BY))
        raise RuntimeError(f"this is Blender {bpy.app.version_string}; the file is to be saved by {said}.")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scenes.use_picture(samples=128)
    bpy.context.scene.velour.bounces = 1
    bpy.context.scene.frame_end = WITH_SPOT
    scenes.set_world((0.6, 0.8, 1.0), 0.15)
    _ground()
    _things()
    _lamps()
    bpy.ops.wm.save_as_mainfile(filepath=path, compress=True)


def _ground():
    import numpy as np

    from parity import stage

    rows, columns = np.mgrid[0:8, 0:8]
    image = bpy.data.images.new("Checkers", 8, 8)
    pixels = np.where(((rows + columns) % 2)[..., None], (0.7, 0.6, 0.4, 1), (0.1, 0.2, 0.3, 1))
    image.pixels = pixels.ravel()
    image.pack()
    ground = stage.ground(6)
    ground.data.uv_layers.new()
    ground.data.materials[0] = material = _principled("Checkers", Roughness=0.6)
    tree = material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])


def _things():
    from support import scenes

    paint = scenes.measured_material((TESTS / "scenes/data/paint.velour").read_bytes())
    _ball(paint, (-1.4, -0.3))
    _ball(_principled("Metal", (0.9, 0.6, 0.3), Metallic=1.0, Roughness=0.35), (0.0, -0.3))
    _ball(_principled("Coat", (0.1, 0.4, 0.1), Clearcoat=0.8, Roughness=0.5), (1.4, -0.3))
    _ball(_principled("Sheen", (0.4, 0.1, 0.2), Sheen=0.8, Roughness=0.8), (-0.8, 1.3))
    glow = _principled("Glow", (0.2, 0.2, 0.2), Emission=(0.3, 0.6, 1.0, 1))
    glow.node_tree.nodes["Principled BSDF"].inputs["Emission Strength"].default_value = 1.5
    _ball(glow, (2.2, 1.3))
    _drum(_principled("Drum", (0.6, 0.6, 0.6), Roughness=0.3))


def _principled(name, color=(0.8, 0.8, 0.8), **values):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (*color, 1)
    for key, value in values.items():
        inputs[key].default_value = value
    return material


def _ball(material, place):
    from support import scenes

    scenes.add_sphere(material, radius=0.6).location = (*place, 0.6)


def _drum(material):
    """Smooth around, sharp at its rims: auto smooth."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=10, radius=0.6, depth=1.2, location=(0.7, 1.3, 0.6))
    mesh = bpy.context.object.data
    bpy.context.object.name = "Drum"
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.use_auto_smooth, mesh.auto_smooth_angle = True, 1.0
    mesh.materials.append(material)


def _lamps():
    from parity import stage

    stage.camera((0, -6.5, 3.2), (1.15, 0, 0), 40)
    stage.lamp("AREA", 150, (1.5, -2, 3.5), (0.5, 0.3, 0), shape="RECTANGLE", size=1.2, size_y=0.6)
    stage.lamp("POINT", 40, (-2.5, -1, 2), shadow_soft_size=0.2)
    spot = stage.lamp("SPOT", 300, (-0.5, -1, 4), (0.1, 0.05, 0), spot_size=1.2, spot_blend=0.3)
    spot.data.shadow_soft_size = 0.1
    for frame in (BEFORE_SPOT, WITH_SPOT):
        spot.hide_render = frame == BEFORE_SPOT
        spot.keyframe_insert("hide_render", frame=frame)


if __name__ == "__main__":
    sys.path.insert(0, str(TESTS))
    make(sys.argv[sys.argv.index("--") + 1])
