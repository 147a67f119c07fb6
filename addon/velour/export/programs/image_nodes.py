"""Image Texture nodes inside programs."""

from ..image_nodes import UnsupportedError, is_identity, unplaced_picture, uv_placement
from .draft import ImageNumber, UvSet, Value

_UNIT = (1.0, 0.0, 0.0, 1.0)


def _image(c, plug):
    picture = unplaced_picture(plug, c.reader.owner, c.reader.notes)._replace(uv_map=None)
    number = ImageNumber(picture, not picture.alpha)
    place, footprint, scale = _placed(c, plug)
    found = c.draft.one("image", (place,), 3, (number, footprint), scale)
    return Value(found.first, 1) if picture.alpha else found


def _placed(c, plug):
    """Place, the UvSet whose footprint counts, and the 2 x 2 matrix from its coordinates to the image's."""
    try:
        uv_map, coordinates = uv_placement(plug.input("Vector"))
    except UnsupportedError:
        # An area of arbitrary coordinates is not known; they are looked up at a point, as in Cycles.
        return c.input(plug.input("Vector")), 0, _UNIT
    place = c.source("uv", UvSet(coordinates))
    if not is_identity(uv_map):
        (a, b, x), (d, e, y) = uv_map.tolist()
        place = c.draft.one("transform", (place,), 3, (), (a, b, 0, x, d, e, 0, y, 0, 0, 0, 0))
    return place, UvSet(coordinates, 1), tuple(uv_map[:, :2].ravel().tolist())


NODES = {"ShaderNodeTexImage": _image}
