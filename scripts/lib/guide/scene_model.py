"""The chapter scene_model: a table top in car paint, seen from few angles under a soft environment."""

import bpy
from support import scenes

from . import scene
from .desk import inside
from .facts import model_info

SIZE = (380, 260)
SAMPLES = 256
SKY = (0.6, 0.75, 1.0)


def steps(desk, measurement, facts):
    yield from desk.arrange()
    scene.start(SAMPLES, SIZE)
    bpy.context.scene.frame_end = 1
    bpy.context.scene.world.color = SKY
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*SKY, 1)
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 1
    with inside("VIEW_3D"):
        bpy.ops.mesh.primitive_circle_add(vertices=128, fill_type="NGON")
        bpy.ops.velour.load_material(filepath=str(measurement))
    yield from desk.job()
    scene.look_at((0, -0.05, 0), (0.6, -4.2, 3.4), 72)
    material = bpy.context.view_layer.objects.active.active_material
    scene.render(desk.folder, "part-full")
    yield from desk.show("MATERIAL")
    desk.start(bpy.ops.velour.fit_for_scene, material=material.name)
    yield from desk.job()
    scene.render(desk.folder, "part-scene")
    node = scenes.velour_node(material)
    facts["full"], facts["scene"] = (
        model_info(image)["parameter_bytes"] for image in (node.image, node.velour.scene_model)
    )
    for label in ("Advanced", "Scene Model"):
        yield from desk.fold("MATERIAL", label, is_open=True)
    desk.picture_of_panels("scene_model", "MATERIAL", "Scene Model")
    desk.side_by_side("scene_model_pictures", ["part-full", "part-scene"])
