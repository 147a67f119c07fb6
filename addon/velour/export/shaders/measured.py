"""Groups that contain a measured model, as layers."""

from typing import Any, NamedTuple

import numpy as np

from ..image_nodes import UnsupportedError, uv_map_of
from ..measured_look import INPUTS, MeasuredLook, former_look
from ..nodes import MeasuredNode, model_texture
from .layer import Factor, Layer
from .relief import read_relief
from .values import is_constant, own_value


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
        for name in ("roughness", "rotation", "scale")
        if plug.input(INPUTS[name])
    }
    values["exposure"], gains = _exposure(plug.input(INPUTS["exposure"]), reader)
    values |= _read_vector(plug.input("Vector"), reader)
    # A picture replaces the color of its factor; the look keeps the rest.
    factors = (*((Factor("tint", tint, picture),) if picture else ()), *gains)
    look = MeasuredLook((1.0,) * 3 if picture else tint, **values)
    relief = read_relief(plug, reader) if plug.input("Normal") else None
    return [Layer("measured", {}, {}, factors, relief, measured=Measured(node, look))]


def _exposure(plug, reader):
    """The exposure in stops, and the factors of one that varies."""
    if plug is None:
        return 0.0, ()
    if is_constant(plug):
        return reader.value(plug), ()
    draft = reader.compiler.draft
    stops = reader.compiler.input(plug)
    if stops.first < 0:  # with a note: the link cannot be evaluated
        return draft.constants_of(stops)[0], ()
    gain = draft.output(draft.math("POWER", 2.0, stops), "number")
    if gain is None:
        reader.note_link(plug, " (the material has too many computed inputs)")
        return own_value(plug), ()
    return 0.0, (Factor("gain", 1.0, gain),)


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
