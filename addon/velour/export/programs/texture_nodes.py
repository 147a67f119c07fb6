"""Procedural textures."""

import bpy

from ...native import table
from .coordinate_nodes import generated, mapped
from .math_nodes import known

# No property reveals these changes of the formulas.
_INTEGER_HASH = bpy.app.version >= (5, 0)  # of Voronoi
_SCALED_FIRST = bpy.app.version >= (5, 2)  # Magic
# Blender's scenes do not have these sockets in all versions.
_USUAL = {"Detail": 0.0, "Roughness": 0.5, "Lacunarity": 2.0, "Offset": 0.0, "Gain": 1.0, "Distortion": 0.0}


def place(c, plug):
    """The Vector of a texture; unlinked: generated coordinates."""
    vector = c.linked(plug.input("Vector"))
    return mapped(c, plug.node, generated(c) if vector is None else vector)


def _number(c, plug, name):
    socket = plug.input(name)
    return c.draft.number(_USUAL[name]) if socket is None else c.input(socket)


def _dimensions(node, name):
    return int(known(node, name, ("1d", "2d", "3d", "4d"))[0])


def _placed(c, plug, dimensions):
    """Vector and W of a texture; what it does not use is 0."""
    vector = place(c, plug) if dimensions > 1 else c.draft.vector((0, 0, 0))
    return vector, c.input(plug.input("W")) if dimensions in (1, 4) else c.draft.number(0.0)


def _noise(c, plug):
    node = plug.node
    dimensions = _dimensions(node, "noise_dimensions")
    kind = known(node, "noise_type", table.NOISES) if hasattr(node, "noise_type") else "fbm"
    parts = {name: _number(c, plug, name) for name in ("Detail", *_USUAL)}
    detail = c.draft.math("maximum", parts["Detail"], 0.0)
    roughness = parts["Roughness"]
    if not hasattr(node, "normalize"):  # before 4.0
        roughness = c.draft.math("minimum", roughness, 1.0)
    inputs = (
        *_placed(c, plug, dimensions),
        c.input(plug.input("Scale")),
        detail,
        roughness,
        *(parts[name] for name in ("Lacunarity", "Offset", "Gain", "Distortion")),
    )
    asks_color = plug.socket.name == "Color" or node.outputs["Color"].is_linked
    choices = dimensions - 1, kind, getattr(node, "normalize", True), asks_color
    factor, color = c.draft.step("noise", inputs, (1, 3), choices)
    return color if plug.socket.name == "Color" else factor


def _musgrave(c, plug):
    """Up to Blender 4.0; later versions convert it to Noise in the same way."""
    node, draft = plug.node, c.draft
    dimensions = _dimensions(node, "musgrave_dimensions")
    kind = known(node, "musgrave_type", table.NOISES)
    lacunarity = draft.math("maximum", c.input(plug.input("Lacunarity")), 1e-5)
    dimension = draft.math("maximum", c.input(plug.input("Dimension")), 1e-5)
    octaves = draft.math("maximum", c.input(plug.input("Detail")), 0.0)
    inputs = (
        *_placed(c, plug, dimensions),
        c.input(plug.input("Scale")),
        draft.math("subtract", draft.math("minimum", octaves, 15.0), 1.0),
        draft.math("power", lacunarity, draft.math("multiply", dimension, -1.0)),
        lacunarity,
        c.input(plug.input("Offset")),
        c.input(plug.input("Gain")),
        draft.number(0.0),
    )
    return draft.step("noise", inputs, (1, 3), (dimensions - 1, kind, 0, 0))[0]


_VORONOI = {"Distance": 0, "Color": 1, "Position": 2, "W": 3, "Radius": 4}


