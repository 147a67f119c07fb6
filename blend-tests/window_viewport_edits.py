"""Edits in the rendered viewport: what was exported piece by piece is what a whole export makes."""

import contextlib
import math
import time

import bpy
import numpy as np

from support import scenes, viewport, window

_SKY = "/studiolights/world/courtyard.exr"
SCREEN = "700x460"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (edits, undo, selection, during_a_build, a_long_drag), viewport=True)


def _scene():
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    cube = bpy.data.objects["Cube"]
    cube.active_material = scenes.diffuse_material((0.8, 0.3, 0.1), "Orange")
    twin = bpy.data.objects.new("Twin", cube.data)
    twin.location = (3, 0, 0)
    bpy.context.scene.collection.objects.link(twin)
    with window.override():
        ball = scenes.add_sphere(scenes.diffuse_material((0.2, 0.6, 0.3), "Green"))
    ball.name, ball.location = "Ball", (0, 3, 0)


def _socket(material, name):
    node = next(n for n in bpy.data.materials[material].node_tree.nodes if n.type == "BSDF_DIFFUSE")
    return node.inputs[name]


def _move():
    bpy.data.objects["Cube"].location.z += 1


def _energy():
    bpy.data.lights["Light"].energy *= 3


def _lamp_moves():
    bpy.data.objects["Light"].location.x -= 4


def _lamp_node():
    lamp = bpy.data.lights["Light"]
    lamp.use_nodes = True
    lamp.node_tree.nodes["Emission"].inputs["Color"].default_value = (0.2, 0.9, 0.4, 1)


def _lamp_node_changes():
    bpy.data.lights["Light"].node_tree.nodes["Emission"].inputs["Strength"].default_value = 2.0


def _color():
    _socket("Orange", "Color").default_value = (0.1, 0.2, 0.9, 1)


def _world():
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.2


def _world_brighter():
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.9


def _other_world():
    scenes.set_world((1.0, 0.5, 0.4), 0.4)


def _sky():
    world = bpy.context.scene.world.node_tree
    picture, mapping = world.nodes.new("ShaderNodeTexEnvironment"), world.nodes.new("ShaderNodeMapping")
    picture.image = bpy.data.images.load(bpy.utils.system_resource("DATAFILES") + _SKY)
    place = world.nodes.new("ShaderNodeTexCoord")
    world.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    world.links.new(mapping.outputs[0], picture.inputs["Vector"])
    world.links.new(picture.outputs[0], world.nodes["Background"].inputs["Color"])


def _sky_turns():
    bpy.context.scene.world.node_tree.nodes["Mapping"].inputs["Rotation"].default_value[2] = 1


def _vertex():
    mesh = bpy.data.meshes["Cube"]
    mesh.vertices[0].co.x += 1.5
    mesh.update()


def _modifier():
    bpy.data.objects["Ball"].modifiers.new("Array", "ARRAY")


def _modifier_changes():
    bpy.data.objects["Ball"].modifiers["Array"].count = 3


def _added():
    with window.override():
        ground = scenes.add_plane(bpy.data.materials["Green"], size=20)
    ground.name, ground.location.z = "Ground", -2


def _removed():
    bpy.data.objects.remove(bpy.data.objects["Twin"])


def _hidden():
    bpy.data.objects["Ball"].hide_set(True)


def _shown():
    bpy.data.objects["Ball"].hide_set(False)


def _other_material():
    bpy.data.objects["Ground"].material_slots[0].material = bpy.data.materials["Orange"]


def _glows():
    tree = bpy.data.materials["Green"].node_tree
    glow = tree.nodes.new("ShaderNodeEmission")
    glow.inputs["Strength"].default_value = 2
    tree.links.new(glow.outputs[0], tree.nodes["Material Output"].inputs["Surface"])


