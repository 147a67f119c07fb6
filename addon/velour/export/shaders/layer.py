"""Layers, whose sum is the shader of a surface."""

from typing import NamedTuple

import bpy

from ..programs import Computed, sources_of_draft

# Parameters of layers that are colors.
COLORS = ("base_color", "specular_tint", "coat_tint", "sheen_tint")
BLACK = {"base_color": (0.0, 0.0, 0.0), "metallic": 0.0, "roughness": 1.0, "specular": 0.0}
# Without a material, Cycles shows diffuse before 5.0, and Principled since; no property reveals it.
_USUAL = {} if bpy.app.version >= (5, 0) else {**BLACK, "base_color": (0.8, 0.8, 0.8)}


class Factor(NamedTuple):
    kind: str  # "share" of a mix, its "rest", a "gain", a "tint" or a "level", as for Shader.weigh_layer
    value: float | tuple = 1.0
    picture: object = None  # image_nodes.Picture, corner_colors.CornerColors or Computed that replaces it


class Relief(NamedTuple):
    """A normal map, or a Computed normal in place of its picture."""

    picture: object
    strength: float
    uv_map: str = ""  # name of the UV map of its tangents; empty: the active render map
    is_surface: bool = False  # it is the surface's own normal, displaced; steep ones are not corrected


class Layer(NamedTuple):
    """Keywords of Shader.add_layer, sources that replace some, and factors of its weight.

    kind: as in Shader.add_layer, or "measured". A principled layer may hold alpha and emission until split()
    separates them.
    pictures: Pictures, CornerColors and Computed.
    """

    kind: str
    values: dict
    pictures: dict
    factors: tuple = ()
    relief: object = None  # Relief of the reflecting part
    glow: object = None  # emission Layer, to which alpha also applies
    measured: object = None  # Measured of a measured layer
    coat_relief: object = None  # Relief of a principled layer's coat

    def weighed(self, factor):
        return self._replace(factors=(*self.factors, factor))


def gray():
    """The layer of a surface without a material, or with an unsupported one."""
    return Layer("principled", dict(_USUAL), {})


def diffuse(color):
    return Layer("principled", {**BLACK, "base_color": color}, {})


def black():
    return Layer("principled", dict(BLACK), {})


def as_principled(layers):
    """The Layer of a material that is equivalent to one Principled node; None if it is mixed."""
    if len(layers) != 1 or layers[0].factors or layers[0].relief or layers[0].coat_relief:
        return None
    layer = layers[0]
    glow = layer if layer.kind == "emission" else layer.glow
    if glow and (glow.pictures or glow.factors):
        return None
    if layer.kind == "emission":
        layer = black()
    if glow:
        layer = layer._replace(values={**layer.values, "emission": glow.values["base_color"]}, glow=None)
    return layer if layer.kind == "principled" else None


def as_measured(layers):
    """The Measured of a material that is one measured model with a constant look; None if it is mixed."""
    if len(layers) != 1 or layers[0].factors or layers[0].relief or layers[0].coat_relief:
        return None
    return None if layers[0].pictures else layers[0].measured


def shines(layer):
    """Whether the layer emits light."""
    if layer.kind != "emission":
        return layer.glow is not None and shines(layer.glow)
    return "base_color" in layer.pictures or any(layer.values["base_color"])


def sources_of(layers):
    """What the layers read from meshes: Pictures, Coordinates and CornerColors, those of their program first;
    the UV maps of tangents of normal maps; and the Draft of their program, or None."""
    parts = [*layers, *(layer.glow for layer in layers if layer.glow)]
    given = [source for part in parts for source in part.pictures.values()]
    given += [factor.picture for part in parts for factor in part.factors if factor.picture]
    reliefs = [relief for part in parts for relief in (part.relief, part.coat_relief) if relief]
    given += [relief.picture for relief in reliefs]
    drafts = [source.draft for source in given if isinstance(source, Computed)]
    sources = [source for source in given if not isinstance(source, Computed)]
    maps = [relief.uv_map for relief in reliefs if not isinstance(relief.picture, Computed)]
    if not drafts:
        return sources, maps, None
    draft = drafts[0]
    return [*sources_of_draft(draft), *sources], [*maps, *draft.relief_maps], draft


def unlike_reflection(layers):
    """Names of the parts of the layers that a reflectance cannot represent."""
    kinds = []
    if any(layer.kind == "emission" or layer.glow for layer in layers):
        kinds.append("emission")
    clear = [layer for layer in layers if layer.kind == "transparent"]
    if any(layer.pictures or min(layer.values["base_color"]) < 1.0 for layer in clear):
        kinds.append("colored transparency")
    return kinds + (["transmitted light"] if any(map(_transmits, layers)) else [])


def _transmits(layer):
    """Whether light passes through the layer other than straight."""
    return (
        layer.kind in ("glass", "refraction", "translucent")
        or layer.values.get("transmission", 0.0) > 0.0
        or "transmission" in layer.pictures
    )


def split(layer):
    """Splits a layer into layers without alpha that either emit or reflect."""
    values, pictures = dict(layer.values), dict(layer.pictures)
    there = Factor("share", values.pop("alpha", 1.0), pictures.pop("alpha", None))
    layers = [layer._replace(values=values, pictures=pictures, glow=None)]
    if layer.glow:
        layers.append(layer.glow._replace(factors=layer.glow.factors + layer.factors))
    if there.picture is None and there.value >= 1.0:
        return layers
    open_part = Layer("transparent", {"base_color": (1.0, 1.0, 1.0)}, {}, layer.factors)
    return [part.weighed(there) for part in layers] + [open_part.weighed(there._replace(kind="rest"))]


def simplified(layers):
    """Removes factors of 1 and layers of weight 0."""
    found = []
    for layer in layers:
        numbers = [_constant(factor) for factor in layer.factors]
        if any(number == 0.0 for number in numbers):
            continue
        pairs = zip(layer.factors, numbers, strict=True)
        found.append(layer._replace(factors=tuple(factor for factor, number in pairs if number != 1.0)))
    return found or [black()]


def _constant(factor):
    """The constant value of a factor; None if a picture provides it."""
    if factor.picture is not None:
        return None
    if factor.kind == "tint":
        return None
    share = min(max(factor.value, 0.0), 1.0)
    return {"share": share, "rest": 1.0 - share, "gain": factor.value}[factor.kind]
