"""The viewport in real time: that nothing is left of it, and what it leaves to the ray tracer."""

from pathlib import Path

import bpy

from support import scenes, viewport, window

_DATA = Path(__file__).parent / "scenes/data"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (restarts, refusals, cures))


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


def refusals(folder):
    """What is too much is ray traced, with a sentence; in real time once the mode is chosen again."""
    scenes.set_world()
    realtime = viewport.addon("realtime.scene")
    most, realtime._MOST_DRAWS = realtime._MOST_DRAWS, 0
    try:
        viewport.show_real_time()
        yield from viewport.until(lambda: viewport.samples() > 0, "the ray tracer shows nothing")
        assert "instances" in viewport.the_one()._refusal.sentence, viewport.the_one()._refusal.sentence
        window.screenshot(folder, "refused")
    finally:
        realtime._MOST_DRAWS = most
    bpy.context.scene.velour.viewport_mode = "RAY_TRACED"
    yield from viewport.finished()
    bpy.context.scene.velour.viewport_mode = "REAL_TIME"
    yield from viewport.real_time_finished()
    assert not viewport.the_one()._refusal


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
    assert "lamps" in refusal.sentence, refusal.sentence

    lamps[0].location.x = 3
    cube.rotation_euler.z = 0.5
    lamps[1].data.energy = 20
    yield from viewport.finished()
    assert viewport.the_one()._refusal is refusal

    bpy.data.objects.remove(lamps.pop())
    yield from viewport.real_time_finished()
    assert not viewport.the_one()._refusal

    _lamp(8)
    yield from viewport.until(lambda: viewport.samples() > 0, "the ray tracer shows nothing")
    assert "lamps" in viewport.the_one()._refusal.sentence
    cube.active_material = scenes.measured_material((_DATA / "paint.velour").read_bytes(), "Paint")
    yield from viewport.real_time_finished()
    assert not viewport.the_one()._refusal


def _lamp(i):
    lamp = bpy.data.objects.new(f"Lamp {i}", bpy.data.lights.new(f"Lamp {i}", "POINT"))
    lamp.location = (i - 4, -3, 4)
    bpy.context.scene.collection.objects.link(lamp)
    return lamp