def _voronoi(c, plug):
    node = plug.node
    dimensions = _dimensions(node, "voronoi_dimensions")
    feature = known(node, "feature", table.VORONOI_FEATURES)
    metric = known(node, "distance", table.METRICS)
    inputs = (
        *_placed(c, plug, dimensions),
        c.input(plug.input("Scale")),
        *(_number(c, plug, name) for name in ("Detail", "Roughness", "Lacunarity")),
        *(c.input(plug.input(name)) for name in ("Smoothness", "Exponent", "Randomness")),
    )
    flags = int(getattr(node, "normalize", False)) + 2 * _INTEGER_HASH
    found = c.draft.step("voronoi", inputs, (1, 3, 3, 1, 1), (dimensions - 1, feature, metric, flags))
    return found[_VORONOI[plug.socket.name]]


_WAVE_AXES = {"x": "x", "y": "y", "z": "z", "diagonal": "whole", "spherical": "whole"}
_WAVE = ("Scale", "Distortion", "Detail", "Detail Scale", "Detail Roughness", "Phase Offset")


def _wave(c, plug):
    node = plug.node
    is_rings = known(node, "wave_type", ("bands", "rings")) == "rings"
    axis = _WAVE_AXES[known(node, "rings_direction" if is_rings else "bands_direction", _WAVE_AXES)]
    profile = known(node, "wave_profile", table.WAVE_PROFILES)
    inputs = place(c, plug), *(c.input(plug.input(name)) for name in _WAVE)
    factor = c.draft.one("wave", inputs, 1, (is_rings, axis, profile))
    return c.draft.joined(factor, factor, factor) if plug.socket.name == "Color" else factor


def _gradient(c, plug):
    kind = known(plug.node, "gradient_type", table.GRADIENTS)
    factor = c.draft.one("gradient", (place(c, plug),), 1, (kind,))
    return c.draft.joined(factor, factor, factor) if plug.socket.name == "Color" else factor


def _factor_or_color(c, plug, operation, names, choices=(), more=()):
    """The asked output of a texture that returns a factor and a color."""
    inputs = place(c, plug), *(c.input(plug.input(name)) for name in names), *more
    factor, color = c.draft.step(operation, inputs, (1, 3), choices)
    return color if plug.socket.type == "RGBA" else factor


def _checker(c, plug):
    return _factor_or_color(c, plug, "checker", ("Color1", "Color2", "Scale"))


_BRICK = ("Color1", "Color2", "Mortar", "Scale", "Mortar Size", "Mortar Smooth", "Bias", "Brick Width")


def _brick(c, plug):
    node = plug.node
    more = c.draft.number(node.offset), c.draft.number(node.squash)
    frequencies = node.offset_frequency, node.squash_frequency
    return _factor_or_color(c, plug, "brick", (*_BRICK, "Row Height"), frequencies, more)


def _magic(c, plug):
    choices = plug.node.turbulence_depth, _SCALED_FIRST
    return _factor_or_color(c, plug, "magic", ("Scale", "Distortion"), choices)


def _white_noise(c, plug):
    """Unlike the coordinates of other textures, its own are a constant."""
    dimensions = _dimensions(plug.node, "noise_dimensions")
    vector = c.input(plug.input("Vector")) if dimensions > 1 else c.draft.vector((0, 0, 0))
    inputs = vector, c.input(plug.input("W")) if dimensions in (1, 4) else c.draft.number(0.0)
    value, color = c.draft.step("white_noise", inputs, (1, 3), (dimensions - 1,))
    return color if plug.socket.name == "Color" else value


NODES = {
    "ShaderNodeTexNoise": _noise,
    "ShaderNodeTexMusgrave": _musgrave,
    "ShaderNodeTexVoronoi": _voronoi,
    "ShaderNodeTexWave": _wave,
    "ShaderNodeTexGradient": _gradient,
    "ShaderNodeTexChecker": _checker,
    "ShaderNodeTexBrick": _brick,
    "ShaderNodeTexMagic": _magic,
    "ShaderNodeTexWhiteNoise": _white_noise,
}
