"""Measures in Blender's window the seconds until the rendered viewport shows a change.

The task names the scene, and how often the viewport is switched off and on.
"""

import math
import time
from pathlib import Path

import bpy
from guide import chapters
from mathutils import Euler, Quaternion
from support import viewport, window

from ..project import ROOT
from . import large_scenes
from . import scene as build

SAMPLES = 8
PICTURE = (1280, 720)  # size in real time
REPEATS = 5  # repetitions of each change; the median counts
DRAG = 5.0  # seconds of a continuous change
_TURN = 0.005
_PATIENCE = 120


PAINT = ROOT / "blend-tests/scenes/data/paint.velour"
OBJECTS, FACES = 500, 5000  # 10,000 triangles each
INSTANCES = 100_000


def monkey():
    """One smooth object in a measured paint under an environment map and a light."""
    chapters.add_world()
    with viewport.override():
        subject = chapters.add_monkey()
        bpy.ops.velour.load_material(filepath=str(PAINT), pack=False)
    subject.name = "Subject"


def objects():
    """Five million triangles in 500 objects, each with a mesh of its own."""
    with viewport.override():
        first = _grid(FACES, 0.9)
    first.data.materials.append(_gray())
    side = math.ceil(math.sqrt(OBJECTS))
    for i in range(1, OBJECTS):
        build.link("Object", first.data.copy(), (i % side - side / 2, i // side - side / 2, 0))
    first.location, first.name = (-side / 2, -side / 2, 0), "Subject"


def instances():
    """100,000 instances of a sphere of 992 triangles, at the vertices of a plane."""
    with viewport.override():
        sphere, _ = large_scenes.instances(INSTANCES)
    sphere.data.materials.append(_gray())
    sphere.name = "Subject"


SCENES = {"monkey": monkey, "objects": objects, "instances": instances}


def build_scene(name):
    """In Blender's startup file, without its cube."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    SCENES[name]()
    view = viewport.space().region_3d
    view.view_rotation, view.view_distance = Euler((0.9, 0, 0.6)).to_quaternion(), 14


def turn_view(_time):
    view = viewport.space().region_3d
    view.view_rotation = Quaternion((0, 0, 1), 0.05) @ view.view_rotation


def change_lamp(time):
    bpy.data.lights["Light"].energy = 800 + 100 * time


def change_world(time):
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Strength"].default_value = 0.8 + 0.1 * time


def change_material(time):
    """Changes the color, or the exposure of a measured material."""
    material = bpy.data.objects["Subject"].active_material
    if material.name == "Gray":
        node = next(node for node in material.node_tree.nodes if node.type == "BSDF_DIFFUSE")
        node.inputs["Color"].default_value = (0.5, 0.1 * (time % 9), 0.3, 1)
    else:
        group = next(node for node in material.node_tree.nodes if node.type == "GROUP")
        group.inputs["Exposure"].default_value = 0.1 * (time + 1)


def move_object(time):
    bpy.data.objects["Subject"].location.z += 0.01 * (-1) ** time


def edit_mesh(_time):
    mesh = bpy.data.objects["Subject"].data
    mesh.vertices[0].co.z += 0.01
    mesh.update()


CHANGES = {
    "the view turns": turn_view,
    "strength of a lamp": change_lamp,
    "strength of the world": change_world,
    "a material": change_material,
    "an object moves": move_object,
    "a mesh is edited": edit_mesh,
}


def _grid(faces, size):
    side = round(math.sqrt(faces))
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side, y_subdivisions=side, size=size)
    grid = bpy.context.object
    for vertex in grid.data.vertices:
        vertex.co.z = 0.1 * math.sin(20 * vertex.co.x) * math.sin(20 * vertex.co.y)
    bpy.ops.object.shade_smooth()
    return grid


def _gray():
    return build.material("Gray", "BsdfDiffuse")


class Stopwatch:
    """Times the add-on's viewport by wrapping the two methods that Blender calls."""

    def __init__(self):
        engine_viewport = viewport.addon("engine.viewport").Viewport
        self._update, self._draw = engine_viewport.update, engine_viewport.draw
        engine_viewport.update = lambda shown, *given: self._timed_update(shown, *given)
        engine_viewport.draw = lambda shown, *given: self._timed_draw(shown, *given)
        self.start()

    def start(self):
        self.begin = time.monotonic()
        self.export, self.held = 0.0, 0.0
        self.seen, self._is_drawn = None, False

    def _timed_update(self, shown, *given):
        begin = time.monotonic()
        self._update(shown, *given)
        self.export += time.monotonic() - begin

    def _timed_draw(self, shown, *given):
        begin, export = time.monotonic(), self.export
        self._draw(shown, *given)
        end = time.monotonic()
        self.held = max(self.held, end - begin - (self.export - export))
        self._is_drawn |= shown._job.picture.shown_at >= begin

    def until_seen(self):
        """Waits until the window with a picture is on the screen: Blender's next turn comes after that."""
        while not self._is_drawn:
            if time.monotonic() > self.begin + _PATIENCE:
                raise TimeoutError("the viewport shows nothing")
            yield _TURN
        self.seen = time.monotonic() - self.begin

    def row(self):
        return {"seen": self.seen, "export": self.export, "held": self.held}


def steps(folder, task):
    result = {"blender": bpy.app.version_string, "samples": SAMPLES}
    bpy.context.scene.render.engine = "VELOUR"
    build_scene(task["scene"])
    yield 1.0
    watch = Stopwatch()
    viewport.show(samples=SAMPLES)
    yield from watch.until_seen()
    yield from viewport.finished()
    result["changes"] = {"switched on": [watch.row()]}
    result["size"] = [viewport.region().width, viewport.region().height]
    for name, change in CHANGES.items():
        result["changes"][name] = yield from _repeated(watch, change)
    result["dragged"] = yield from _dragged(move_object)
    window.screenshot(folder, "viewport")
    result["mib"] = _resident_mib()
    if task["restarts"]:
        result["restarts"] = yield from _restarted(watch, task["restarts"])
        result["real_time"] = yield from _real_time()
    return result


def _repeated(watch, change):
    rows = []
    for time_of_it in range(REPEATS):
        watch.start()
        change(time_of_it)
        yield from watch.until_seen()
        yield from viewport.finished()
        rows.append(watch.row())
    return rows


def _dragged(change):
    """Pictures per second while something changes in every turn of Blender's event loop."""
    shown, times, begin = viewport.shown_picture(), set(), time.monotonic()
    while time.monotonic() < begin + DRAG:
        change(len(times))
        yield _TURN
        times.add(shown.shown_at)
    rate = (len(times) - 1) / (time.monotonic() - begin)
    yield from viewport.finished()
    return rate


def _restarted(watch, count):
    """Switches the viewport off and on `count` times; memory in MiB after each tenth of them."""
    shading, memory = viewport.space().shading, []
    for i in range(count):
        shading.type = "SOLID"
        yield 0.05
        watch.start()
        shading.type = "RENDERED"
        yield from watch.until_seen()
        if (i + 1) % max(count // 10, 1) == 0:
            memory.append(_resident_mib())
    return {"count": count, "mib": memory}


def _real_time():
    """Seconds per real-time picture: redrawn and read back, so that drawing has completed."""
    bpy.context.scene.velour.viewport_mode = "REAL_TIME"
    yield from viewport.real_time_finished()
    shown, (width, height) = viewport.real_time(), PICTURE
    with viewport.override():
        context = bpy.context
        frame = viewport.addon("export.viewport").viewport_frame(context, context.evaluated_depsgraph_get())
    drawing, view, seconds = shown._drawing, frame.view._replace(width=width, height=height), []
    for _ in range(REPEATS):
        begin = time.monotonic()
        drawing.restart()
        drawing.draw(shown._live.scene, view, 1.0, True).read()
        seconds.append(time.monotonic() - begin)
    return {"size": PICTURE, "seconds": seconds}


def _resident_mib():
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS")) / 1024
