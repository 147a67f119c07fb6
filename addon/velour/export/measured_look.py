"""Look of a measured closure: the inputs of its node."""

from typing import NamedTuple

from .nodes import first_input


class MeasuredLook(NamedTuple):
    """The defaults render the model as it was fitted."""

    tint: tuple = (1.0, 1.0, 1.0)
    exposure: float = 0.0  # stops
    roughness: float = 0.0
    rotation: float = 0.0  # of tiles or of the direction of anisotropy, radians
    scale: float = 1.0  # factor on the size of tiles
    uv_map: str | None = None  # name of the UV map linked to Vector; None: that of the placement
    mapping: tuple | None = None  # [2 x 3]: from the mesh's (u, v, 1) to the linked Vector; None: the same

    def map_of(self, node):
        """Name of the UV map that places a MeasuredNode; "": the active render map."""
        return node.velour.placement.uv_map if self.uv_map is None else self.uv_map

    @property
    def gain(self):
        """Factor on the reflected light."""
        return tuple(channel * 2.0**self.exposure for channel in self.tint)


# Field of MeasuredLook: name of the input.
INPUTS = {
    "tint": "Tint",
    "exposure": "Exposure",
    "roughness": "Roughness Offset",
    "rotation": "Rotation",
    "scale": "Scale",
}


def constant_look(node):
    """The MeasuredLook of a MeasuredNode without its links, for panels and other programs."""
    if node.group is None:
        return former_look(node.velour)
    values = {}
    for field, name in INPUTS.items():
        socket = first_input(node.group, name)
        if socket is not None:
            values[field] = tuple(socket.default_value[:3]) if field == "tint" else socket.default_value
    return MeasuredLook(**values)


def former_look(settings):
    """The MeasuredLook of a material of the former layout."""
    placed = settings.placement.rotation
    return MeasuredLook(tuple(settings.tint), settings.exposure, settings.roughness, placed)
