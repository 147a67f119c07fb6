"""Motion while the shutter is open, read when Cycles reads it (sync_motion in blender/sync.cpp).

The engine steps through the times before anything is exported, stays in the middle for the export, and then
returns to the frame. For the pass Vector, the times are those of the previous and of the next frame.
"""

import contextlib
import math

import bpy
import numpy as np

from .camera import final_view, render_camera
from .meshes import object_shape, velocities
from .objects import is_mesh
from .programs.curves import curve_values

_MOST_KEYS = 129  # MAX_MOTION_STEPS of Cycles
_KEYS_OF_VECTOR = 3  # the previous frame, this one, the next
_FRAMES_OF_VECTOR = 2.0
_MIDDLE = {"START": 0.5, "CENTER": 0.0, "END": -0.5}  # of the shutter's time, from the frame on
_CURVE_VALUES = 256
_TIMES = 1025  # at which the opening of the shutter is given
_DIGITS = 6  # of a zoom; more would blur through rounding
_GONE = object()  # stands for the places of a particle that does not exist all the time


def shutter_is_open(scene, layer):
    """Whether what moves blurs in a view layer."""
    return scene.render.use_motion_blur and getattr(layer, "use_motion_blur", True)


def shows_motion(depsgraph, asked):
    """Whether an image shows what moves. `asked`: keys of table.PASSES."""
    return "vector" in asked or shutter_is_open(depsgraph.scene_eval, depsgraph.view_layer_eval)


@contextlib.contextmanager
def motion_of_frame(engine, depsgraph, check_break):
    """Yields the Motion of a frame, with the depsgraph in the middle of it.

    `check_break` is called often and raises to cancel.
    """
    scene = depsgraph.scene
    blurs = shutter_is_open(depsgraph.scene_eval, depsgraph.view_layer_eval)
    frame, subframe = scene.frame_current, scene.frame_subframe
    try:
        motion = Motion(depsgraph, frame, blurs, render_camera(engine))
        if motion.middle != 0.0:
            _set_time(engine, frame + subframe + motion.middle)
        motion.expect()
        for key, time in motion.times(frame + subframe):
            check_break()
            _set_time(engine, time)
            motion.read(key, depsgraph, check_break)
        motion.finish()
        yield motion
    finally:
        engine.frame_set(frame, subframe)


def _set_time(engine, time):
    engine.frame_set(math.floor(time), time - math.floor(time))


