"""The window: files dropped on what a 3D viewport shows, one view or four, all objects or some."""

from types import SimpleNamespace

import bpy
from bpy_extras import view3d_utils
from mathutils import Vector
from velour.operators.slots import slot_under

from support import inputs, window

_TURNS = 300  # of 0.1 s that an import may take
_AT = Vector((1.5, -1.0, 0.8))  # seen at other places from each side


def start(folder):
    """Called by the harness once the window is there."""
    tests = [quad_view, toolbar, local_view, local_view_of_instances, import_under_the_cursor]
    newer = [handler, drop]
    if hasattr(bpy.types, "FileHandler"):
        window.run(folder, [*tests, *newer], viewport=True)
    else:
        window.run(folder, tests, newer, "files can be dropped from Blender 4.1 on", viewport=True)


def _cube(name, size=0.4, at=_AT):
    bpy.ops.mesh.primitive_cube_add(size=size, location=at)
    bpy.context.view_layer.objects.active.name = name
    return bpy.context.view_layer.objects.active


def _view():
    """A 3D viewport without the objects of the start."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    return next(area for area in window.first().screen.areas if area.type == "VIEW_3D")


def _regions(area, kind="WINDOW"):
    return [region for region in area.regions if region.type == kind]


def _in(area, region):
    return window.in_context(window=window.first(), area=area, region=region)


def _place(region, at):
    """Position of a point of the scene, in the window's pixels."""
    x, y = view3d_utils.location_3d_to_region_2d(region, bpy.context.region_data, at)
    return int(region.x + x), int(region.y + y)


def _under(area, region, at=_AT):
    """The name of the object under a point of the scene, or None."""
    with _in(area, region):
        x, y = _place(region, at)
        slot = slot_under(bpy.context, SimpleNamespace(mouse_x=x, mouse_y=y))
    return slot and slot.object


def quad_view(_folder):
    """Each view has its own cursor's ray."""
    area = _view()
    _cube("Cube")
    with _in(area, _regions(area)[0]):
        bpy.ops.screen.region_quadview()
    yield 0.7
    regions = _regions(area)
    assert len(regions) == 4, regions
    found = [(_under(area, region), _under(area, region, _AT + Vector((1, 1, 1)))) for region in regions]
    assert found == 4 * [("Cube", None)], found


def toolbar(_folder):
    """Nothing lies under what covers the view."""
    area = _view()
    _cube("Cube", 50, (0, 0, 0))
    yield 0.3
    (region,) = _regions(area, "TOOLS")
    with _in(area, region):
        event = SimpleNamespace(mouse_x=region.x + 5, mouse_y=region.y + 5)
        assert slot_under(bpy.context, event) is None


def _show_alone(area, *objects):
    for obj in bpy.data.objects:
        obj.select_set(obj in objects)
    with _in(area, _regions(area)[0]):
        bpy.ops.view3d.localview(frame_selected=False)
    return 0.7


def local_view(_folder):
    """What is not in it hides nothing."""
    area = _view()
    _cube("Around", 1.0)
    inner = _cube("Inner")
    yield 0.3
    (region,) = _regions(area)
    assert _under(area, region) == "Around"
    yield _show_alone(area, inner)
    assert _under(area, region) == "Inner"
    assert _under(area, region, _AT + Vector((0, 0, 0.45))) is None


def local_view_of_instances(_folder):
    """They are in it where the object is that they hang on."""
    area = _view()
    cube = _cube("Cube")
    collection = bpy.data.collections.new("Cubes")
    collection.objects.link(cube)
    cube.location = (0, 0, 0)
    shown, hidden = (_instances(name, collection) for name in ("Shown", "Hidden"))
    hidden.location = _AT + Vector((-1, 0, 0))
    yield 0.3
    (region,) = _regions(area)
    assert _under(area, region, hidden.location) == "Cube"
    yield _show_alone(area, shown)
    found = [_under(area, region, at) for at in (_AT, hidden.location, Vector())]
    assert found == ["Cube", None, None], found


def _instances(name, collection):
    empty = bpy.data.objects.new(name, None)
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    empty.location = _AT
    bpy.context.scene.collection.objects.link(empty)
    return empty


def _point_at(area, region, at):
    with _in(area, region):
        window.first().cursor_warp(*_place(region, at))


def _arrived(obj):
    """The turns until the import is done."""
    for _ in range(_TURNS):
        yield 0.1
        if obj.active_material and not bpy.context.window_manager.velour.running:
            return
    raise AssertionError(f"{obj.name} wears nothing")


def _model(folder, name):
    path = folder / name
    path.write_bytes(inputs.brushed_model())
    return path


def import_under_the_cursor(folder):
    """As Blender calls it where a file is dropped."""
    area, path = _view(), _model(folder, "under.velour")
    cube, other = _cube("Cube"), _cube("Other", at=(-2, 0, 0))
    with _in(area, _regions(area)[0]):
        bpy.ops.screen.region_quadview()
    yield 0.7
    region = _regions(area)[-1]
    _point_at(area, region, _AT)
    yield 0.5
    with _in(area, region):
        assert bpy.ops.velour.load_material("INVOKE_DEFAULT", filepath=str(path)) == {"RUNNING_MODAL"}
    yield from _arrived(cube)
    assert cube.active_material.name.startswith("under")
    assert other.active_material is None


def handler(_folder):
    """Measured materials are ours, pictures are not; only where materials are at home."""
    ours = bpy.types.VELOUR_FH_measured
    endings = set(ours.bl_file_extensions.split(";"))
    assert endings == {".velour", ".binary", ".bsdf", ".brdf", ".btf"}, endings
    areas = {area.type: area for area in window.first().screen.areas}
    taken = {kind for kind, area in areas.items() if ours.poll_drop(SimpleNamespace(area=area))}
    assert taken == {"VIEW_3D", "PROPERTIES"}, (taken, areas)
    assert not ours.poll_drop(SimpleNamespace(area=None))
    yield 0.1


def drop(folder):
    """By Blender's own operator of what is dropped: it asks the handlers."""
    area, path = _view(), _model(folder, "dropped.velour")
    cube = _cube("Cube")
    yield 0.5
    (region,) = _regions(area)
    _point_at(area, region, _AT)
    yield 0.5
    _drop(area, region, path)
    yield from _arrived(cube)
    assert cube.active_material.name.startswith("dropped")
    known = len(bpy.data.materials)
    area.type = "TEXT_EDITOR"
    yield 0.3
    _drop(area, _regions(area)[0], path)
    yield 2.0
    assert len(bpy.data.materials) == known, "a text editor took it"


def _drop(area, region, path):
    with _in(area, region):
        bpy.ops.wm.drop_import_file("INVOKE_DEFAULT", directory=str(path.parent), files=[{"name": path.name}])
