"""The window: what becomes of a fit whose material, or file, changes while it runs."""

from unittest import mock

import bpy

from support import inputs, scenes, window
from support.reading import module

_QUICK = {"tolerance": 0.2, "max_lobes": 2}


def start(folder):
    """Called by the harness once the window is there."""
    of_a_fit = (renamed, copied, deleted, undone, undone_before_its_approximation, saved_meanwhile)
    of_its_file = (new_file, loaded_file, scene_removed)
    of_its_measurement = (measurement_cleared, measurement_replaced)
    in_line = (outline_after_a_fit, approximation_after_a_fit, scene_fit_after_a_fit, waiting_given_up)
    window.run(folder, (*of_a_fit, *of_its_file, *of_its_measurement, *in_line, scene_fit_renamed))


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
        settings = {"model": "SCATTERED", "tolerance": 0.001, "max_lobes": 3, **settings}
        assert bpy.ops.velour.fit("INVOKE_DEFAULT", material=material.name, **settings) == {"RUNNING_MODAL"}
    assert bpy.context.window_manager.velour.running
    return material, before


def _model(name):
    return scenes.velour_node(bpy.data.materials[name]).image.name


def renamed(folder):
    material, before = _cube_with_fit()
    material.name = "Another"
    bpy.data.materials.new("Paint")  # takes the old name
    yield from window.at_rest()
    assert _model("Another") != before, "the model is lost"
    assert scenes.velour_node(bpy.data.materials["Another"]).image.name.startswith("Another")


def copied(folder):
    """The original gets the model, the copy keeps the one before."""
    material, before = _cube_with_fit()
    material.copy().name = "A copy"  # comes first by name
    yield from window.at_rest()
    assert _model("Paint") != before
    assert _model("A copy") == before


def deleted(folder):
    """The model is kept among the images."""
    material, before = _cube_with_fit()
    bpy.data.materials.remove(material)
    yield from window.at_rest()
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
    yield from window.at_rest()
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
    yield from window.at_rest()


def undone_before_its_approximation(folder):
    """A redo brings the model back: the fit may have taken long."""
    with mock.patch.object(module("operators.approximate"), "_LONG_SECONDS", 0.0):
        _material, before = _cube_with_fit()
        yield from window.until(lambda: _model("Paint") != before, "a model")
        after = _model("Paint")
        with window.override():
            bpy.ops.ed.undo()
        assert _model("Paint") == before
        yield from window.at_rest()
    with window.override():
        bpy.ops.ed.redo()
    assert _model("Paint") == after


def saved_meanwhile(folder):
    """As Blender saves temporary files, which it does not while an operator is modal."""
    autosave = module("operators.background_job")._autosave
    asked = bpy.context.preferences.filepaths
    asked.temporary_directory = str(folder)
    assert asked.use_auto_save_temporary_files
    _cube_with_fit(tolerance=1e-6, max_lobes=24)
    autosave._saved -= 60 * asked.auto_save_time + 1
    with mock.patch.object(module("operators.autosave"), "_QUIET_SECONDS", 0.0):
        yield from window.until(lambda: list(folder.glob("*_autosave.blend")), "an autosave")
    assert bpy.context.window_manager.velour.running
    asked.temporary_directory = str(folder / "missing")
    autosave._saved = before = autosave._saved - 60 * asked.auto_save_time - 1
    with mock.patch.object(module("operators.autosave"), "_QUIET_SECONDS", 0.0):
        yield from window.until(lambda: autosave._saved != before, "an attempt that fails")
    yield 0.3
    assert bpy.context.window_manager.velour.running, "a file that cannot be saved ended the job"
    assert bpy.data.filepath == ""
    with window.override():
        bpy.ops.ed.undo_push(message="changed")
        assert bpy.data.is_dirty
        module("operators.autosave").save(str(folder))
        assert bpy.data.is_dirty, "Blender would not ask before it closes"
    bpy.context.window_manager.velour.cancel_requested = True
    yield from window.at_rest()


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
    yield from window.at_rest()
    assert _model("Paint") != before


def measurement_cleared(folder):
    """The model comes all the same, as one step and without an error."""
    material, before = _cube_with_fit(**_QUICK)
    scenes.velour_node(material).velour.measurement = None
    with window.override():
        bpy.ops.ed.undo_push(message="cleared")
    fit, ended = module("operators.fit").VELOUR_OT_fit, []
    put = fit._put
    with mock.patch.object(fit, "_put", lambda operator: ended.append(put(operator)) or ended[-1]):
        yield from window.at_rest()
    assert len(ended) == 1, "it has ended in an error"
    assert _model("Paint") != before, "the model is lost"
    with window.override():
        bpy.ops.ed.undo()
    assert _model("Paint") == before


