"""The chapter tile: a weave, modeled, captured, and made into a material with a silhouette (VOTF)."""

import bpy
from support import scenes

from . import scene
from .desk import area, inside
from .facts import model_info

CAPTURE = {"texels": 48, "views": 81, "lights": 81, "samples": 4, "sides": "ONE"}
TILE, MATERIAL = "Plain Weave", "weave"


def steps(desk, _measurement, facts):
    yield from desk.arrange()
    yield from _tile(desk)
    yield from _capture(desk, facts)
    yield from _material(desk, facts)
    yield from _outline(desk, facts)
    bpy.ops.velour.save_model(filepath=str(desk.folder / f"{MATERIAL}.velour"), material=MATERIAL)


def _tile(desk):
    scene.start()
    bpy.context.scene.unit_settings.scale_length = 0.001
    shading = area("VIEW_3D").spaces.active.shading
    shading.type, shading.color_type = "SOLID", "MATERIAL"
    with inside("VIEW_3D"):
        bpy.ops.velour.add_mesostructure(type="WEAVE")
        bpy.ops.view3d.view_selected()
        bpy.ops.velour.repeat_tile()
    yield from desk.show("OBJECT")
    yield from desk.fold("OBJECT", "Transform", is_open=False)
    yield from desk.fold("OBJECT", "Mesostructure", is_open=True)
    desk.picture_of_window("tile")


def _capture(desk, facts):
    settings = bpy.context.view_layer.objects.active.velour
    bpy.ops.wm.save_as_mainfile(filepath=str(desk.folder / "tile.blend"))
    settings.directory = f"//{MATERIAL}.btf"
    for name, value in CAPTURE.items():
        setattr(settings, name, value)
    yield 0.5
    desk.start(bpy.ops.velour.capture_btf)
    yield from desk.job(until=0.3)
    desk.picture_of_panels("capture", "OBJECT", "Mesostructure")
    yield from desk.job()
    facts["capture_bytes"] = sum(file.stat().st_size for file in (desk.folder / f"{MATERIAL}.btf").iterdir())


def _material(desk, facts):
    desk.start(bpy.ops.velour.compress_btf)
    yield from desk.job()
    info = model_info(scenes.velour_node(bpy.data.materials[MATERIAL]).image)
    facts["model_bytes"], facts["ratio"] = info["bytes"], info["raw_bytes"] / info["bytes"]
    with inside("VIEW_3D"):
        bpy.ops.mesh.primitive_plane_add(size=4, location=(6, 1, 0))
        bpy.context.object.active_material = bpy.data.materials[MATERIAL]
    yield from desk.show("MATERIAL")
    for label in ("Advanced", "Plots", "Model"):
        yield from desk.fold("MATERIAL", label, is_open=True)
    yield from desk.plot("ORDER")
    desk.picture_of_panels("btf_model", "MATERIAL", "Model")


def _outline(desk, facts):
    node = scenes.velour_node(bpy.data.materials[MATERIAL])
    node.velour.structure = bpy.data.objects[TILE]
    desk.start(bpy.ops.velour.add_votf)
    yield from desk.job()
    facts["outlined_bytes"] = model_info(node.image)["bytes"]
    yield from desk.show("MATERIAL")
    yield from desk.fold("MATERIAL", "Silhouette (VOTF)", is_open=True)
    yield from desk.drawn("OUTLINE")
    desk.picture_of_panels("outline", "MATERIAL", "Silhouette (VOTF)")
