"""Groups that contain a measured model, as layers."""

import math
from typing import Any, NamedTuple

import numpy as np

from ...core.model_warnings import roughness_reason
from ..image_nodes import UnsupportedError, uv_map_of
from ..measured_look import INPUTS, MeasuredLook, former_look
from ..nodes import MeasuredNode, model_texture
from .layer import Factor, Layer
from .relief import read_relief
from .values import is_constant, own_value

VARYING = ("roughness", "rotation", "scale")  # fields of MeasuredLook that a layer's pictures may replace
_STEP = 2.0  # largest ratio of squared GGX alphas of neighboring levels
_FIRST_STEP = 1.2  # shares are linear in the offset, whose first half hardly widens a highlight
_LEAST_ROUGHNESS = 0.08  # of the narrowest highlight that levels resolve


class Measured(NamedTuple):
    node: Any  # MeasuredNode
    look: MeasuredLook

    def with_look(self, **values):
        return self._replace(look=self.look._replace(**values))


def with_effect(layer, info):
    """A measured layer without the pictures that its model does not support, and sentences on these.

    What pictures replace is neutral in the layer's look. `info`: of its model, measurement or BTF.
    """
    measured, pictures, said = layer.measured, {}, []
    reason = roughness_reason(info, measured.node.velour.use_reference)
    for name, picture in layer.pictures.items():
        if name == "roughness" and reason:
            said.append(reason)
        elif "shell" in info and not measured.node.velour.use_reference:
            said.append(
                f"node '{measured.node.group.name}': the link to '{INPUTS[name]}' is not supported for models"
                " with a silhouette (VOTF); the value of the input is used."
            )
        else:
            pictures[name] = picture
            measured = measured.with_look(**{name: MeasuredLook._field_defaults[name]})
    return layer._replace(pictures=pictures, measured=measured), said


def levels_of(narrowest):
    """Roughness offsets from 0 to 1 whose models, mixed with their neighbors, replace those in between.

    Squared alphas add up, so each but the first two makes a highlight of roughness `narrowest` wider by the
    same factor.
    """
    own = max(narrowest, _LEAST_ROUGHNESS) ** 4
    count = max(math.ceil(math.log(1.0 + 1.0 / own, _STEP)), 1)
    factors = [1.0, _FIRST_STEP, *((1.0 + 1.0 / own) ** (k / count) for k in range(1, count + 1))]
    return [min(own * (factor - 1.0), 1.0) ** 0.25 for factor in sorted(factors)]


def roughness_levels(layer, narrowest):
    """Layers with constant roughness offsets whose sum is a measured layer with a varying one."""
    picture = layer.pictures["roughness"]
    pictures = {name: each for name, each in layer.pictures.items() if name != "roughness"}
    levels = levels_of(narrowest)
    return [
        layer._replace(
            pictures=pictures,
            measured=layer.measured.with_look(roughness=level),
            factors=(*layer.factors, Factor("level", (before, level, after), picture)),
        )
        for before, level, after in zip(
            [levels[0], *levels[:-1]], levels, [*levels[1:], levels[-1]], strict=True
        )
    ]


def former_layer(node):
    """The Layer of a material of the former layout, whose links have no effect."""
    return Layer("measured", {}, {}, measured=Measured(node, former_look(node.velour)))


def read_measured(plug, reader):
    node = MeasuredNode(model_texture(plug.node.node_tree), plug.node)
    tint, picture = reader.number(plug.input(INPUTS["tint"])) if plug.input("Tint") else ((1.0,) * 3, None)
    values, pictures = {}, {}
    for name in VARYING:
        if socket := plug.input(INPUTS[name]):
            values[name], found = reader.number(socket)
            pictures |= {name: found} if found else {}
    values["exposure"], gains = _exposure(plug.input(INPUTS["exposure"]), reader)
    values |= _read_vector(plug.input("Vector"), reader)
    # A picture replaces the color of its factor; the look keeps the rest.
    factors = (*((Factor("tint", tint, picture),) if picture else ()), *gains)
    look = MeasuredLook((1.0,) * 3 if picture else tint, **values)
    relief = read_relief(plug, reader) if plug.input("Normal") else None
    return [Layer("measured", {}, pictures, factors, relief, measured=Measured(node, look))]


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
