"""The window: jobs that are left behind, by Esc, by another file and by the end of Blender."""

import os
import subprocess
import threading
import time
from types import SimpleNamespace
from unittest import mock

import bpy

from support import inputs, viewport, window
from support.reading import MODEL, module

_QUITTING_SECONDS = 20  # what reads has 60, and Blender itself takes one or two


def start(folder):
    """Called by the harness once the window is there."""
    quitting = (quitting_while_reading, quitting_with_pictures, quitting_a_fit, quitting_a_capture)
    window.run(folder, (escape, pictures_of_another_file, *quitting))


def escape(folder):
    """Over a tab that shows the job, and over the status bar, which does so too; nowhere else."""
    yield from window.show_properties("MATERIAL")
    areas = window.first().screen.areas
    area = max(areas, key=lambda each: each.width * each.height)
    x, y = area.x + area.width // 2, area.y + area.height // 2
    is_over = module("operators.background_job")._over_progress

    def cancels(x, y):
        with window.override():
            return is_over(bpy.context, SimpleNamespace(mouse_x=x, mouse_y=y))

    assert cancels(x, y)
    area.spaces.active.context = "SCENE"
    assert not cancels(x, y)
    area.spaces.active.context = "OBJECT"
    assert cancels(x, y)
    area.type = "VIEW_3D"
    assert not cancels(x, y)
    assert cancels(x, 2), "the status bar"
    top = max(each.y + each.height for each in areas)
    assert top + 10 < window.first().height
    assert not cancels(x, top + 10), "the top bar"


def _models(folder, name, count):
    """A folder of them, none like another: what stands behind a model is no part of it."""
    made = folder / name
    made.mkdir()
    for number in range(count):
        (made / f"{number}.velour").write_bytes(MODEL.read_bytes() + bytes(number))
    return made


def pictures_of_another_file(folder):
    """No more pictures are made once another file is loaded."""
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    jobs, made, go_on = module("core.thumbnail_job"), [], threading.Event()
    thumbnail = jobs.thumbnail

    def counted(file, *arguments):
        made.append(file.path)
        assert go_on.wait(60)
        return thumbnail(file, *arguments)

    with mock.patch.object(jobs, "thumbnail", counted):
        with window.override():
            path = str(_models(folder, "pictures", 12))
            assert bpy.ops.velour.make_thumbnails("INVOKE_DEFAULT", directory=path) == {"RUNNING_MODAL"}
        yield from viewport.until(lambda: made, "no thumbnail is begun")
        window.fresh_file()
        go_on.set()
        yield 2.0
    assert len(made) == 1, made
    state = bpy.context.window_manager.velour
    assert not state.running
    assert state.waiting == 0


# Quits 0.3 s after the job has begun, or is past what it begins with, and says when.
_CHILD = """
import os, sys, time
import addon_utils, bpy
addon_utils.enable("velour", default_set=True)

def begin():
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        {begin}
    bpy.app.timers.register(leave, first_interval=0.3)

def leave():
    state = bpy.context.window_manager.velour
    if not state.running or state.stage in {before!r} or not {ready}:
        return 0.1
    print("leaves at", time.time(), flush=True)
    bpy.ops.wm.quit_blender()

bpy.app.timers.register(begin, first_interval=0.5)
"""


def _quits(folder, name, begin, before=("",), ready="True"):
    """Turns until a Blender of its own, whose job these lines begin, has left: in time, with status 0.

    `before`: stages of the job that it does not leave in; `ready`: an expression that is true once it may."""
    program, log = folder / f"{name}.py", folder / f"{name}.txt"
    lines = begin.strip().replace("\n", "\n        ")
    program.write_text(_CHILD.format(begin=lines, before=before, ready=ready))
    command = [bpy.app.binary_path, "--factory-startup", "--window-geometry", "0", "0", "600", "400"]
    with open(log, "wb") as output:
        child = subprocess.Popen(
            [*command, "--python", program],
            env={**os.environ, "XDG_CACHE_HOME": str(folder / name)},
            stdout=output,
            stderr=subprocess.STDOUT,
        )
        try:
            for _ in range(1200):
                yield 0.1
                if child.poll() is not None:
                    break
        finally:
            child.kill()
    said = log.read_text(errors="replace")
    assert "leaves at" in said, said
    seconds = time.time() - float(said.partition("leaves at")[2].split()[0])
    print(f"{name}: left {seconds:.1f} s after it was told to, with status {child.returncode}")
    assert child.returncode == 0, said
    assert seconds < _QUITTING_SECONDS, said


def quitting_while_reading(folder):
    """In one piece, which nobody can stop."""
    yield from _quits(
        folder,
        "reading",
        f"""
from velour.operators import load_material
load_material.found_file = lambda path: time.sleep(60)
bpy.ops.velour.load_material("INVOKE_DEFAULT", filepath={str(MODEL)!r})
""",
    )


def quitting_with_pictures(folder):
    """Their thread ends by itself, before the next one."""
    path = _models(folder, "many", 200)
    yield from _quits(
        folder,
        "making",
        f"""
bpy.ops.velour.make_thumbnails("INVOKE_DEFAULT", directory={str(path)!r})
""",
    )


def quitting_a_fit(folder):
    """The library's threads work on it."""
    yield from _quits(
        folder,
        "fitting",
        f"""
bpy.ops.velour.load_material(filepath={str(inputs.glossy_measurement())!r}, fit=False)
name = bpy.context.object.active_material.name
bpy.ops.velour.fit("INVOKE_DEFAULT", material=name, model="SCATTERED", tolerance=0.0005, max_lobes=64)
""",
        before=("", "reading"),
    )


def quitting_a_capture(folder):
    index = folder / "plane.btf/btf.json"
    yield from _quits(
        folder,
        "capturing",
        f"""
bpy.ops.mesh.primitive_plane_add()
path = {str(index.parent)!r}
bpy.ops.velour.capture_btf("INVOKE_DEFAULT", directory=path, texels=512, samples=1024)
""",
        ready=f"os.path.isfile({str(index)!r})",
    )
    assert index.is_file()
