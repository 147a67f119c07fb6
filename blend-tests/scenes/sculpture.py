"""A rabbit of bumpy ellipsoids."""

QUANTITY = "a fitted model (SRBF lobes) on a sculpture under sky and sun, with two bounces between its parts"

_BODY = [  # center and radii; the eye is to the right
    ((0.0, 0.0, 0.75), (1.05, 0.7, 0.75)),
    ((0.75, 0.0, 1.5), (0.5, 0.42, 0.45)),
    ((0.6, 0.16, 2.1), (0.16, 0.1, 0.5)),
    ((0.6, -0.16, 2.1), (0.16, 0.1, 0.5)),
    ((-1.05, 0.0, 0.75), (0.25, 0.25, 0.25)),
    ((0.75, 0.35, 0.15), (0.4, 0.18, 0.15)),
    ((0.75, -0.35, 0.15), (0.4, 0.18, 0.15)),
]


def build(folder):
    from pathlib import Path

    from parity import stage
    from support import scenes

    scene = scenes.use_picture(samples=256)
    scene.velour.bounces = 2
    paint = scenes.measured_material((Path(__file__).parent / "data/paint.velour").read_bytes())
    for center, radii in _BODY:
        _part(center, radii, paint)
    stage.ground(20, 0.5)
    stage.camera((3.2, -5.8, 2.4), (1.37, 0, 0.5), 50)
    stage.lamp("SUN", 2, rotation=(0.7, 0.3, 0), angle=0.1)
    scenes.set_world((0.4, 0.6, 1.0), 0.6)


def _part(center, radii, material):
    import bpy
    import numpy as np

    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=1, location=center)
    obj = bpy.context.object
    points = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3)
    x, y, z = (9 * points * radii).T  # waves of fur, as long everywhere
    bumps = 1 + 0.012 * (np.sin(3 * x + y) + np.sin(3 * y + z) + np.sin(3 * z + x))
    obj.data.vertices.foreach_set("co", (points * bumps[:, None] * radii).ravel())
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    obj.data.update()
    obj.data.materials.append(material)
