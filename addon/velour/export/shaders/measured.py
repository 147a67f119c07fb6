"""Groups that contain a measured model, as layers."""

from typing import Any, NamedTuple

import numpy as np

from ..image_nodes import UnsupportedError, uv_map_of
from ..measured_look import INPUTS, MeasuredLook, former_look
from ..nodes import MeasuredNode, model_texture
from .layer import Factor, Layer
from .relief import read_relief


class Measured(NamedTuple):
    node: Any  # MeasuredNode
    look: MeasuredLook


def former_layer(node):
    """The Layer of a material of the former layout, whose links have no effect."""
    return Layer("measured", {}, {}, measured=Measured(node, former_look(node.velour)))


def read_measured(plug, reader):
    node = MeasuredNode(model_texture(plug.node.node_tree), plug.node)
    tint, picture = reader.number(plug.input(INPUTS["tint"])) if plug.input("Tint") else ((1.0,) * 3, None)
    values = {
        name: reader.value(plug.input(INPUTS[name]))
        for name in ("exposure", "roughness", "rotation", "scale")
        if plug.input(INPUTS[name])
    }
    values |= _read_vector(plug.input("Vector"), reader)
    # A picture replaces the color of its factor; the look keeps the rest.
    factors = (Factor("tint", tint, picture),) if picture else ()
    look = MeasuredLook((1.0,) * 3 if picture else tint, **values)
    relief = read_relief(plug, reader) if plug.input("Normal") else None
    return [Layer("measured", {}, {}, factors, relief, measured=Measured(node, look))]


def _read_vector(vector, reader):
    """`uv_map` and `mapping` of a MeasuredLook."""
    if vector is None:
        return {}
    try:
        mapping, name = uv_map_of(vector)
    except UnsupportedError as reason:
        reader.note_link(vector, f" ({reason})", used="the placement")
        return {}
    if name is None:
        return {}
    is_same = np.array_equal(mapping, np.eye(2, 3))
    return {"uv_map": name, "mapping": None if is_same else tuple(map(tuple, mapping.tolist()))}
