"""The window: what becomes of a fit whose material, or file, changes while it runs."""

import bpy

from support import inputs, scenes, window

_TURNS = 600  # of 0.1 s that a fit may take


def start(folder):
    """Called by the harness once the window is there."""
    window.run(
        folder, (renamed, copied, deleted, undone, new_file, loaded_file, scene_removed, scene_fit_renamed)
    )


def _cube_with_fit(**settings):
    """A cube with a measured material that is being fitted, and the name of the model before."""
    material = scenes.measured_material(inputs.model_bytes(inputs.glossy_measurement()))
    node = scenes.velour_node(material)
    image = bpy.data.images.new("glossy.binary", 1, 1)
    image.source, image.filepath_raw = "FILE", str(inputs.glossy_measurement())
    node.velour.measurement = image
    cube = bpy.context.view_layer.objects["Cube"]
    cube.active_material = material
    bpy.context.view_layer.objects.active = cube
    before = node.image.name
    with window.override():
        bpy.ops.ed.undo_push(message="before the fit")
        settings = {"model": "SCATTERED", "tolerance": 0.001, "max_lobes": 8, **settings}
        assert bpy.ops.velour.fit("INVOKE_DEFAULT", material=material.name, **settings) == {"RUNNING_MODAL"}
    assert bpy.context.window_manager.velour.running
    return material, before


def _end():
    """Turns until nothing runs."""
    for _ in range(_TURNS):
        yield 0.1
        if not bpy.context.window_manager.velour.running:
            return
    raise AssertionError("the fit goes on")


def _model(name):
    return scenes.velour_node(bpy.data.materials[name]).image.name


def renamed(folder):
    material, before = _cube_with_fit()
    material.name = "Another"
    bpy.data.materials.new("Paint")  # takes the old name
    yield from _end()
    assert _model("Another") != before, "the model is lost"
    assert scenes.velour_node(bpy.data.materials["Another"]).image.name.startswith("Another")


def copied(folder):
    """The original gets the model, the copy keeps the one before."""
    material, before = _cube_with_fit()
    material.copy().name = "A copy"  # comes first by name
    yield from _end()
    assert _model("Paint") != before
    assert _model("A copy") == before


def deleted(folder):
    """The model is kept among the images."""
    material, before = _cube_with_fit()
    bpy.data.materials.remove(material)
    yield from _end()
    kept = [image for image in bpy.data.images if image.name.startswith("Paint") and image.name != before]
    assert len(kept) == 1, [image.name for image in bpy.data.images]
    assert kept[0].use_fake_user
    assert bytes(kept[0].packed_file.data[:4]) == b"v/1\x01"


def undone(folder):
    """To before the fit was begun, while it runs: its result is one step, which an undo takes back."""
    _material, before = _cube_with_fit()
    bpy.context.view_layer.objects["Cube"].location.x = 3
    with window.override():
        bpy.ops.ed.undo_push(message="moved")
        bpy.ops.ed.undo()
        bpy.ops.ed.redo()
        bpy.ops.ed.undo()
    yield from _end()
    assert _model("Paint") != before, "the model is lost"
    with window.override():
        bpy.ops.ed.undo()
    yield 0.2
    assert _model("Paint") == before


def _cancelled():
    """Nothing runs, and a fit can be started again."""
    yield 0.5
    state = bpy.context.window_manager.velour
    assert not state.running, "a fit of a file that is gone"
    assert state.waiting == 0
    _cube_with_fit(tolerance=0.2, max_lobes=2)
    yield from _end()


def new_file(folder):
    _cube_with_fit(max_lobes=64)
    yield 0.3
    window.fresh_file()
    yield from _cancelled()


def loaded_file(folder):
    path = str(folder / "loaded.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    _cube_with_fit(max_lobes=64)
    yield 0.3
    bpy.ops.wm.open_mainfile(filepath=path)
    assert "Paint" not in bpy.data.materials
    yield from _cancelled()


def scene_removed(folder):
    """The scene goes, and the window shows another; the material stays."""
    _material, before = _cube_with_fit()
    scene = bpy.context.scene
    bpy.context.window_manager.windows[0].scene = bpy.data.scenes.new("Other")
    yield 0.3  # the window's own work with the old one
    bpy.data.scenes.remove(scene)
    yield from _end()
    assert _model("Paint") != before


def scene_fit_renamed(folder):
    """A fit for the scene finds the material, too, and the model of one that is deleted is kept."""
    material, _before = _cube_with_fit(model="PARAMETRIC", tolerance=0.05, max_lobes=4)
    yield from _end()
    scenes.use_engine()
    with window.override():
        assert bpy.ops.velour.fit_for_scene("INVOKE_DEFAULT", material="Paint", current_frame=True) == {
            "RUNNING_MODAL"
        }
    material.name = "Another"
    yield from _end()
    assert scenes.velour_node(bpy.data.materials["Another"]).velour.scene_model is not None, (
        "the model is lost"
    )
