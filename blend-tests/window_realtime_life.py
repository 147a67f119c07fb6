"""The viewport in real time: that nothing is left of it, and what it leaves to the ray tracer."""

from pathlib import Path

import bpy
import numpy as np

from support import realtime, scenes, viewport, window

_DATA = Path(__file__).parent / "scenes/data"

LONG = "many pictures in real time, drawn without a graphics card"
SCREEN = "1400x720"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(
        folder, (restarts, freed_engine, first_picture, renders, no_frame, refusals, cures), viewport=True
    )


def restarts(folder):
    """Switched off and on, and from one mode to the other, again and again: nothing is left behind."""
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    settings, shading, memory = bpy.context.scene.velour, viewport.space().shading, []
    for i in range(8):
        if i % 2:
            shading.type = "SOLID"
            yield 0.05
            shading.type = "RENDERED"
        else:
            settings.viewport_mode = "RAY_TRACED"
            yield from viewport.until(lambda: viewport.samples() > 0, "the ray tracer shows nothing")
            settings.viewport_mode = "REAL_TIME"
        yield from viewport.real_time_finished()
        memory.append(_resident_mib())
    print("MiB after each:", *(round(mib) for mib in memory), flush=True)
    assert memory[-1] - memory[3] < 20, memory


def _resident_mib():
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS")) / 1024


def freed_engine(folder):
    """Something keeps its Python half: what it holds goes all the same, once all of it is drawn."""
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    yield from viewport.until(viewport.is_idle, "it does not come to rest")
    freed = viewport.the_one()
    engine, shown = freed._engine(), freed._real_time
    viewport.space().shading.type = "SOLID"
    yield from viewport.until(lambda: freed._real_time is None, "it goes on")
    assert engine is not None
    assert shown._live is None
    assert shown._drawing.last() is None


def renders(folder):
    """Light and tables leave the processor to them, then go on."""
    realtime.shine(folder, np.random.default_rng(1).random((256, 512, 3), np.float32) ** 16)
    drawing = viewport.addon("realtime.drawing")
    made = []
    light_map_job = drawing.light_map_job

    def kept(*arguments):
        made.append(light_map_job(*arguments))
        return made[-1]

    drawing.light_map_job = kept
    try:
        viewport.show_real_time()
        yield from viewport.until(lambda: made and made[0].poll().running, "the light is not asked for")
    finally:
        drawing.light_map_job = light_map_job
    with viewport.addon("engine.viewport_clock").paused():
        yield from viewport.until(lambda: not made[0].poll().running, "the light goes on")
        for _turn in range(5):
            assert made[0].poll().state == "cancelled", made[0].poll().state
            assert not viewport.real_time().has_picture()
            yield 0.1
    yield from viewport.real_time_finished()
    assert not viewport.the_one()._refusal


def no_frame(folder):
    """Nothing of the region is to be rendered: nothing is drawn on and on."""
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    viewport.show_real_time()
    yield from viewport.until(lambda: viewport.real_time() is not None, "it does not begin")
    space, drawing = viewport.space(), viewport.real_time()._drawing
    yield from viewport.until(lambda: drawing.count > 0, "nothing is drawn")
    space.render_border_min_x = space.render_border_max_x = 0.5
    space.use_render_border = True
    yield from viewport.until(viewport.is_idle, "it does not come to rest", patience=5)
    assert drawing.is_waiting(), "all was drawn before"
    space.use_render_border = False
    yield from viewport.real_time_finished()


def first_picture(folder):
    """Until it is there the ray tracer's is."""
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    viewport.show(samples=16)
    yield from viewport.finished()
    traced = viewport.middle(window.screenshot(folder, "traced"), half=100)
    drawing = viewport.addon("realtime.drawing").Drawing
    is_ready, asked = drawing.is_ready, []
    drawing.is_ready = lambda self, scene: asked.append(is_ready(self, scene)) or False
    try:
        bpy.context.scene.velour.viewport_mode = "REAL_TIME"
        yield from viewport.until(lambda: len(asked) > 2, "it does not begin")
        meanwhile = viewport.middle(window.screenshot(folder, "meanwhile"), half=100)
    finally:
        drawing.is_ready = is_ready
    assert np.abs(meanwhile - traced).max() < 0.01, np.abs(meanwhile - traced).max()
    yield from viewport.real_time_finished()
    assert viewport.real_time().has_picture()


def refusals(folder):
    """What is too much is ray traced, with a sentence; in real time once the mode is chosen again."""
    scenes.set_world()
    scene = viewport.addon("realtime.scene")
    most, scene._MOST_DRAWS = scene._MOST_DRAWS, 0
    try:
        viewport.show_real_time()
        yield from viewport.until(lambda: viewport.samples() > 0, "the ray tracer shows nothing")
        assert "instances" in viewport.the_one()._refusal.sentence, viewport.the_one()._refusal.sentence
        window.screenshot(folder, "refused")
    finally:
        scene._MOST_DRAWS = most
    yield from viewport.choose_real_time_again()


def cures(folder):
    """A ninth lamp on a BTF is too much, an eighth is not; what moves meanwhile is not tried anew."""
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    bpy.data.objects.remove(bpy.data.objects["Light"])
    cube = bpy.data.objects["Cube"]
    cube.active_material = scenes.measured_material((_DATA / "weave.velour").read_bytes(), "Weave")
    lamps = [_lamp(i) for i in range(9)]
    viewport.show_real_time()
    yield from viewport.until(lambda: viewport.samples() > 0, "the ray tracer shows nothing")
    refusal = viewport.the_one()._refusal
    assert "lights" in refusal.sentence, refusal.sentence

    counting, asked = viewport.addon("engine.refusal"), []
    numbers = counting._numbers
    counting._numbers = lambda depsgraph: asked.append(1) or numbers(depsgraph)
    try:
        lamps[0].location.x = 3
        cube.rotation_euler.z = 0.5
        lamps[1].data.energy = 20
        yield from viewport.finished()
    finally:
        counting._numbers = numbers
    assert viewport.the_one()._refusal is refusal
    assert not asked, "instances were counted for what moves or shines otherwise"

    bpy.data.objects.remove(lamps.pop())
    yield from viewport.real_time_finished()
    assert not viewport.the_one()._refusal

    _lamp(8)
    yield from viewport.until(lambda: viewport.samples() > 0, "the ray tracer shows nothing")
    assert "lights" in viewport.the_one()._refusal.sentence
    cube.active_material = scenes.measured_material((_DATA / "paint.velour").read_bytes(), "Paint")
    yield from viewport.real_time_finished()
    assert not viewport.the_one()._refusal


def _lamp(i):
    lamp = bpy.data.objects.new(f"Lamp {i}", bpy.data.lights.new(f"Lamp {i}", "POINT"))
    lamp.location = (i - 4, -3, 4)
    bpy.context.scene.collection.objects.link(lamp)
    return lamp
