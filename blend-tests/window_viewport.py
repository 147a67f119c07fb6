"""The rendered viewport: its colors, its views and regions; that it stops, rests and says errors."""

import time

import bpy
import numpy as np

from support import scenes, viewport, window


def start(folder):
    """Called by the harness once the window is there."""
    tests = (
        gray,
        as_the_final_render,
        first_picture,
        one_redraw,
        camera_view,
        render_region,
        error_line,
        rests,
        local_view,
        freed_engine,
        freed_engine_at_rest,
    )
    window.run(folder, tests, viewport=True)


def gray(folder):
    """Scene-linear 0.18 is 118 of 255 under Standard."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.data.objects.remove(bpy.data.objects["Light"])
    scenes.set_world((0.18, 0.18, 0.18))
    viewport.show()
    yield from viewport.finished()
    values = 255 * viewport.middle(window.screenshot(folder, "gray"))
    assert np.abs(values - 118).max() <= 1, (values.min(), values.max())


def as_the_final_render(folder):
    """The same colors on the screen as in a saved picture, under Blender's default view transform."""
    viewport.colored_scene().scale = (4, 4, 4)  # the camera sees nothing else in the middle
    bpy.data.objects["Cube"].location = (0, 0, -3.5)
    default = bpy.context.scene.view_settings.view_transform
    viewport.show(samples=64)
    scene = bpy.context.scene
    scene.render.preview_pixel_size = "4"
    scene.velour.samples, scene.view_settings.view_transform = 256, default
    assert default != "Standard"
    viewport.space().region_3d.view_perspective = "CAMERA"
    yield from viewport.finished()
    screen = viewport.middle(window.screenshot(folder, "as-final"))
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.render.filepath = str(folder / "final.png")
    bpy.ops.render.render(write_still=True)
    final = scenes.read(folder / "final.png")[30:34, 30:34, :3]
    difference = 255 * np.abs(screen.mean((0, 1)) - final.mean((0, 1)))
    assert difference.max() < 3, difference
    assert np.ptp(final.mean((0, 1))) > 0.1, "it has no color"


def first_picture(folder):
    """Soon, coarse, and finer later; nothing of it is left when it is switched off."""
    viewport.colored_scene()
    begin = time.monotonic()
    viewport.show(samples=256)
    yield from viewport.until(lambda: not viewport.is_idle(), "no job")
    yield from viewport.until(viewport.is_seen, "no picture")
    print("first picture after", time.monotonic() - begin, flush=True)
    yield from viewport.finished()
    window.screenshot(folder, "finished")
    assert viewport.shown_picture().samples == 256
    viewport.space().shading.type = "SOLID"
    yield 0.5
    assert not tuple(viewport.addon("engine.viewport")._all), "it is still there"
    assert viewport.is_idle()


def one_redraw(folder):
    """What a change looks like is in the redraw that Blender makes of it, if worked out by then."""
    viewport.colored_scene()
    viewport.show()
    yield from viewport.finished()
    module, drawn = viewport.addon("engine.viewport"), []
    draw, prompt = module.Viewport.draw, module._PROMPT

    def watched(self, *given):
        begin = time.monotonic()
        draw(self, *given)
        drawn.append(self._job.picture.shown_at >= begin)

    module.Viewport.draw, module._PROMPT = watched, 30.0  # the machine may be busy
    try:
        bpy.data.lights["Light"].energy *= 3
        yield from viewport.until(lambda: drawn, "the change is not drawn")
    finally:
        module.Viewport.draw, module._PROMPT = draw, prompt
    assert drawn[0]


def camera_view(folder):
    """Perspective, camera and orthographic views show the cube where Blender's own shading does."""
    viewport.colored_scene()
    view = viewport.show(samples=8)
    bpy.context.scene.camera.data.show_passepartout = False
    for name in ("PERSP", "CAMERA", "ORTHO"):
        view.shading.type = "RENDERED"
        view.region_3d.view_perspective = name
        if name == "CAMERA":
            view.region_3d.view_camera_zoom, view.region_3d.view_camera_offset = 10, (0.1, -0.05)
            bpy.context.scene.camera.data.shift_x = 0.05
        yield from viewport.finished()
        rendered = window.screenshot(folder, f"view-{name.lower()}")
        view.shading.type, view.shading.light = "SOLID", "FLAT"
        yield 0.5
        solid = window.screenshot(folder, f"view-{name.lower()}-solid")
        ours, blenders = viewport.shape(rendered), viewport.shape(solid)
        assert blenders.sum() > 2000
        assert np.count_nonzero(ours != blenders) < 0.02 * blenders.sum(), name


