"""The viewport in real time where the graphics processor refuses what it is asked: rays show the scene."""

import logging

import bpy
import numpy as np

from support import inputs, scenes, viewport, window

SCREEN = "1400x420"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(
        folder, (no_texture, no_pictures_to_draw_into, lost_while_drawing, broken_shader), viewport=True
    )


class _Log(logging.Handler):
    """What Velour logs while it is entered."""

    def __enter__(self):
        self.records = []
        logging.getLogger(inputs.ADDON).addHandler(self)
        return self

    def emit(self, record):
        self.records.append(record)

    def __exit__(self, *_exception):
        logging.getLogger(inputs.ADDON).removeHandler(self)


class _Failing:
    """In the place of a type of gpu.types while it is entered: refuses, and counts how often.

    `kept`: a format that others ask for.
    """

    def __init__(self, name, kept=None):
        self._name, self._kept, self.count = name, kept, 0

    def __enter__(self):
        import gpu

        self._before = getattr(gpu.types, self._name)
        setattr(gpu.types, self._name, self)
        return self

    def __exit__(self, *_exception):
        import gpu

        setattr(gpu.types, self._name, self._before)

    def __call__(self, *arguments, **values):
        if values.get("format") == self._kept:
            return self._before(*arguments, **values)
        self.count += 1
        raise RuntimeError("out of memory")


def _set_up():
    scenes.set_world((0.18, 0.18, 0.18))
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    viewport.show_real_time()


def _refused(folder, name, *words):
    """Turns until rays show the scene, all of their samples, and the header has a sentence with `words`."""
    yield from viewport.until(
        lambda: viewport.samples() > 0 and viewport.the_one()._refusal, "the ray tracer shows nothing"
    )
    yield from viewport.finished()
    sentence = viewport.the_one()._refusal.sentence
    for each in ("Not in real time", "the ray tracer shows the scene", *words):
        assert each in sentence, sentence
    assert "unexpectedly" not in sentence, sentence
    seen = window.screenshot(folder, name)
    gray = 255 * viewport.middle(seen)
    assert np.abs(gray - 118).max() <= 1, (gray.min(), gray.max())
    assert len(bpy.context.window_manager.windows) == 1
    width = viewport.text_width(folder, f"{name}-text")
    assert width > 4 * len(sentence), (width, sentence)


def _change_scene():
    """In a way that a refusal takes as worth another look."""
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    lamp.data.energy = 0
    bpy.context.scene.collection.objects.link(lamp)


def no_texture(folder):
    with _Log() as log, _Failing("GPUTexture", kept="RGBA16F") as made:  # that of the ray tracer's pictures
        _set_up()
        yield from _refused(folder, "no-texture", "cannot create a texture of", "choose Real Time again")
        assert made.count == len(log.records) == 1, (made.count, log.records)
    yield from viewport.choose_real_time_again()


def no_pictures_to_draw_into(folder):
    with _Log() as log, _Failing("GPUOffScreen") as made:
        _set_up()
        yield from _refused(folder, "no-pictures", "images of", "choose Real Time again")
        assert made.count == len(log.records) == 1, (made.count, log.records)
    yield from viewport.choose_real_time_again()


def lost_while_drawing(folder):
    """As Blender says it where the context is gone."""
    drawing, asked = viewport.addon("realtime.drawing"), []
    sky = drawing.full_screen

    def lost(*_arguments):
        asked.append(1)
        raise RuntimeError("no active GPU context found")

    drawing.full_screen = lost
    try:
        with _Log() as log:
            _set_up()
            yield from _refused(folder, "lost", "cannot create an image of", "choose Real Time again")
            assert len(asked) == len(log.records) == 1, (asked, log.records)
    finally:
        drawing.full_screen = sky
    yield from viewport.choose_real_time_again()


def broken_shader(folder):
    """Told once, tried once: neither a changed scene nor the mode chosen again compiles it anew."""
    shaders = viewport.addon("realtime.shaders")
    shaders._compiled.clear()
    read, compiled = shaders._source, []

    def broken(*names):
        compiled.append(names)
        return read(*names) + "\nthis is no GLSL;\n"

    shaders._source = broken
    try:
        with _Log() as log:
            _set_up()
            yield from _refused(folder, "broken-shader", "compile", "update the driver")
            assert len(log.records) == 1, log.records
            count = len(compiled)
            _change_scene()
            yield from viewport.finished()
            assert viewport.the_one()._refusal
            bpy.context.scene.velour.viewport_mode = "RAY_TRACED"
            yield from viewport.finished()
            bpy.context.scene.velour.viewport_mode = "REAL_TIME"
            yield from _refused(folder, "broken-shader-again", "compile", "update the driver")
            assert len(log.records) == 1, log.records
            assert len(compiled) == count, compiled
    finally:
        shaders._source = read
        shaders._compiled.clear()
    yield from viewport.choose_real_time_again()
