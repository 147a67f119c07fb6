"""The window: operators read files beside it, whatever becomes of them and of the .blend meanwhile."""

from unittest import mock

import bpy

from support import inputs, scenes, window
from support.reading import LARGE, TILES, Held, check_turns, large_file, module, shown

_ACCEPT = "accept_file.VELOUR_OT_accept_file"
_KEEP = "placement.VELOUR_OT_keep_uv_density"


def start(folder):
    """Called by the harness once the window is there."""
    accept = (accept_beside_the_window, accept_undone, accept_deleted, accept_another, accept_loaded_file)
    placement = (density_beside_the_window, density_of_what_is_gone)
    jobs = (accept_while_another_works, outline_beside_the_window, outline_deleted)
    scene = (
        scene_beside_the_window,
        scene_cancelled,
        scene_of_another_model,
        scene_undone,
        scene_loaded_file,
    )
    window.run(folder, (*accept, *placement, *jobs, *scene))


def _class(name):
    file, _, kind = name.partition(".")
    return getattr(module(f"operators.{file}"), kind)


class _Timed:
    """Seconds of the main thread in each call of some methods of an operator."""

    def __init__(self, owner, *names):
        self.seconds = []
        self._patches = [
            mock.patch.object(owner, name, window.timed(getattr(owner, name), self.seconds)) for name in names
        ]

    def __enter__(self):
        for patch in self._patches:
            patch.start()
        return self

    def __exit__(self, *_exception):
        for patch in self._patches:
            patch.stop()


def _state():
    return bpy.context.window_manager.velour


def _held_content():
    return Held(module("export.files").StoredFile, "content")


def _invoke(operator, **arguments):
    with window.override():
        assert operator("INVOKE_DEFAULT", **arguments) == {"RUNNING_MODAL"}


def _reading():
    """Turns until panels say that a file is read."""
    yield from window.until(lambda: _state().running and _state().stage == "reading", "a file is read")


def _changed(folder, name, size):
    """A material whose model's file has changed since it was chosen: the image, and the new SHA-256."""
    image = shown(large_file(folder, name, size))
    path = large_file(folder, name, size + 1)
    return image, module("export.files").sha256(path.read_bytes())


def accept_beside_the_window(folder):
    image, digest = _changed(folder, "large.velour", LARGE)
    with _Timed(_class(_ACCEPT), "_read", "_use") as timed:
        held = _held_content()
        _invoke(bpy.ops.velour.accept_file)
        assert _state().reading == "Paint"
        yield 0.3
        window.screenshot(folder, "accepting")
        assert image.velour.sha256 != digest
        held.release()
        yield from window.at_rest()
    assert image.velour.sha256 == digest
    files = module("export.files")
    check_turns("accepting", timed.seconds, lambda: files.sha256(files.content(image, "Control")))


def accept_undone(folder):
    """The image is another one after an undo, and is accepted; one undo takes that back."""
    image, digest = _changed(folder, "undone.velour", 50_000)
    before, name = image.velour.sha256, image.name
    with window.override():
        bpy.ops.ed.undo_push(message="before")
    held = _held_content()
    _invoke(bpy.ops.velour.accept_file)
    bpy.data.objects["Cube"].location.x = 3
    with window.override():
        bpy.ops.ed.undo_push(message="moved")
        bpy.ops.ed.undo()
    held.release()
    yield from window.at_rest()
    assert bpy.data.images[name].velour.sha256 == digest
    with window.override():
        bpy.ops.ed.undo()
    assert bpy.data.images[name].velour.sha256 == before


def accept_deleted(folder):
    image, digest = _changed(folder, "deleted.velour", 50_000)
    held = _held_content()
    _invoke(bpy.ops.velour.accept_file)
    bpy.data.materials.remove(bpy.data.materials["Paint"])
    held.release()
    yield from window.at_rest()
    assert image.velour.sha256 != digest


def accept_another(folder):
    """A model that came meanwhile was not looked at."""
    _image, digest = _changed(folder, "one.velour", 50_000)
    held = _held_content()
    _invoke(bpy.ops.velour.accept_file)
    other = module("operators.measured").linked_model(str(large_file(folder, "two.velour", 60_000)), "old")
    scenes.velour_node(bpy.data.materials["Paint"]).image = other
    held.release()
    yield from window.at_rest()
    assert other.velour.sha256 == "old", digest


