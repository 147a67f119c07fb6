"""Image Texture nodes inside programs."""

from ..image_nodes import UnsupportedError, is_identity, unplaced_picture, uv_placement
from .draft import ImageNumber, UvSet, Value


def _image(c, plug):
    picture = unplaced_picture(plug, c.reader.owner, c.reader.notes)._replace(uv_map=None)
    found = c.draft.one("image", (_place(c, plug),), 3, (ImageNumber(picture, not picture.alpha),))
    return Value(found.first, 1) if picture.alpha else found


def _place(c, plug):
    try:
        uv_map, coordinates = uv_placement(plug.input("Vector"))
    except UnsupportedError:
        return c.input(plug.input("Vector"))
    place = c.source("uv", UvSet(coordinates))
    if is_identity(uv_map):
        return place
    (a, b, x), (d, e, y) = uv_map.tolist()
    return c.draft.one("transform", (place,), 3, (), (a, b, 0, x, d, e, 0, y, 0, 0, 0, 0))


NODES = {"ShaderNodeTexImage": _image}
