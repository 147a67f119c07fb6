"""Blender's world: a color, an environment image with strength and rotation, or nodes that are evaluated."""

import math
import os

import numpy as np
from mathutils import Matrix

from ..color import is_linear_rec709, luminance_weights
from ..conversions import own_numbers
from ..files import absolute_path
from ..image_nodes import maps_coordinates
from ..newer import has_nodes
from ..nodes import active_output, all_nodes
from ..notes import ExportError
from ..picture_files import linear_file
from ..pixels import multiplies_floats, working_pixels
from ..plugs import Plug, fed_by
from ..sequences import sequence_file, sequence_number
from ..shaders.values import own_value
from ..unused_settings import note_emitter
from .nodes import emitted
from .sky import PendingError

_MOVING = ("SEQUENCE", "MOVIE")
_RAYS = {"diffuse": "diffuse rays", "glossy": "glossy rays"}


def layer_world(scene, layer):
    """The view layer's own world (4.3 and newer), or the scene's; may be None."""
    return getattr(layer, "world_override", None) or scene.world


def shown_world(depsgraph):
    """The evaluated world that lights the view layer; None if it is missing or switched off."""
    layer = depsgraph.view_layer_eval
    return layer_world(depsgraph.scene_eval, layer) if layer.use_sky else None


def has_moving_picture(world):
    """Whether it uses a sequence or movie; Blender does not report that their frame changes."""
    tree = world.node_tree if world and has_nodes(world) else None
    images = [getattr(node, "image", None) for node in all_nodes(tree)] if tree else []
    return any(image and image.source in _MOVING for image in images)


def add_world(light, world, frame, notes):
    """Sets the WorldLight `light` for a frame; returns whether it emits."""
    _note_visibility(world, notes)
    visibility = getattr(world, "cycles_visibility", None)
    light.hide(() if getattr(visibility, "transmission", True) else ("transmission",))
    if world is None:
        return _add_color(light, (0.0, 0.0, 0.0))
    if not has_nodes(world):
        return _add_color(light, tuple(world.color))
    return _add_nodes(light, world, frame, notes)


def _add_color(light, color):
    light.set_color(color)
    return any(c != 0.0 for c in color)


def _add_negative(light, owner, notes):
    notes.add(
        f"{owner}: its light is negative, which is not supported; rendered black. Use a strength above 0."
    )
    return _add_color(light, (0.0, 0.0, 0.0))


def _note_visibility(world, notes):
    """Notes unsupported visibility settings. Camera visibility is supported (film.py)."""
    visibility = getattr(world, "cycles_visibility", None)
    for name, rays in _RAYS.items():
        if not getattr(visibility, name, True):
            notes.add(f"World '{world.name}': hiding it from {rays} is not supported; ignored.")
    cycles = getattr(world, "cycles", None)
    if world:
        note_emitter(f"World '{world.name}'", cycles, notes)
    if not getattr(cycles, "use_shadows", True):  # 5.2 and newer
        notes.add(f"World '{world.name}': disabling its shadows is not supported; ignored.")


def _add_nodes(light, world, frame, notes):
    owner = f"World '{world.name}'"
    output = active_output(world.node_tree, "ShaderNodeOutputWorld")
    if output and fed_by(Plug(output.inputs["Volume"])):
        notes.add(f"{owner}: volumes are not supported; ignored.")
    surface = fed_by(Plug(output.inputs["Surface"])) if output else None
    if surface is None:
        return _add_color(light, (0.0, 0.0, 0.0))
    lone = _lone_environment(surface)
    if lone is not None:
        *picture, strength = lone
        if strength < 0.0:
            return _add_negative(light, owner, notes)
        _add_environment(light, owner, *picture, strength, frame, notes)
        return strength != 0.0
    try:
        found = emitted(surface, owner, notes, light.waits)
    except PendingError:
        return True  # what it was before is shown meanwhile
    if found.constant is not None:
        if np.dot(luminance_weights(), found.constant) < 0.0:
            return _add_negative(light, owner, notes)
        return _add_color(light, found.constant)
    light.set_nodes(found, owner, notes)
    return True


