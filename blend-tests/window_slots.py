"""The window: a material goes where it was asked for, whatever is selected or renamed until it is there."""

import bpy

from support import inputs, window
from support.reading import Held, large_file, module


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (import_of_a_model, import_of_a_btf, undone))


def _begin(path, owner, name):
    """An import into the cube's slot, which is active; reading is held up by `name` of `owner`."""
    cube = bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    with window.override():
        bpy.ops.mesh.primitive_plane_add()
        plane = bpy.context.object
        bpy.context.view_layer.objects.active = cube
        bpy.ops.ed.undo_push(message="before")
        held = Held(owner, name)
        assert bpy.ops.velour.load_material("INVOKE_DEFAULT", filepath=str(path)) == {"RUNNING_MODAL"}
    return cube, plane, held


def _swap(cube, plane):
    """The plane is active, and called as the cube was."""
    bpy.context.view_layer.objects.active = plane
    cube.name = "Renamed"
    plane.name = "Cube"


def _check(cube, plane, name):
    assert plane.active_material is None, plane.active_material
    assert cube.active_material.name == name, cube.active_material
    assert not cube.velour.is_property_set("jobs")


def import_of_a_model(folder):
    path = large_file(folder, "paint.velour", 50_000)
    cube, plane, held = _begin(path, module("operators.load_material"), "found_file")
    yield 0.3
    _swap(cube, plane)
    held.release()
    yield from window.at_rest()
    _check(cube, plane, "paint")


def import_of_a_btf(folder):
    """Which another operator makes, when the file is known; an undo brings the old material back."""
    path = inputs.quarters_btf()
    cube, plane, held = _begin(path, module("operators.compress_btf"), "_read")
    before = cube.active_material.name
    yield 1.0
    _swap(cube, plane)
    held.release()
    yield from window.at_rest()
    _check(cube, plane, path.stem)
    with window.override():
        bpy.ops.ed.undo()
    yield 0.2
    materials = [each.active_material for each in bpy.data.objects if each.type == "MESH"]
    assert {each.name for each in materials if each} == {before}, materials


def undone(folder):
    """The mark goes with an undo to what was before; names are left."""
    path = large_file(folder, "undone.velour", 50_000)
    cube, plane, held = _begin(path, module("operators.load_material"), "found_file")
    plane.location.x = 3
    with window.override():
        bpy.ops.ed.undo_push(message="moved")
        bpy.ops.ed.undo()
    cube, plane = bpy.data.objects["Cube"], bpy.data.objects["Plane"]
    bpy.context.view_layer.objects.active = plane
    held.release()
    yield from window.at_rest()
    _check(cube, plane, "undone")