def render_region(folder):
    viewport.colored_scene()
    view = viewport.show(samples=16)
    view.use_render_border = True
    view.render_border_min_x, view.render_border_max_x = 0.25, 0.5
    view.render_border_min_y, view.render_border_max_y = 0.25, 0.75
    bpy.context.scene.update_tag()
    yield from viewport.finished()
    shown = window.screenshot(folder, "region")
    region = viewport.region()
    height, width = viewport.pixels().shape[:2]
    assert abs(width - region.width / 4) <= 1
    assert abs(height - region.height / 2) <= 1
    inside = shown[region.y + region.height // 2, region.x + int(0.3 * region.width)]
    outside = shown[region.y + region.height // 2, region.x + int(0.8 * region.width)]
    assert np.abs(inside - outside).max() > 0.1


def error_line(folder):
    """One line while something is wrong, the picture when it is no longer."""
    viewport.colored_scene()
    viewport.show(samples=16).region_3d.view_perspective = "CAMERA"
    camera = bpy.context.scene.camera.data
    camera.type = "PANO"
    yield 0.5
    sentence = viewport.the_one()._view_error
    assert "panoramic" in sentence
    width = viewport.text_width(folder, "error")
    assert width > 4 * len(sentence), (width, sentence)
    bpy.data.objects["Cube"].location.x += 1
    yield 0.3
    assert viewport.the_one()._view_error == sentence
    assert not viewport.the_one()._scene_error
    camera.type = "PERSP"
    yield from viewport.finished()
    assert viewport.text_width(folder, "error-gone") < width / 2
    assert not viewport.the_one()._view_error
    assert viewport.shown_picture().samples == 16


def rests(folder):
    """While a final render runs the viewport's job does not, and it goes on afterwards where it was."""
    viewport.colored_scene()
    viewport.show(samples=1 << 20)
    yield from viewport.until(lambda: viewport.samples() > 8, "no picture")
    before = viewport.shown_picture().samples
    bpy.context.scene.velour.samples = 1 << 17
    with window.override():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield 0.5
    assert bpy.app.is_job_running("RENDER")
    assert viewport.job().poll().state == "cancelled"
    yield from viewport.until(lambda: not bpy.app.is_job_running("RENDER"), "the render does not end")
    yield 0.5
    assert viewport.job().poll().running
    assert viewport.job().picture().samples >= before


def local_view(folder):
    """Shows what is selected alone, and all again."""
    viewport.colored_scene()
    with window.override():
        scenes.add_sphere(radius=2.0).location = (3, 0, 0)
        bpy.ops.object.select_all(action="DESELECT")
    bpy.data.objects["Cube"].select_set(True)
    viewport.show(samples=16)
    yield from viewport.finished()
    everything = viewport.the_one()._live.scene.info()["instances"]
    with viewport.override():
        bpy.ops.view3d.localview(frame_selected=False)
    yield from viewport.finished()
    window.screenshot(folder, "local-view")
    alone = viewport.the_one()._live.scene.info()["instances"]
    with viewport.override():
        bpy.ops.view3d.localview(frame_selected=False)
    yield from viewport.finished()
    assert (everything, alone) == (2, 1), (everything, alone)
    assert viewport.the_one()._live.scene.info()["instances"] == 2


def freed_engine(folder):
    """Something keeps its Python half: its job ends all the same, and others are drawn, an undo included."""
    viewport.colored_scene()
    viewport.show(samples=1 << 20)
    yield from viewport.until(lambda: viewport.samples() > 0, "no picture")
    freed = viewport.the_one()
    engine, shading = freed._engine(), viewport.space().shading
    shading.type = "SOLID"
    yield from viewport.until(lambda: not freed._job, "its job goes on")
    assert engine is not None
    assert freed._engine() is None
    shading.type = "RENDERED"
    yield from viewport.until(lambda: viewport.samples() > 0, "the next shows nothing")
    viewport.addon("engine.viewport")._forget_scenes()
    yield from viewport.until(lambda: viewport.samples() > 0, "nothing is shown after an undo")


def freed_engine_at_rest(folder):
    """Something keeps its Python half: scene and picture go although nothing is waited for any more."""
    viewport.colored_scene()
    viewport.show(samples=16)
    yield from viewport.finished()
    freed = viewport.the_one()
    engine = freed._engine()
    assert freed._live is not None
    viewport.space().shading.type = "SOLID"
    yield from viewport.until(lambda: freed._live is None, "its scene stays", patience=10)
    assert engine is not None
    assert freed._job.picture._texture is None
