"""Collections, vertices and modifiers that make more of one mesh."""

QUANTITY = (
    "instances of a collection and on vertices; array, mirror, solidify, bevel and subdivision modifiers"
)


def build(folder):
    from parity import stage
    from support import scenes

    scenes.use_picture(samples=128)
    stage.ground(30, 0.5)
    stage.camera((0, -12, 7), (1.08, 0, 0), 50)
    stage.lamp("SUN", 3, rotation=(0.6, 0.3, 0.2), angle=0.1)
    scenes.set_world((1, 1, 1), 0.3)
    _collection(stage)
    _on_vertices(stage)
    _modifiers(stage)


def _collection(stage):
    """Two stacked boxes, four times: turned, squeezed, mirrored."""
    import bpy

    inside = bpy.data.collections.new("Tower")
    for low, high, albedo in (((-0.4, -0.4, 0), (0.4, 0.4, 1), 0.7), ((-0.2, -0.2, 1), (0.4, 0.2, 1.6), 0.3)):
        obj = stage.box(low, high, albedo)
        bpy.context.scene.collection.objects.unlink(obj)
        inside.objects.link(obj)
    for number, scale in enumerate(((1, 1, 1), (1, 1, 0.5), (-1, 1, 1), (0.5, 0.5, 1.5))):
        empty = stage.link(bpy.data.objects.new("Instance", None))
        empty.instance_type, empty.instance_collection = "COLLECTION", inside
        empty.location, empty.rotation_euler.z, empty.scale = (
            (1.6 * number - 2.4, -2.5, 0),
            0.4 * number,
            scale,
        )


def _on_vertices(stage):
    """A ball on each of nine vertices."""
    points = [(0.9 * x, 0.9 * y, 0) for x in (-1, 0, 1) for y in (-1, 0, 1)]
    parent = stage.mesh(points, [(0, 3, 4, 1), (1, 4, 5, 2), (3, 6, 7, 4), (4, 7, 8, 5)], stage.gray(0.2))
    parent.location, parent.instance_type = (-2.5, 1.5, 0.35), "VERTS"
    child = stage.sphere(0.35, 0.8)
    child.parent = parent


def _modifiers(stage):
    """A plate that is mirrored, thickened, rounded and repeated, and a box that is smoothed."""
    plate = stage.mesh(
        [(0.05, -0.6, 0), (0.5, -0.6, 0), (0.5, 0.6, 0.4), (0.05, 0.6, 0.4)], [(0, 1, 2, 3)], stage.gray(0.6)
    )
    plate.location = (0.6, 1.5, 0.3)
    plate.modifiers.new("Mirror", "MIRROR")
    plate.modifiers.new("Solidify", "SOLIDIFY").thickness = 0.15
    bevel = plate.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments = 0.04, 2
    array = plate.modifiers.new("Array", "ARRAY")
    array.count, array.relative_offset_displace = 3, (1.15, 0, 0.3)
    stage.box((-0.6, 3.4, 0), (0.6, 4.6, 1.6), 0.7).modifiers.new("Subdivision", "SUBSURF").render_levels = 3