def accept_loaded_file(folder):
    """Another file ends it, and it can be begun again."""
    _changed(folder, "lost.velour", 50_000)
    held = _held_content()
    _invoke(bpy.ops.velour.accept_file)
    yield 0.2
    window.fresh_file()
    held.release()
    yield 0.5
    assert not _state().reading
    image, digest = _changed(folder, "next.velour", 50_000)
    _invoke(bpy.ops.velour.accept_file)
    yield from window.at_rest()
    assert image.velour.sha256 == digest


def accept_while_another_works(folder):
    """It does not stand in line behind an import."""
    image, digest = _changed(folder, "changed.velour", 50_000)
    held = Held(module("operators.load_material"), "found_file")
    _invoke(bpy.ops.velour.load_material, filepath=str(large_file(folder, "slow.velour", 50_000)), fit=False)
    _invoke(bpy.ops.velour.accept_file, material="Paint")
    for _ in range(100):
        yield 0.1
        if not _state().reading:
            break
    assert image.velour.sha256 == digest
    assert _state().running, "the import has not waited"
    held.release()
    yield from window.at_rest()


def _tiles(folder, name, size):
    """The cube's material, which has tiles of a known size; its placement."""
    shown(large_file(folder, name, size, TILES.read_bytes()))
    placement = scenes.velour_node(bpy.data.materials["Paint"]).velour.placement
    with window.override():
        bpy.ops.ed.undo_push(message="placed")
    return placement


def density_beside_the_window(folder):
    placement = _tiles(folder, "tiles.velour", LARGE)
    with _Timed(_class(_KEEP), "_read", "_use") as timed:
        held = _held_content()
        _invoke(bpy.ops.velour.keep_uv_density)
        yield 0.3
        assert tuple(placement.uv_density) == (0.0, 0.0)
        held.release()
        yield from window.at_rest()
    assert min(placement.uv_density) > 0.0
    image = scenes.velour_node(bpy.data.materials["Paint"]).image
    check_turns(
        "measuring", timed.seconds, lambda: module("export.files").read_model(image, "Control").close()
    )
    with window.override():
        bpy.ops.ed.undo()
    placement = scenes.velour_node(bpy.data.materials["Paint"]).velour.placement
    assert tuple(placement.uv_density) == (0.0, 0.0)


def density_of_what_is_gone(folder):
    """The object goes; then the material does."""
    for name, remove in (("Cube", bpy.data.objects), ("Paint", bpy.data.materials)):
        placement = _tiles(folder, f"{name}.velour", 50_000)
        held = _held_content()
        _invoke(bpy.ops.velour.keep_uv_density)
        remove.remove(remove[name])
        held.release()
        yield from window.at_rest()
        if name == "Cube":
            assert tuple(placement.uv_density) == (0.0, 0.0)
            bpy.ops.mesh.primitive_cube_add()
            bpy.context.object.name = "Cube"
            bpy.data.materials.remove(bpy.data.materials["Paint"])


def _begin_outline(folder, name, size):
    """Starts the VOTF of a pane with gaps beside it. Returns the model's image and what delays reading it."""
    image = shown(large_file(folder, name, size))
    with window.override():
        bpy.ops.mesh.primitive_plane_add(size=0.5)
        pane = bpy.context.object
        bpy.ops.ed.undo_push(message="a pane")
    pane.velour.period = (1, 1)
    held = _held_content()
    _invoke(bpy.ops.velour.add_votf, material="Paint", structure=pane.name, texels=8)
    return image, held


def outline_beside_the_window(folder):
    """Its beginning takes the structure from Blender; if it read the model, too, it would wait for ever."""
    with _Timed(_class("add_votf.VELOUR_OT_add_votf"), "_step") as timed:
        image, held = _begin_outline(folder, "outlined.velour", LARGE)
        yield from _reading()
        held.release()
        yield from window.at_rest()
    node = scenes.velour_node(bpy.data.materials["Paint"])
    with module("export.files").read_model(node.image, "Test") as model:
        assert "shell" in model.info()
    check_turns(
        "the outline", timed.seconds, lambda: module("export.files").read_model(image, "Control").close()
    )


