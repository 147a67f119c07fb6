"""What stands before nothing."""

QUANTITY = "alpha of a transparent film: edges, a half transparent pane, a holdout, and the shadow inside"
MEANINGS = ("", "layered")  # of the Principled BSDF, where Velour follows Blender


def meaning():
    from support import principled

    return principled.meaning()


def build(folder):
    from parity import stage
    from support import lamps, scenes

    scene = scenes.use_picture(samples=512)
    scene.render.film_transparent = True
    stage.camera((0, -9, 1.2), (1.57, 0, 0), 50)
    stage.sphere(albedo=0.7, segments=32, rings=16).location = (-1.2, 0, 1.2)
    stage.box((0.4, -0.6, 0.2), (1.6, 0.6, 1.4), 0.4)
    _pane(stage)
    holdout = stage.sphere(0.5, 0.7)
    holdout.location, holdout.is_holdout = (-0.5, -1.5, 0.6), True
    stage.lamp("AREA", lamps.area_watts(500), (3, -4, 5), (0.7, 0, 0.6), size=1)
    scenes.set_world((1, 0.9, 0.8), 0.4)


def _pane(stage):
    import bpy

    material = bpy.data.materials.new("Pane")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Alpha"].default_value, shader.inputs["Roughness"].default_value = 0.5, 0.8
    corners = [(0.8, -2, 0.6), (2.4, -2, 0.6), (2.4, -2, 2.2), (0.8, -2, 2.2)]
    stage.mesh(corners, [(0, 1, 2, 3)], material, "Pane")