def _lone_environment(surface):
    """Node, rotation and strength of a world that is nothing but an Environment Texture; else None.

    Such an image lights the scene with its own texels, and may be one of a sequence.
    """
    color, strength = surface, 1.0
    if surface.node.bl_idname == "ShaderNodeBackground":
        if fed_by(surface.input("Strength")):
            return None
        color, strength = fed_by(surface.input("Color")), own_value(surface.input("Strength"))
    if color is None or color.node.bl_idname != "ShaderNodeTexEnvironment":
        return None
    rotation = _rotation(fed_by(color.input("Vector")))
    if rotation is None or color.node.projection != "EQUIRECTANGULAR" or maps_coordinates(color.node):
        return None
    return color.node, rotation, strength


def _rotation(vector):
    """3 x 3 rotation from world directions to an image's coordinates; None if these are something else."""
    if vector is None:
        return np.eye(3, dtype=np.float32)
    if vector.node.bl_idname == "ShaderNodeTexCoord" and vector.socket.name == "Generated":
        return np.eye(3, dtype=np.float32)
    if vector.node.bl_idname != "ShaderNodeMapping" or not _only_rotates(vector):
        return None
    before = _rotation(fed_by(vector.input("Vector"))) if fed_by(vector.input("Vector")) else None
    if before is None:
        return None
    rotation = _euler_matrix(own_numbers(vector.input("Rotation")))
    inverse = vector.node.vector_type == "TEXTURE"
    return np.array(rotation.transposed() if inverse else rotation, np.float32) @ before


def _only_rotates(mapping):
    """Whether a Mapping node maps directions by a rotation and a positive factor."""
    node = mapping.node
    location, rotation, size = (mapping.input(name) for name in ("Location", "Rotation", "Scale"))
    if any(map(fed_by, (location, rotation, size))):
        return False
    scale = own_numbers(size)
    if node.vector_type == "NORMAL" or not all(
        math.isclose(s, scale[0], rel_tol=1e-5) and s > 0 for s in scale
    ):
        return False
    moves = node.vector_type in ("POINT", "TEXTURE") and location is not None
    return not moves or all(abs(c) <= 1e-6 for c in own_numbers(location))


def _add_environment(light, owner, node, rotation, strength, frame, notes):
    image = node.image
    if image is None:
        raise ExportError(f"{owner}: node '{node.name}' has no image; choose one, or unlink it.")
    path = absolute_path(image)
    if image.source in _MOVING:
        light.set_file(_file_of_frame(owner, node, path, frame), strength, rotation)
    elif linear_file(image) and not multiplies_floats(image):
        light.set_file(path, strength, rotation)
    else:
        light.set_image(image, path, lambda: _pixels(owner, image, path, notes), strength, rotation)


def _is_linear(image, path):
    return path.lower().endswith((".exr", ".hdr")) and is_linear_rec709(image.colorspace_settings.name)


def _file_of_frame(owner, node, path, frame):
    """File of an image sequence, since Blender returns pixels of whichever frame it showed last."""
    image = node.image
    if image.source == "MOVIE" or not _is_linear(image, path):
        raise ExportError(
            f"{owner}: the image '{image.name}' is a movie, or a sequence of files other than OpenEXR and"
            " Radiance in linear Rec. 709, which is not supported; convert its frames, or use a single image."
        )
    path = sequence_file(path, sequence_number(node.image_user, frame))
    if not os.path.isfile(path):
        raise ExportError(
            f"{owner}: the image '{image.name}' has no file '{path}' for frame {frame}; put it back, or"
            f" change the frames of node '{node.name}'."
        )
    return path


def _pixels(owner, image, path, notes):
    """[height x width x 3] in the working space, row 0 at the top."""
    values = working_pixels(image, notes)
    if values is None:
        raise ExportError(
            f"{owner}: the image '{image.name}' ({path or 'no file'}) cannot be read; choose another file."
        )
    return np.ascontiguousarray(values[::-1, :, :3])


def _euler_matrix(euler):
    return (
        Matrix.Rotation(euler[2], 3, "Z")
        @ Matrix.Rotation(euler[1], 3, "Y")
        @ Matrix.Rotation(euler[0], 3, "X")
    )