class Motion:
    """What moves: camera, instances and meshes, each with its own number of keys at even times."""

    def __init__(self, depsgraph, frame, blurs, camera):
        """`frame`: the one that is rendered. `blurs`: false if only the pass Vector shows what moves.
        `camera`: that of the frame; None: there is none."""
        self.frame = frame
        render = depsgraph.scene_eval.render
        self._depsgraph, self._blurs = depsgraph, blurs
        self._frames = (
            render.motion_blur_shutter if blurs else _FRAMES_OF_VECTOR
        )  # from the first key to the last
        self._seconds = self._frames * render.fps_base / render.fps
        self.middle = _MIDDLE[_position(depsgraph.scene_eval)] * self._frames if blurs else 0.0
        self._shutter = _shutter_curve(render) if blurs else None
        self._camera = camera
        self._views = [None] * (self._count(camera, camera) if camera else 0)
        self._places = {}  # by key of an instance: rows of its matrix at each key; None where it is missing
        self._particles = set()  # keys of instances
        self._shapes = {}  # by object: its Shape at each key
        self._names = {}  # of these objects
        self._asking = set()  # objects whose deformation shows
        self._has_velocities = False  # whether meshes of these store velocities
        self.sentences = []  # on what is not blurred
        self._keys = 0

    def expect(self):
        """Looks for what may move, with the depsgraph in the middle, as what exists only then blurs, too."""
        for instance in self._instances():
            self._expect(instance)
        self._keys = max([len(self._views), *map(len, self._places.values())])

    def times(self, frame):
        """Pairs of a key, of those with the most keys, and its time in frames. The middle comes last."""
        middle = frame + self.middle
        if self._keys < 2:
            return [(0, middle)]
        keys = list(range(self._keys))
        keys.append(keys.pop(self._keys // 2))
        return [(key, middle + self._frames * (key / (self._keys - 1) - 0.5)) for key in keys]

    def read(self, key, depsgraph, check_break):
        """Reads what Blender shows at a key."""
        at = self._place(key, self._views)
        if at is not None:
            self._views[at] = final_view(depsgraph, camera=self._camera)
        seen = set()
        for instance in self._instances():
            check_break()
            places = self._places.get(_key(instance))
            at = self._place(key, places)
            if at is not None:
                matrix = instance.matrix_world
                places[at] = (*matrix[0], *matrix[1], *matrix[2])
            obj = instance.object
            owner = obj.original.as_pointer()
            shapes = self._shapes.get(owner)
            at = self._place(key, shapes)
            if key == self._keys // 2 and owner in self._asking and velocities(obj) is not None:
                self._has_velocities = True
                self._shapes.pop(owner, None)
            elif at is not None and owner not in seen and self._is_own_data(obj):
                seen.add(owner)
                shapes[at] = object_shape(obj)

    def _place(self, key, values):
        """Index of a key among fewer keys; None if they have none at that time."""
        if not values:
            return None
        stride = (self._keys - 1) // (len(values) - 1)
        return None if key % stride else key // stride

    def finish(self):
        """Drops what does not move."""
        places = {key: self._moving(key, found) for key, found in self._places.items()}
        self._places = {key: found for key, found in places.items() if found is not None}
        shapes = {owner: self._deforming(owner, found) for owner, found in self._shapes.items()}
        self._shapes = {owner: found for owner, found in shapes.items() if found}

    def is_hidden(self, instance):
        """Whether Cycles leaves it out."""
        return self._places.get(_key(instance)) is _GONE

    def places(self, instance):
        """[keys x 3 x 4] matrices of an instance that moves; None: it stays."""
        found = self._places.get(_key(instance))
        return found if isinstance(found, np.ndarray) else None

    def shapes(self, obj, arrays):
        """Fields that the MeshArrays of an object get if it deforms."""
        owner = obj.original.as_pointer()
        speeds = velocities(obj) if self._has_velocities and owner in self._asking else None
        if speeds is not None and len(speeds) == len(arrays.positions):
            return _moved_by(speeds * self._seconds, arrays)
        found = self._shapes.get(owner)
        return found if found and self._is_own_data(obj) else {}

    def on(self, view):
        """The View with the motion of the camera and the shutter."""
        matrices = np.array([each.camera_to_world for each in self._views], np.float32)
        windows = np.array([_window(view, each) for each in self._views], np.float32)
        motion = {
            name: values
            for name, values in (("motion", matrices), ("motion_window", windows))
            if (values != values[:1]).any()
        }
        if self._blurs and (motion or self._places or self._shapes or self._has_velocities):
            motion["shutter"] = self._shutter
        return view._replace(motion=motion)

    def _instances(self):
        """Shown instances of meshes, each valid only within its iteration."""
        for instance in self._depsgraph.object_instances:
            if instance.show_self and is_mesh(instance.object):
                yield instance

    def _expect(self, instance):
        obj = instance.object
        parent = instance.parent or obj
        count = self._count(obj, parent)
        if not count:
            return
        key, owner = _key(instance), obj.original
        self._places[key] = [None] * count
        if instance.particle_system:
            self._particles.add(key)
        pointer = owner.as_pointer()
        if not self._asks(obj, parent, "use_deform_motion"):
            return
        self._asking.add(pointer)
        if len(self._shapes.get(pointer, ())) >= count or not self._is_own_data(obj):
            return
        if self._may_deform(owner):
            self._shapes[pointer] = [None] * count
            self._names[pointer] = owner.name

    def _count(self, obj, parent):
        """Number of keys of an object; 0: it does not blur."""
        if not self._blurs:
            return _KEYS_OF_VECTOR
        if not self._asks(obj, parent, "use_motion_blur"):
            return 0
        steps = max(getattr(getattr(each, "cycles", None), "motion_steps", 1) for each in (obj, parent))
        return min((2 << (max(steps, 1) - 1)) + 1, _MOST_KEYS)

    def _asks(self, obj, parent, name):
        """Whether a setting of Cycles is on for the object and for what instances it; without Cycles: yes."""
        settings = (getattr(each, "cycles", None) for each in (obj, parent))
        return not self._blurs or all(getattr(each, name, True) for each in settings)

    def _may_deform(self, owner):
        """Like Cycles: meshes made of curves, text and metaballs always may."""
        return owner.type != "MESH" or owner.is_deform_modified(self._depsgraph.scene, "RENDER")

    def _is_own_data(self, obj):
        """Whether it shows the mesh of its object, and not other geometry of geometry nodes."""
        own = obj.original.evaluated_get(self._depsgraph).data
        return obj.data == own or (not isinstance(own, bpy.types.Mesh) and obj.data.name == own.name)

    def _moving(self, key, places):
        """[keys x 3 x 4]; None: it stays."""
        middle = places[len(places) // 2]
        if middle is None or (None in places and key in self._particles):
            return _GONE
        places = [middle if place is None else place for place in places]
        if all(place == middle for place in places):
            return None
        return np.array(places, np.float32).reshape(-1, 3, 4)

    def _deforming(self, owner, shapes):
        """Fields of MeshArrays; None: it keeps its shape."""
        middle = shapes[len(shapes) // 2]
        if middle is None:
            return None
        if not all(shape is not None and middle.fits(shape) for shape in shapes):
            self.sentences.append(
                f"Object '{self._names[owner]}': its number of vertices changes while the shutter is open, so"
                " its deformation is not blurred; keep the number, or disable Deformation in its Motion Blur."
            )
            return None
        if all((shape.positions == middle.positions).all() for shape in shapes):
            return None
        return {
            f"moved_{field}": None if middle[i] is None else np.stack([each[i] for each in shapes])
            for i, field in enumerate(middle._fields)
        }


def _moved_by(way, arrays):
    """Fields of MeshArrays that move by [vertices x 3] from the first key to the last; their normals stay."""
    normals = {"moved_corner_normals": arrays.corner_normals, "moved_vertex_normals": arrays.vertex_normals}
    found = {name: None if each is None else np.stack([each] * 3) for name, each in normals.items()}
    found["moved_positions"] = arrays.positions + np.multiply.outer(np.float32((-0.5, 0.0, 0.5)), way)
    return found


def _position(scene):
    """START, CENTER or END: where the frame lies in the time of the shutter."""
    found = getattr(scene.render, "motion_blur_position", None)  # 4.1 and newer
    return found or getattr(getattr(scene, "cycles", None), "motion_blur_position", "CENTER")


def _window(view, moved):
    """The window of a View at the time of another: like Cycles, only what zooms a perspective camera moves.

    Its shift, and the scale of an orthographic camera, are those of the middle.
    """
    if view.kind == "orthographic":
        return view.window
    zoom = (moved.window[1] - moved.window[0]) / (view.window[1] - view.window[0])
    return [round(zoom, _DIGITS) * side for side in view.window]


def _shutter_curve(render):
    """[values] How far the shutter is open, at even times.

    Like Cycles' table of times (util_cdf_invert with 256 entries), which leaves out 1/512 of the light at
    both ends and ends at 255/256 of the shutter.
    """
    values = np.abs(np.array(curve_values(render.motion_blur_shutter_curve, _CURVE_VALUES)))
    if not values.any():
        return values.astype(np.float32)
    times = np.linspace(0, _CURVE_VALUES / (_CURVE_VALUES - 1), _TIMES)
    opening = np.interp(times, np.linspace(0, 1, _CURVE_VALUES), values, right=0.0)
    passed = np.cumsum(opening) / opening.sum()
    least = 0.5 / _CURVE_VALUES
    return np.where((passed > least) & (passed < 1 - least), opening, 0).astype(np.float32)


def _key(instance):
    """The same at each time, as Cycles' ObjectKey."""
    parent = instance.parent
    return (
        instance.object.original.as_pointer(),
        parent.original.as_pointer() if parent else 0,
        tuple(instance.persistent_id) if instance.is_instance else (),
    )
