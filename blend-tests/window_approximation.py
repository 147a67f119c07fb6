"""EEVEE without Velour, which wants a screen: a file of measured materials shows their approximation."""

import bpy
import numpy as np

from support import inputs, scenes, window
from support.blender import run_blender

SIZE = 48
_RENDER = """
import bpy
assert not hasattr(bpy.types.Scene, "velour"), "Velour is there"
scene = bpy.context.scene
kinds = [item.identifier for item in type(scene.render).bl_rna.properties["engine"].enum_items]
scene.render.engine = next(name for name in ("BLENDER_EEVEE_NEXT", "BLENDER_EEVEE") if name in kinds)
scene.eevee.taa_render_samples = 16
scene.render.filepath, scene.render.image_settings.file_format = {path!r}, "OPEN_EXR"
scene.render.film_transparent = False
bpy.ops.render.render(write_still=True)
print("RENDERED BY", scene.render.engine)
"""


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (measured, outlined))


def _scene(material):
    """A plane under a sun and a sky, seen from above; it wears the material."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    bpy.ops.mesh.primitive_plane_add(size=2)
    bpy.context.view_layer.objects.active.data.materials.append(material)
    scenes.use_engine(samples=64, size=SIZE)
    scenes.add_camera(ortho_scale=1.9)
    scenes.set_world(strength=0.3)
    lamp = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    lamp.data.energy, lamp.rotation_euler = 3, (0.3, 0.7, 0)
    bpy.context.scene.collection.objects.link(lamp)


def _eevee(folder, name):
    """Its picture, [height x width x 3], in a Blender without Velour."""
    blend, path = folder / f"{name}.blend", folder / f"{name}.exr"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend), copy=True)
    code = _RENDER.format(path=str(path))
    done = run_blender(blend, "--python-exit-code", "1", "--python-expr", code, addons=False)
    assert done.returncode == 0, done.stdout
    assert "RENDERED BY BLENDER_EEVEE" in done.stdout, done.stdout
    return scenes.read(path)[..., :3]


def measured(folder):
    material = scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement()))
    _scene(material)
    bpy.ops.velour.approximate(material=material.name)
    yield 0.3
    velour = scenes.middle(scenes.render(folder))
    np.testing.assert_allclose(scenes.middle(_eevee(folder, "measured")), velour, rtol=0.06)
    color = _diffuse(material).inputs["Color"]
    for link in list(color.links):
        color.id_data.links.remove(link)
    color.default_value = (0.5, 0.5, 0.5, 1)
    gray = scenes.middle(_eevee(folder, "gray"))
    assert np.abs(gray / velour - 1).max() > 0.3, "gray is no approximation"


def outlined(folder):
    """One sees through the holes: the left half is open."""
    group = inputs.module("operators.approximation_group")
    core = inputs.module("core.approximation")
    material = scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement()))
    _scene(material)
    pixels = np.full((4, 4, 4), 0.5, np.float32)
    pixels[:, :2, 3], pixels[:, 2:, 3] = 0, 1
    found = core.UNFITTED._replace(color_map=pixels)
    group.put(scenes.velour_node(material), material, found, {"texels": (4, 4)})
    assert _is_cut_out(material)
    yield 0.3
    left, right = np.split(_eevee(folder, "outlined")[4:-4], 2, axis=1)
    np.testing.assert_allclose(left[:, 8:-8], 0.3, atol=0.02)  # the sky
    assert right[:, 8:-8].min() > 0.4, right.min()  # the sun as well
    if not hasattr(material, "surface_render_method"):  # since then nothing else is needed
        material.blend_method = "OPAQUE"
        closed, _right = np.split(_eevee(folder, "closed"), 2, axis=1)
        shown = closed[8:-8, 8:-8]
        assert np.abs(shown - 0.3).min() > 0.05, f"it is open whatever its blend method: {shown.mean()}"


def _is_cut_out(material):
    if hasattr(material, "surface_render_method"):  # 4.2 and newer
        return material.surface_render_method == "DITHERED"
    return material.blend_method in ("HASHED", "CLIP")


def _diffuse(material):
    nodes = inputs.module("export.nodes")
    tree = nodes.approximation_node(material).node_tree
    return next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBsdfDiffuse")