def _instances():
    collection = bpy.data.collections.new("Many")
    collection.objects.link(bpy.data.objects["Ball"])
    for i in range(4):
        empty = bpy.data.objects.new(f"Empty{i}", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location = (3 * math.cos(i), 3 * math.sin(i), 2)
        bpy.context.scene.collection.objects.link(empty)


def _instances_follow():
    bpy.data.objects["Empty2"].scale = (0.5, 0.5, 0.5)


def _textured():
    image = bpy.data.images.new("Checks", 8, 8)
    image.pixels = np.tile(np.float32([1, 0, 0, 1, 0, 1, 0, 1]), 32).tolist()
    tree = bpy.data.materials["Orange"].node_tree
    picture = tree.nodes.new("ShaderNodeTexImage")
    picture.image = image
    tree.links.new(picture.outputs[0], _socket("Orange", "Color"))


def _painted():
    image = bpy.data.images["Checks"]
    image.pixels = np.tile(np.float32([1, 1, 0, 1, 0, 1, 1, 1]), 32).tolist()
    image.update()
    image.update_tag()


def _attribute():
    """Adds a color attribute to the cube's mesh, which its twin shows as well."""
    paint = bpy.data.meshes["Cube"].attributes.new("paint", "FLOAT_COLOR", "POINT")
    for i, element in enumerate(paint.data):
        element.color = (i % 2, i // 2 % 2, i // 4, 1)
    tree = bpy.data.materials["Orange"].node_tree
    shown = tree.nodes.new("ShaderNodeVertexColor")
    shown.layer_name = "paint"
    tree.links.new(shown.outputs[0], _socket("Orange", "Color"))


def _attribute_changes():
    mesh = bpy.data.meshes["Cube"]
    for element in mesh.attributes["paint"].data:
        element.color = (0.1, 0.9, 0.9, 1)
    mesh.update()


def _scene_lights_off():
    viewport.space().shading.use_scene_lights_render = False


def _scene_lights_on():
    viewport.space().shading.use_scene_lights_render = True


def _studio_light():
    shading = viewport.space().shading
    shading.use_scene_world_render, shading.studio_light = False, "courtyard.exr"


def _studio_light_turns():
    viewport.space().shading.studiolight_rotate_z = 1.0


def _scene_world():
    viewport.space().shading.use_scene_world_render = True


def _film():
    bpy.context.scene.render.film_transparent = True


def _frame():
    bpy.data.objects["Cube"].keyframe_insert("location", frame=1)
    bpy.data.objects["Cube"].location.x += 2
    bpy.data.objects["Cube"].keyframe_insert("location", frame=5)
    bpy.context.scene.frame_set(5)


def _turned():
    viewport.space().region_3d.view_rotation.rotate(__import__("mathutils").Euler((0, 0, 0.5)))


_EDITS = (
    *(_move, _energy, _lamp_moves, _lamp_node, _lamp_node_changes, _color),
    *(_world, _sky, _sky_turns, _world_brighter, _other_world),
    *(_vertex, _modifier, _modifier_changes),
    *(_added, _removed, _hidden, _shown, _other_material, _glows, _instances, _instances_follow),
    *(_textured, _painted, _attribute, _attribute_changes),
    *(_scene_lights_off, _scene_lights_on, _studio_light, _studio_light_turns, _scene_world),
    *(_film, _frame, _turned),
)


def edits(folder):
    _scene()
    viewport.show(samples=8)
    bpy.context.scene.render.preview_pixel_size = "4"
    yield from viewport.finished()
    last = viewport.pixels()
    for edit in _EDITS:
        exported = viewport.the_one()._live
        edit()
        yield from viewport.seen(last, edit.__name__)
        now = viewport.pixels()
        assert edit is _painted or viewport.the_one()._live is exported, f"{edit.__name__}: all exported anew"
        viewport.the_one().forget_scene()
        # Relations anew: else Blender 3.4 would not tell of changes of a picture only just shown.
        bpy.data.meshes.remove(bpy.data.meshes.new("Another"))
        bpy.context.scene.update_tag()
        yield from viewport.finished()
        last = viewport.pixels()
        assert np.array_equal(now, last), f"{edit.__name__}: {_difference(now, last)}"


def _difference(a, b):
    return f"{np.count_nonzero((a != b).any(-1))} pixels differ, by at most {np.abs(a - b).max()}"


def undo(folder):
    _scene()
    viewport.show(samples=8)
    bpy.context.scene.render.preview_pixel_size = "4"
    with window.override():
        bpy.ops.ed.undo_push(message="before")
    yield from viewport.finished()
    before = viewport.pixels()
    with window.override():
        bpy.data.objects["Cube"].location.z += 1
        bpy.ops.ed.undo_push(message="moved")
    yield from viewport.finished()
    moved = viewport.pixels()
    assert not np.array_equal(before, moved)
    with window.override():
        bpy.ops.ed.undo()
    yield from viewport.finished()
    assert np.array_equal(viewport.pixels(), before)
    with window.override():
        bpy.ops.ed.redo()
    yield from viewport.finished()
    assert np.array_equal(viewport.pixels(), moved)


def selection(folder):
    """Changes nothing, and so begins nothing anew."""
    _scene()
    viewport.show(samples=1 << 20)
    yield from viewport.until(lambda: viewport.samples() > 16, "no picture")
    samples = viewport.job().picture().samples
    bpy.data.objects["Cube"].select_set(False)
    bpy.context.view_layer.objects.active = bpy.data.objects["Ball"]
    yield 0.3
    assert viewport.job().picture().samples >= samples


def during_a_build(folder):
    """Edits do not wait for the hierarchy of a large mesh, which is built once."""
    _scene()
    with window.override():
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=1500, y_subdivisions=1500, size=20)
    bpy.context.view_layer.objects.active.location.z = -2
    engine_viewport = viewport.addon("engine.viewport").Viewport
    update, held = engine_viewport.update, []

    def timed(self, *given):
        begin = time.monotonic()
        update(self, *given)
        held.append(time.monotonic() - begin)

    engine_viewport.update = timed
    try:
        viewport.show(samples=8)
        yield from viewport.until(lambda: held, "it is not exported")
        begin = time.monotonic()
        while not viewport.is_seen():
            bpy.data.lights["Light"].energy += 1
            bpy.data.objects["Cube"].location.z += 0.01
            yield viewport.TURN
        built = time.monotonic() - begin
    finally:
        engine_viewport.update = update
    assert len(held) > 5, held
    assert max(held[1:]) < max(0.3 * built, 0.2), (held, built)
    yield from viewport.finished()


def a_long_drag(folder):
    """What is dragged on and on is seen meanwhile, though a picture takes longer than a turn of the mouse."""
    _scene()
    viewport.show(samples=8)
    bpy.context.scene.render.preview_pixel_size = "4"
    yield from viewport.finished()
    cube, pictures = bpy.data.objects["Cube"], set()
    with _slow_pictures(0.4):
        for _ in range(40):
            cube.location.z += 0.05
            yield 0.05
            pictures.add(viewport.shown_picture().shown_at)
    assert len(pictures) > 4, f"{len(pictures) - 1} pictures of 40 moves"
    yield from viewport.finished()
    last = viewport.pixels()
    viewport.the_one().forget_scene()
    yield from viewport.finished()
    assert np.array_equal(viewport.pixels(), last), "the last move is not shown"


@contextlib.contextmanager
def _slow_pictures(seconds):
    """A scene that takes long to get ready: a job runs on, and shows nothing, for so many seconds."""
    job = viewport.addon("native.progressive").ProgressiveJob
    start, poll, picture, began = job.start, job.poll, job.picture, {}

    def started(self):
        began[self] = time.monotonic()
        start(self)

    def late(ask, **until_then):
        def asked(self):
            found = ask(self)
            is_late = time.monotonic() < began.get(self, 0.0) + seconds
            return found._replace(**until_then) if is_late else found

        return asked

    job.start, job.poll, job.picture = started, late(poll, state="running"), late(picture, width=0)
    try:
        yield
    finally:
        job.start, job.poll, job.picture = start, poll, picture
