"""Materials that mix and add others."""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import byref, pointer
from typing import TYPE_CHECKING

from . import structs, table
from .arrays import small
from .handle import Handle, choice, set_fields
from .texture import IDENTITY, Texture, TextureSlot

if TYPE_CHECKING:
    from .btf import Btf
    from .measurement import Measurement
    from .model import Model

_COLORS = {"base_color": 3, "emission": 3, "specular_tint": 3, "coat_tint": 3, "sheen_tint": 3}
_CHOICES = {
    "formula": table.FORMULAS,
    "lobe": table.LOBES,
    "coat_lobe": table.LOBES,
    "glass_fresnel": table.GLASS_FRESNELS,
    "surface_correction": table.RELIEF_CORRECTIONS,
}


class Shader(Handle):
    """A weighted sum of layers; Scene.add_shader_material makes a material of it."""

    _free_name = "vlr_shader_free"

    @classmethod
    def new(cls) -> Shader:
        return cls._create("vlr_shader_create")

    def add_layer(
        self,
        kind: str,
        textures: dict[str, TextureSlot] | None = None,
        normal: TextureSlot | None = None,
        normal_strength: float = 1.0,
        normal_correction: str = "turned",
        interreflection: bool = False,
        coat_normal: TextureSlot | None = None,
        coat_normal_strength: float = 1.0,
        **values,
    ) -> None:
        """Adds a layer with weight 1. `kind`: principled, diffuse, glossy, transparent, emission, glass,
        refraction, translucent.

        textures and values: as for Scene.add_textured_material, without alpha and emission; principled takes
        textures of all its parameters (table.PARAMETERS), and `coat_normal` for its coat. diffuse uses
        base_color and roughness, glossy also lobe, glass and refraction also index and glass_fresnel,
        translucent base_color. base_color is the factor on transmitted light for
        transparent, the radiance for emission. normal: a normal map (colors) for reflection.
        normal_correction: treatment of steep normals: turned, faded, shadowed, as-it-is. interreflection: a
        rough diffuse layer keeps its energy.
        """
        desc = structs.LayerDesc()
        self._lib.vlr_layer_desc_init(byref(desc))
        surface, pictures = described(self._lib, textures or {}, values)
        desc.kind = choice("kind", kind, table.LAYERS)
        desc.surface, desc.textures = pointer(surface), pointer(pictures)
        _set_normal(desc, normal, normal_strength, normal_correction)
        desc.interreflection = interreflection
        if coat_normal:
            desc.coat_normal = coat_normal.texture.pointer
            desc.coat_normal_map = small("uv_map", coat_normal.uv_map, 6)
            desc.coat_normal_strength, desc.coat_normal_set = coat_normal_strength, coat_normal.uv_set
            desc.normal_correction = choice("normal_correction", normal_correction, table.RELIEF_CORRECTIONS)
        self._lib.vlr_shader_add_layer(self.pointer, byref(desc))

    def add_measured_layer(
        self,
        model: Model | None = None,
        measurement: Measurement | None = None,
        btf: Btf | None = None,
        neighbors: int = 0,
        most_bytes: int = 0,
        uv_map=IDENTITY,
        normal: TextureSlot | None = None,
        normal_strength: float = 1.0,
        normal_correction: str = "turned",
        rotation: TextureSlot | None = None,
        scale: TextureSlot | None = None,
        aspect: float = 1.0,
    ) -> None:
        """Adds a model, a raw measurement (sampled by `model` if given) or a BTF as a layer with weight 1.

        uv_map: from the surface's texture coordinates to those of the layer; it also turns an anisotropic
        BRDF. A model with a silhouette (VOTF) must not be moved, and gives it to the material, which can have
        only one. neighbors, most_bytes: as for Scene.add_model_material and Scene.add_btf_material. normal,
        normal_strength, normal_correction: as for add_layer. rotation (radians, counterclockwise), scale:
        move the layer by point, after uv_map and about the origin of its coordinates; aspect: of its tiles,
        width divided by height.
        """
        desc = structs.MeasuredLayerDesc()
        self._lib.vlr_measured_layer_desc_init(byref(desc))
        desc.model = model.pointer if model else None
        desc.measurement = measurement.pointer if measurement else None
        desc.btf = btf.pointer if btf else None
        desc.neighbors, desc.most_bytes = neighbors, most_bytes
        desc.map = small("uv_map", uv_map, 6)
        _set_normal(desc, normal, normal_strength, normal_correction)
        desc.aspect = aspect
        for name, slot in (("rotation", rotation), ("scale", scale)):
            if slot is not None:
                uv_map = small("uv_map", slot.uv_map, 6)
                set_fields(
                    desc, {name: slot.texture.pointer, f"{name}_map": uv_map, f"{name}_set": slot.uv_set}
                )
        self._lib.vlr_shader_add_measured_layer(self.pointer, byref(desc))

    def weigh_layer(
        self,
        kind: str,
        value: float | Sequence[float] = 1.0,
        texture: Texture | None = None,
        uv_map=IDENTITY,
        uv_set=0,
    ) -> None:
        """Multiplies the weight of the last layer: by `share` of a mix, its `rest` (1 - share), or a `gain`.

        `tint`: a color [3] in the working space that multiplies the layer's light. `level`: the share of a
        layer in a sequence for levels of a number; value: the level before, its own and the one after,
        ascending, equal at the ends. A texture replaces the value, or the number whose level it is; it has
        colors for a tint, otherwise numbers.
        """
        desc = structs.FactorDesc()
        self._lib.vlr_factor_desc_init(byref(desc))
        desc.kind = choice("kind", kind, table.FACTORS)
        if kind == "tint":
            desc.color = small("value", value if isinstance(value, Sequence) else (value,) * 3, 3)
        elif kind == "level":
            desc.level = small("value", value, 3)
        else:
            desc.value = value
        if texture is not None:
            desc.texture, desc.map = texture.pointer, small("uv_map", uv_map, 6)
            desc.set = uv_set
        self._lib.vlr_shader_weigh_layer(self.pointer, byref(desc))