def _is_model(image):
    return image.packed_file is not None and image.velour.sha256 != ""


def outline_deleted(folder):
    """The structure goes, which was exported before; then the material, whose model is kept."""
    for number, remove in enumerate((bpy.data.objects, bpy.data.materials)):
        _image, held = _begin_outline(folder, f"{number}.velour", 50_000)
        images = set(bpy.data.images.keys())
        remove.remove(remove["Plane" if number == 0 else "Paint"])
        held.release()
        yield from window.at_rest()
        (kept,) = [image for image in bpy.data.images if image.name not in images and _is_model(image)]
        if number == 0:
            assert scenes.velour_node(bpy.data.materials["Paint"]).image == kept
            bpy.data.materials.remove(bpy.data.materials["Paint"])


def _full_model():
    return inputs.model_bytes(inputs.glossy_measurement())


def _begin_scene_fit(folder, name, size):
    """Starts the scene fit of the cube, whose full model is a file of that many bytes.

    Returns the model's image and what delays reading it.
    """
    measurement = inputs.glossy_measurement()
    image = shown(large_file(folder, name, size, _full_model()))
    files, measured = module("export.files"), module("operators.measured")
    node = scenes.velour_node(bpy.data.materials["Paint"])
    node.velour.measurement = measured.measurement_image(
        str(measurement), files.sha256(measurement.read_bytes())
    )
    scenes.use_engine()
    with window.override():
        bpy.ops.ed.undo_push(message="measured")
    held = _held_content()
    _invoke(bpy.ops.velour.fit_for_scene, material="Paint", current_frame=True)
    return image, held


def _scene_model():
    return scenes.velour_node(bpy.data.materials["Paint"]).velour.scene_model


def scene_beside_the_window(folder):
    """Files are read, and the fit is begun; what a frame shows Blender itself works out in between."""
    fit = module("operators.scene_fit").SceneFit
    operator = _class("fit_for_scene.VELOUR_OT_fit_for_scene")
    with _Timed(fit, "__init__", "take", "fit") as timed, _Timed(operator, "_begin", "_start") as begun:
        image, held = _begin_scene_fit(folder, "full.velour", LARGE)
        yield from _reading()
        window.screenshot(folder, "scene-reading")
        held.release()
        yield from window.at_rest()
    assert _scene_model() is not None
    timed.seconds += begun.seconds
    check_turns("the fit", timed.seconds, lambda: module("export.files").read_model(image, "Control").close())


def scene_cancelled(folder):
    """At once, while the file is still read."""
    _image, held = _begin_scene_fit(folder, "cancelled.velour", 50_000)
    yield 0.3
    bpy.ops.velour.cancel_fit()
    yield from window.at_rest()
    held.release()
    yield 0.3
    assert _scene_model() is None


def scene_of_another_model(folder):
    """One that came meanwhile is not what was read: nothing is made of it."""
    _image, held = _begin_scene_fit(folder, "before.velour", 50_000)
    node = scenes.velour_node(bpy.data.materials["Paint"])
    node.image = module("operators.measured").packed_model(_full_model(), "Other")
    held.release()
    yield from window.at_rest()
    assert _scene_model() is None


def scene_undone(folder):
    _image, held = _begin_scene_fit(folder, "undone.velour", 50_000)
    bpy.data.objects["Cube"].rotation_euler.x = 0.1
    with window.override():
        bpy.ops.ed.undo_push(message="turned")
        bpy.ops.ed.undo()
    held.release()
    yield from window.at_rest()
    assert _scene_model() is not None


def scene_loaded_file(folder):
    """Another file ends it, and the next is not kept waiting."""
    _image, held = _begin_scene_fit(folder, "lost.velour", 50_000)
    yield 0.3
    window.fresh_file()
    held.release()
    yield 0.5
    assert not _state().running
    _image, held = _begin_scene_fit(folder, "next.velour", 50_000)
    held.release()
    yield from window.at_rest()
    assert _scene_model() is not None
