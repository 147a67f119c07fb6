"""Blender's world: a color, or an environment image with strength and rotation."""

import math
import os

import numpy as np
from mathutils import Matrix

from .color import is_linear_rec709
from .files import absolute_path
from .newer import has_nodes
from .nodes import active_output, output, source
from .notes import ExportError
from .picture_files import linear_file
from .pixels import multiplies_floats, working_pixels
from .sequences import sequence_file, sequence_number
from .unused_settings import note_emitter

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
    images = [getattr(node, "image", None) for node in tree.nodes] if tree else []
    return any(image and image.source in _MOVING for image in images)


def add_world(light, world, frame, notes):
    """Sets the WorldLight `light` for a frame; returns whether it emits."""
    _note_visibility(world, notes)
    if world is None:
        return _add_color(light, (0.0, 0.0, 0.0))
    if not has_nodes(world):
        return _add_color(light, tuple(world.color))
    return _add_nodes(light, world, frame, notes)


def _add_color(light, color):
    light.set_color(color)
    return any(c != 0.0 for c in color)


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
    background = source(output.inputs["Surface"]) if output else None
    if output and source(output.inputs["Volume"]):
        notes.add(f"{owner}: volumes are not supported; ignored.")
    if background is None or background.bl_idname != "ShaderNodeBackground":
        if background is not None:
            notes.add(f"{owner}: node '{background.name}' is not a Background; rendered black.")
        return _add_color(light, (0.0, 0.0, 0.0))
    if source(background.inputs["Strength"]):
        notes.add(f"{owner}: the link to its strength is not supported; the value of the input is used.")
    strength = background.inputs["Strength"].default_value
    color = source(background.inputs["Color"])
    if color is not None and color.bl_idname == "ShaderNodeTexEnvironment":
        _add_environment(light, owner, color, strength, frame, notes)
        return strength != 0.0
    if color is not None:
        notes.add(
            f"{owner}: node '{color.name}' is not an Environment Texture; the Background's color is used."
        )
    return _add_color(light, tuple(strength * c for c in background.inputs["Color"].default_value[:3]))


def _add_environment(light, owner, node, strength, frame, notes):
    image = node.image
    if image is None:
        raise ExportError(f"{owner}: node '{node.name}' has no image; choose one, or unlink it.")
    if node.projection != "EQUIRECTANGULAR":
        raise ExportError(
            f"{owner}: node '{node.name}' is a mirror ball, which is not supported; choose Equirectangular."
        )
    rotation = _rotation(owner, node, notes)
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


def _rotation(owner, node, notes):
    """3 x 3 rotation from world directions to the image's, or None."""
    mapping = source(node.inputs["Vector"])
    if mapping is None or mapping.bl_idname != "ShaderNodeMapping":
        _note_coordinates(owner, node.inputs["Vector"], notes)
        return None
    _note_mapping(owner, mapping, notes)
    _note_coordinates(owner, mapping.inputs["Vector"], notes)
    rotation = _euler_matrix(mapping.inputs["Rotation"].default_value)
    inverse = mapping.vector_type == "TEXTURE"
    return np.array(rotation.transposed() if inverse else rotation, np.float32)


def _note_coordinates(owner, vector, notes):
    """Notes unsupported coordinates: only the ray direction, an Environment Texture's default, is used."""
    node = source(vector)
    if node is None:
        return
    if node.bl_idname != "ShaderNodeTexCoord":
        notes.add(f"{owner}: node '{node.name}' is not a Mapping; ignored.")
    elif output(vector).name != "Generated":
        name = output(vector).name
        notes.add(f"{owner}: node '{node.name}': {name} coordinates are not supported; Generated are used.")


def _euler_matrix(euler):
    return (
        Matrix.Rotation(euler[2], 3, "Z")
        @ Matrix.Rotation(euler[1], 3, "Y")
        @ Matrix.Rotation(euler[0], 3, "X")
    )


def _note_mapping(owner, mapping, notes):
    scale = mapping.inputs["Scale"].default_value
    location = mapping.inputs.get("Location")  # newer Blender versions have it only for types that use it
    moved = location is not None and any(abs(c) > 1e-6 for c in location.default_value)
    uneven = not all(math.isclose(s, scale[0], rel_tol=1e-5) and s > 0 for s in scale)
    if (moved and mapping.vector_type in ("POINT", "TEXTURE")) or uneven:
        notes.add(
            f"{owner}: node '{mapping.name}': only the rotation is supported; location and scale are ignored."
        )
    if any(source(socket) for socket in mapping.inputs if socket.name in ("Location", "Rotation", "Scale")):
        notes.add(
            f"{owner}: node '{mapping.name}': links to its inputs are not supported; their values are used."
        )
