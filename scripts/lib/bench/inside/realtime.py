"""In a window of Blender: scenes of blend-tests in real time, and their frame rates."""

import math
import time
from pathlib import Path

import bpy
import numpy as np
from support import realtime, scenes, viewport, window
from window_realtime_outline import _plane_of_its_btf

_DATA = Path(scenes.__file__).parents[1] / "scenes/data"
_SECONDS = 3  # duration of a measurement


def start(folder):
    """Called by the harness when the window exists."""
    window.run(folder, (net, paint), seconds=math.inf, viewport=True)


def net(folder):
    """A net; also saves its ray-traced and real-time pictures."""
    realtime.sky(folder)
    _plane_of_its_btf(folder, "NET")
    yield from _shown("a net of its BTF")
    drawn = realtime.pixels()
    traced = realtime.traced(realtime.equirectangular(realtime.mixture()), samples=2048)
    print(f"real time: relative L2 {realtime.error(drawn, traced):.4f}", flush=True)
    np.save(folder / "net.npy", np.stack((traced.mean, drawn)))


def paint(folder):
    realtime.sky(folder)
    realtime.ball(scenes.measured_material((_DATA / "paint.velour").read_bytes()))
    yield from _shown("a ball of paint")


def _shown(what):
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    rate, size = _frames_a_second()
    print(f"real time: {what}, {size[0]} x {size[1]} pixels: {rate:.1f} frames a second", flush=True)
    yield from viewport.real_time_finished()


def _frames_a_second():
    """Frames per second and frame size, drawn as while the view moves. Reads back each complete frame."""
    shown = viewport.real_time()
    with viewport.override():
        frame = viewport.addon("export.viewport").viewport_frame(
            bpy.context, bpy.context.evaluated_depsgraph_get()
        )
    count, begin = 0, time.monotonic()
    while time.monotonic() - begin < _SECONDS:
        shown._drawing.restart()
        shown._drawing.draw(shown._live.scene, frame.view, 1.0, True).read()
        count += 1
    rate = count / (time.monotonic() - begin)
    shown._drawing.restart()
    shown._engine().tag_redraw()
    viewport.addon("engine.viewport_clock").watch(shown)
    return rate, (frame.view.width, frame.view.height)
