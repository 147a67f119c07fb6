"""Steps from a tile to its material on an object: which are done, and why the others have to wait."""

import functools
import json
import os
from typing import NamedTuple

import bpy

from ..core.measurement_files import INDICES
from ..export.nodes import velour_node
from ..export.objects import GEOMETRY
from ..operators.apply_material import targets
from ..operators.tiles import capture_folder
from .summaries import model_summary


class Step(NamedTuple):
    is_done: bool
    reason: str = ""  # why its button is gray. Empty: its turn has come


class Steps(NamedTuple):
    """In the order of the panel."""

    tile: Step
    capture: Step
    material: Step
    outline: Step
    application: Step


def steps(context, owner):
    """The Steps of an object or a collection. Safe in draw()."""
    material = owner.velour.material
    node = velour_node(material) if material is not None else None
    image = node.image if node is not None else None
    is_captured, shown = _is_captured(capture_folder(owner)), targets(context, owner)
    unmade = "Make the material first." if image is None else ""
    return Steps(
        Step(_has_geometry(owner)),
        Step(is_captured, "" if _has_geometry(owner) else "The tile has no geometry."),
        Step(image is not None, "" if is_captured else "Capture the tile first."),
        Step(image is not None and _has_outline(image), unmade),
        Step(
            bool(shown) and material is not None and all(obj.active_material == material for obj in shown),
            unmade or ("" if shown else "Choose an object as the target."),
        ),
    )


def _has_geometry(owner):
    parts = [owner] if isinstance(owner, bpy.types.Object) else owner.all_objects
    return any(obj.type in GEOMETRY and not _is_empty(obj) for obj in parts)


def _is_empty(obj):
    """Whether a mesh has no faces, nor a modifier that may make some."""
    return obj.type == "MESH" and not obj.data.polygons and not obj.modifiers


def _has_outline(image):
    info = model_summary(image)
    return isinstance(info, dict) and "shell" in info


def _is_captured(folder):
    """Whether a folder has a complete BTF. The index, which the capture writes last, is read once."""
    index = os.path.join(folder, INDICES[0])
    try:
        state = os.stat(index)
    except OSError:
        return False
    return _is_complete(index, state.st_mtime_ns, state.st_size)


@functools.lru_cache(maxsize=64)
def _is_complete(index, _time, _size):
    try:
        with open(index, encoding="utf-8") as file:
            return json.load(file)["content"] is not None
    except (OSError, ValueError, KeyError, TypeError):
        return False
