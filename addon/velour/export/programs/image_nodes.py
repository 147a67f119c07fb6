"""Image Texture and Environment Texture nodes inside programs."""

import math

from ..image_nodes import UnsupportedError, is_identity, unplaced_picture, uv_placement
from .coordinate_nodes import mapped, position
from .draft import ImageNumber, UvSet, Value
from .math_nodes import known


def _image(c, plug):
    return _looked_up(c, plug, _place)


def _environment(c, plug):
    return _looked_up(c, plug, _place_in_environment)


def _looked_up(c, plug, place):
    picture = unplaced_picture(plug, c.reader.owner, c.reader.notes)._replace(uv_map=None)
    found = c.draft.one("image", (place(c, plug),), 3, (ImageNumber(picture, not picture.alpha),))
    return Value(found.first, 1) if picture.alpha else found


def _place(c, plug):
    try:
        uv_map, coordinates = uv_placement(plug)
    except UnsupportedError:
        vector = c.linked(plug.input("Vector"))
        return mapped(c, plug.node, c.source("uv", UvSet("")) if vector is None else vector)
    place = c.source("uv", UvSet(coordinates))
    if is_identity(uv_map):
        return place
    (a, b, x), (d, e, y) = uv_map.tolist()
    return c.draft.one("transform", (place,), 3, (), (a, b, 0, x, d, e, 0, y, 0, 0, 0, 0))


def _place_in_environment(c, plug):
    vector = mapped(c, plug.node, c.linked(plug.input("Vector")) or position(c))
    if known(plug.node, "projection", ("equirectangular", "mirror_ball")) == "equirectangular":
        return place_on_sphere(c.draft, vector)
    draft = c.draft
    x, y, z = map(draft.vector_math("normalize", vector)[0].component, range(3))
    depth = draft.math("maximum", draft.math("multiply_add", y, -0.5, 0.5), 0.0)
    width = draft.math("multiply", draft.math("sqrt", depth), 2.0)
    u, v = (draft.math("multiply_add", draft.math("divide", each, width), 0.5, 0.5) for each in (x, z))
    return draft.joined(u, v, draft.number(0.0))


def place_on_sphere(draft, vector):
    """Where an equirectangular image shows a direction: from its left and its bottom, as fractions."""
    x, y, z = map(draft.vector_math("normalize", vector)[0].component, range(3))
    u = draft.math("multiply_add", draft.math("arctan2", y, x), -0.5 / math.pi, 0.5)
    v = draft.math("multiply_add", draft.math("arcsine", z), 1.0 / math.pi, 0.5)
    return draft.joined(u, v, draft.number(0.0))


NODES = {"ShaderNodeTexImage": _image, "ShaderNodeTexEnvironment": _environment}
