"""The chapter cloth: the model of the weave on a cloth, in a separate file."""

import bpy
import numpy as np
from support import scenes

from . import scene
from .desk import inside

SIZE = (560, 440)
SAMPLES = 64
REPEATS, ROTATION = (14, 14), 30.0  # degrees


def steps(desk, _measurement, _facts):
    yield from desk.arrange()
    scene.start(SAMPLES, SIZE)
    with inside("VIEW_3D"):
        _add_cloth()
        bpy.ops.velour.load_material(filepath=str(desk.folder.parent / "tile/weave.velour"))
    yield from desk.job()
    material = bpy.context.view_layer.objects.active.active_material
    placement = scenes.velour_node(material).velour.placement
    placement.mode, placement.repeats = "REPEATS", REPEATS
    scenes.set_look(material, rotation=np.radians(ROTATION))
    scene.add_world()
    scene.look_at((0, 0, 0), (0.5, -3.9, 0.4), 90)
    yield from desk.show("MATERIAL")
    yield from desk.plot("ORDER")
    desk.picture_of_panels("placement", "MATERIAL", "Placement")
    scene.render(desk.folder, "cloth")


def _add_cloth():
    """A hanging curtain, a meter wide, with a UV map as uniform as the flat grid."""
    bpy.ops.mesh.primitive_grid_add(
        x_subdivisions=120, y_subdivisions=120, size=1, rotation=(np.pi / 2, 0, 0)
    )
    cloth = bpy.context.object
    for vertex in cloth.data.vertices:
        x, y, _ = vertex.co
        vertex.co.z = 0.07 * np.sin(17 * x + 1.5 * y) * (0.8 - 0.5 * y) + 0.03 * np.sin(31 * x + 2)
    bpy.ops.object.shade_smooth()