def measurement_replaced(folder):
    """What is known of a file is not said of another one."""
    material, before = _cube_with_fit(**_QUICK)
    other = bpy.data.images.new("lambert.binary", 1, 1)
    other.source, other.filepath_raw = "FILE", str(inputs.lambert_measurement())
    scenes.velour_node(material).velour.measurement = other
    yield from window.at_rest()
    assert _model("Paint") != before
    assert bpy.data.images["lambert.binary"].velour.sha256 == ""
    with window.override():
        assert bpy.ops.velour.fit(material="Paint", **_QUICK) == {"FINISHED"}


def _info(material):
    image = scenes.velour_node(material).image
    with inputs.native().Model.from_bytes(image.packed_file.data, image.name) as model:
        return model.info()


def _invoke(operator, **arguments):
    with window.override():
        assert operator("INVOKE_DEFAULT", **arguments) == {"RUNNING_MODAL"}


def outline_after_a_fit(folder):
    """It comes to the model of the fit that it has waited for."""
    with window.override():
        bpy.ops.mesh.primitive_plane_add(size=0.5)
        pane = bpy.context.object
    pane.velour.period = (1, 1)
    name = pane.name
    material, _before = _cube_with_fit(**_QUICK)
    had = _info(material)
    _invoke(bpy.ops.velour.add_votf, material="Paint", structure=name, texels=8)
    assert bpy.context.window_manager.velour.waiting == 1
    yield from window.at_rest()
    has = _info(bpy.data.materials["Paint"])
    assert "shell" in has
    assert (has["model"], has["lobes"]) != (had["model"], had["lobes"]), "it is of the model before"


def approximation_after_a_fit(folder):
    _material, before = _cube_with_fit(**_QUICK)
    _invoke(bpy.ops.velour.approximate, material="Paint")
    yield from window.at_rest()
    material = bpy.data.materials["Paint"]
    assert _model("Paint") != before
    group = module("export.nodes").approximation_node(material).node_tree
    assert group.velour.model == scenes.velour_node(material).image.velour.sha256, "it is of the model before"


def scene_fit_after_a_fit(folder):
    """It begins with the model of that, and looks at the frames when it is there."""
    _material, before = _cube_with_fit(model="PARAMETRIC", tolerance=0.05, max_lobes=4)
    scenes.use_engine()
    _invoke(bpy.ops.velour.fit_for_scene, material="Paint", current_frame=True)
    yield from window.at_rest()
    assert _model("Paint") != before
    assert scenes.velour_node(bpy.data.materials["Paint"]).velour.scene_model is not None


def waiting_given_up(folder):
    """All that wait leave the line, and what runs goes on."""
    material, before = _cube_with_fit()
    scenes.use_engine()
    for name in ("Second", "Third"):
        material.copy().name = name
        _invoke(bpy.ops.velour.fit, material=name, users="SINGLE", **_QUICK)
    _invoke(bpy.ops.velour.fit_for_scene, material="Paint", current_frame=True)
    state = bpy.context.window_manager.velour
    assert state.waiting == 3
    bpy.ops.velour.cancel_waiting()
    for _ in range(20):
        yield 0.1
        if not state.waiting:
            break
    assert (state.running, state.subject, state.waiting) == (True, "Paint", 0)
    yield from window.at_rest()
    assert _model("Paint") != before, "the first one was canceled"
    assert (_model("Second"), _model("Third")) == (before, before), "one that waited was made"
    assert scenes.velour_node(bpy.data.materials["Paint"]).velour.scene_model is None


def scene_fit_renamed(folder):
    """A fit for the scene finds the material and the scene, too, whatever they are called."""
    material, _before = _cube_with_fit(model="PARAMETRIC", tolerance=0.05, max_lobes=4)
    yield from window.at_rest()
    scenes.use_engine()
    with window.override():
        assert bpy.ops.velour.fit_for_scene("INVOKE_DEFAULT", material="Paint", current_frame=True) == {
            "RUNNING_MODAL"
        }
    material.name, bpy.context.scene.name = "Another", "Shot"
    yield from window.at_rest()
    assert scenes.velour_node(bpy.data.materials["Another"]).velour.scene_model is not None, (
        "the model is lost"
    )
