"""What the rendered viewport shows of a scene, and what lights it; what it never shows begins nothing."""

from types import SimpleNamespace
from unittest import mock

import bpy
import numpy as np

from support import scenes, viewport, window

_STUDIO_LIGHT = "courtyard.exr"
_SKY = "/studiolights/world/" + _STUDIO_LIGHT
SCREEN = "700x460"


def start(folder):
    """Called by the harness once the window is there."""
    tests = (
        studio_light,
        no_studio_light,
        object_types,
        exposure,
        denoised,
        sequence,
        unrelated,
        resized,
        border_of_the_camera,
    )
    window.run(folder, tests, viewport=True)


def studio_light(folder):
    """Is turned and lit as a world's picture by a Mapping of vectors, which is how Cycles takes it."""
    viewport.colored_scene()
    shading = viewport.show(samples=16).shading
    _sky(bpy.utils.system_resource("DATAFILES") + _SKY, 1.0, 0.5)
    yield from viewport.finished()
    world = viewport.pixels()
    shading.use_scene_world_render, shading.studio_light = False, _STUDIO_LIGHT
    yield from viewport.seen(world, "the studio light")
    plain = viewport.pixels()
    shading.studiolight_rotate_z, shading.studiolight_intensity = 1.0, 0.5
    yield from viewport.seen(plain, "its turn")
    window.screenshot(folder, "studio-light")
    assert not viewport.the_one()._scene_error
    np.testing.assert_array_equal(viewport.pixels(), world)


def _sky(path, turn, strength):
    """A world of the scene's that shows a picture."""
    tree = scenes.set_world(strength=strength).node_tree
    picture, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
    picture.image, mapping.vector_type = bpy.data.images.load(path), "VECTOR"
    mapping.inputs["Rotation"].default_value = (0, 0, turn)
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], picture.inputs["Vector"])
    tree.links.new(picture.outputs[0], tree.nodes["Background"].inputs["Color"])


def no_studio_light(folder):
    """Where none is installed there is one line, and the picture once the scene's world is back."""
    viewport.colored_scene()
    shading = viewport.show(samples=16).shading
    yield from viewport.finished()
    look = viewport.addon("export.look")
    studio_light = look._studio_light
    look._studio_light = lambda _shading: studio_light(SimpleNamespace(selected_studio_light=None))
    try:
        shading.use_scene_world_render = False
        yield 0.5
        sentence = viewport.the_one()._scene_error
        assert "no image" in sentence
        assert viewport.text_width(folder, "no-studio-light") > 4 * len(sentence)
    finally:
        look._studio_light = studio_light
        shading.use_scene_world_render = True
    yield from viewport.finished()
    assert not viewport.the_one()._scene_error
    assert viewport.shown_picture().samples == 16


def object_types(folder):
    """Those that the viewport hides are not there, nor as instances of an empty that it shows."""
    viewport.colored_scene()
    collection = bpy.data.collections.new("Many")
    for name in ("Cube", "Light"):
        collection.objects.link(bpy.data.objects[name])
    empty = bpy.data.objects.new("Empty", None)
    empty.instance_type, empty.instance_collection, empty.location.x = "COLLECTION", collection, 3
    bpy.context.scene.collection.objects.link(empty)
    view = viewport.show(samples=16)
    yield from viewport.finished()
    counts = [_counts()]
    for owner, name, value in (
        (view, "show_object_viewport_light", False),
        (view, "show_object_viewport_mesh", False),
        (view, "show_object_viewport_light", True),
        (view, "show_object_viewport_mesh", True),
        (view, "show_object_viewport_empty", False),
        (view.shading, "use_scene_lights_render", False),
    ):
        setattr(owner, name, value)
        yield 0.3
        yield from viewport.finished()
        counts.append(_counts())
    assert counts == [(2, 2), (2, 0), (0, 0), (0, 2), (2, 2), (2, 2), (2, 0)], counts


def _counts():
    """Numbers of instances and lights in the scene."""
    info = viewport.the_one()._live.scene.info()
    return info["instances"], info["lights"]


