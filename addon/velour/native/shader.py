"""Materials that mix and add others."""

from __future__ import annotations

from ctypes import byref, pointer

from . import structs, table
from .arrays import small
from .errors import refuse
from .handle import Handle, choice, set_fields
from .texture import IDENTITY, Texture, TextureSlot

_COLORS = {"base_color": 3, "emission": 3, "specular_tint": 3, "coat_tint": 3}
_CHOICES = {"formula": table.FORMULAS, "lobe": table.LOBES, "coat_lobe": table.LOBES}


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
        **values,
    ) -> None:
        """Adds a layer with weight 1. `kind`: principled, diffuse, glossy, transparent, emission.

        textures and values: as for Scene.add_textured_material, without alpha and emission. diffuse uses
        base_color and roughness, glossy also lobe. base_color is the factor on transmitted light for
        transparent, the radiance for emission. normal: a normal map (colors) for reflection.
        normal_correction: treatment of steep normals: turned, faded, shadowed, as-it-is. interreflection: a
        rough diffuse layer keeps its energy.
        """
        desc = structs.LayerDesc()
        self._lib.vlr_layer_desc_init(byref(desc))
        surface, pictures = described(self._lib, textures or {}, values)
        desc.kind = choice("kind", kind, table.LAYERS)
        desc.surface, desc.textures = pointer(surface), pointer(pictures)
        if normal is not None:
            desc.normal, desc.normal_map = normal.texture.pointer, small("uv_map", normal.uv_map, 6)
            desc.normal_strength, desc.normal_set = normal_strength, normal.uv_set
            desc.normal_correction = choice("normal_correction", normal_correction, table.RELIEF_CORRECTIONS)
        desc.interreflection = interreflection
        self._lib.vlr_shader_add_layer(self.pointer, byref(desc))

    # SHIM until the library has measured layers; its wrapper replaces this method.
    def add_measured_layer(self, model=None, measurement=None, btf=None, **options) -> None:
        raise refuse("This build of Velour's library cannot mix measured materials with other shaders.")

    def weigh_layer(
        self, kind: str, value: float = 1.0, texture: Texture | None = None, uv_map=IDENTITY, uv_set=0
    ) -> None:
        """Multiplies the weight of the last layer: by `share` of a mix, its `rest` (1 - share), or a `gain`.

        A texture of numbers replaces the value.
        """
        desc = structs.FactorDesc()
        self._lib.vlr_factor_desc_init(byref(desc))
        desc.kind, desc.value = choice("kind", kind, table.FACTORS), value
        if texture is not None:
            desc.texture, desc.map = texture.pointer, small("uv_map", uv_map, 6)
            desc.set = uv_set
        self._lib.vlr_shader_weigh_layer(self.pointer, byref(desc))


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
    for name, slot in textures.items():
        uv_map = small("uv_map", slot.uv_map, 6)
        set_fields(pictures, {name: slot.texture.pointer, f"{name}_map": uv_map, f"{name}_set": slot.uv_set})
    return desc, pictures