def _set_normal(desc, normal: TextureSlot | None, strength: float, correction: str) -> None:
    if normal is None:
        return
    desc.normal, desc.normal_map = normal.texture.pointer, small("uv_map", normal.uv_map, 6)
    desc.normal_strength, desc.normal_set = strength, normal.uv_set
    desc.normal_correction = choice("normal_correction", correction, table.RELIEF_CORRECTIONS)


def fill_principled(desc: structs.PrincipledDesc, values: dict) -> None:
    """Sets numbers, colors and choices by the names of Scene.add_principled_material."""
    for name, value in values.items():
        if name in _COLORS:
            value = small(name, value, _COLORS[name])
        elif name in _CHOICES:
            value = choice(name, value, _CHOICES[name])
        set_fields(desc, {name: value})


def described(lib, textures: dict[str, TextureSlot], values: dict):
    """PrincipledDesc and PrincipledTextures of a material; they borrow the textures."""
    desc, pictures = structs.PrincipledDesc(), structs.PrincipledTextures()
    lib.vlr_principled_desc_init(byref(desc))
    lib.vlr_principled_textures_init(byref(pictures))
    fill_principled(desc, values)
    more = []
    for name, slot in textures.items():
        uv_map, texture = small("uv_map", slot.uv_map, 6), slot.texture.pointer
        if name in table.PARAMETERS:
            parameter = table.PARAMETERS.index(name)
            more.append(structs.ParameterTexture(parameter, slot.uv_set, texture, uv_map))
        else:
            set_fields(pictures, {name: texture, f"{name}_map": uv_map, f"{name}_set": slot.uv_set})
    pictures.more, pictures.more_count = (structs.ParameterTexture * len(more))(*more), len(more)
    return desc, pictures