def exposure(folder):
    """A new exposure applies to a finished picture without rendering it again."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    scenes.set_world((0.18, 0.18, 0.18))
    viewport.show()
    yield from viewport.finished()
    rendered, scene = viewport.job().picture().version, bpy.context.scene
    for value, byte in ((2.0, 162), (1.0, 118)):  # of 255, under Standard
        scene.cycles.film_exposure = value
        scene.update_tag(refresh={"TIME"})  # which a property of an add-on does not do by itself
        yield 0.5
        values = 255 * viewport.middle(window.screenshot(folder, f"exposure-{value}"))
        assert np.abs(values - byte).max() <= 1, (value, values.min(), values.max())
    assert viewport.job().picture().version == rendered


def denoised(folder):
    """A denoised viewport with few samples is closer to one with many than a noisy one is."""
    if viewport.addon("export.denoiser").missing():
        return
    viewport.colored_scene()
    pictures = {}
    for name, samples, denoise in (("many", 1024, False), ("noisy", 8, False), ("denoised", 8, True)):
        viewport.show(samples)
        bpy.context.scene.velour.use_viewport_denoising = denoise
        yield 0.3
        yield from viewport.finished()
        pictures[name] = viewport.pixels().astype(np.float64)
        window.screenshot(folder, name)
    errors = {name: np.square(pictures[name] - pictures["many"]).mean() for name in ("noisy", "denoised")}
    assert errors["denoised"] < 0.5 * errors["noisy"], errors


def sequence(folder):
    """A world's pictures follow the frames, though Blender tells nobody."""
    viewport.colored_scene()
    write = viewport.addon("native.images").write
    for number, level in ((1, 0.2), (2, 0.9)):
        write(folder / f"sky{number:04}.exr", np.full((4, 8, 3), level, np.float32))
    _sky(str(folder / "sky0001.exr"), 0.0, 0.5)
    picture = bpy.context.scene.world.node_tree.nodes["Environment Texture"]
    picture.image.source, picture.image_user.frame_duration = "SEQUENCE", 2
    viewport.show(samples=8)
    yield from viewport.finished()
    last, exported = viewport.pixels(), viewport.the_one()._live
    bpy.context.scene.frame_set(2)
    yield from viewport.seen(last, "the second frame")
    assert viewport.the_one()._live is exported
    assert np.allclose(viewport.pixels()[-1, 0, :3], 0.5 * 0.9, atol=1e-3)


def unrelated(folder):
    """What no picture shows begins nothing anew: strokes, volumes and helpers that change."""
    viewport.colored_scene()
    edits = dict(_unrelated_edits())
    for data in edits:
        obj = bpy.data.objects.new(data.name, data)
        bpy.context.scene.collection.objects.link(obj)
    viewport.show(samples=1 << 20)
    yield from viewport.until(lambda: viewport.samples() > 16, "no picture")
    job, exported = viewport.addon("engine.viewport_job").ViewportJob, viewport.the_one()._live
    with mock.patch.object(job, "restart") as restart:
        for data, (owner, name, value) in edits.items():
            setattr(owner, name, value)
            yield 0.2
            bpy.data.objects[data.name].location.z += 1
            yield 0.2
            assert viewport.the_one()._live is exported, data.name
            restart.assert_not_called()


def _unrelated_edits():
    """What is not rendered, and a setting of it with its value."""
    # Blender 4.3 keeps the old kind beside the new one, which 5.0 has alone.
    kinds = ("grease_pencils_v3", "grease_pencils")
    pencil = next(getattr(bpy.data, name) for name in kinds if hasattr(bpy.data, name)).new("Pencil")
    yield pencil, (pencil.layers.new("Lines"), "opacity", 0.5)
    fog = bpy.data.volumes.new("Fog")
    yield fog, (fog.display, "density", 2.0)
    kinds = bpy.types.BlendDataProbes.bl_rna.functions["new"].parameters["type"].enum_items
    probe = bpy.data.lightprobes.new("Probe", kinds[0].identifier)
    yield probe, (probe, "clip_start", 0.2)


def resized(folder):
    """The picture fills a region that has become narrower, and shows the same as Blender's own shading."""
    viewport.colored_scene().scale = (2, 2, 2)
    system = bpy.context.preferences.system
    system.use_region_overlap = False  # so that the sidebar takes its room
    try:
        view = viewport.show(samples=8)
        yield from viewport.finished()
        width = viewport.region().width
        view.show_region_ui = True
        yield 0.5
        yield from viewport.finished()
        region = viewport.region()
        assert region.width < width - 50
        assert viewport.pixels().shape[:2] == (region.height, region.width)
        assert viewport.shown_picture().samples == 8
        rendered = window.screenshot(folder, "resized")
        view.shading.type, view.shading.light = "SOLID", "FLAT"
        yield 0.5
        ours, blenders = viewport.shape(rendered), viewport.shape(window.screenshot(folder, "resized-solid"))
        assert np.count_nonzero(ours != blenders) < 0.02 * blenders.sum()
    finally:
        system.use_region_overlap = True


def border_of_the_camera(folder):
    """Perspective or not, it holds what a final render of the border does."""
    viewport.colored_scene()
    view, render = viewport.show(samples=16), bpy.context.scene.render
    render.resolution_x, render.resolution_y = 1200, 900
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.6, 0.35, 0.7
    view.region_3d.view_perspective = "CAMERA"
    camera = bpy.context.scene.camera.data
    camera.ortho_scale = 12
    for camera.type in ("PERSP", "ORTHO"):
        yield 0.3
        yield from viewport.finished()
        ours = _is_orange(viewport.pixels())
        theirs = _is_orange(scenes.render(folder, f"border-{camera.type.lower()}"))
        assert theirs.shape == (315, 420)
        rows, columns = (np.arange(n) * other // n for n, other in zip(ours.shape, theirs.shape, strict=True))
        differ = np.count_nonzero(ours != theirs[np.ix_(rows, columns)])
        assert 0.1 < ours.mean() < 0.9, ours.mean()  # it shows an edge
        assert differ < 0.03 * ours.sum(), (camera.type, differ, ours.sum())


def _is_orange(pixels):
    return pixels[..., 0] > pixels[..., 2]
