"""Blender materials by number in the library's scene."""

from ..native import Shader, TextureSlot, VelourError
from .corner_colors import CornerColors, shader_colors
from .measured_materials import MeasuredMaterials
from .model_hashes import hashes_of
from .notes import ExportError, Notes
from .placement import Tile
from .programs import Computed, finished
from .shaders import (
    as_measured,
    as_principled,
    shines,
    sources_of,
    split,
    surface_layers,
    unlike_reflection,
)
from .shaders.layer import COLORS
from .shaders.measured import roughness_levels, with_effect
from .shaders.relief import correction
from .textures import TextureTable
from .uv_maps import UNUSED, UvMaps, shader_maps
from .visibility import hidden_backs


class MaterialTable:
    """Adds each material once, with its full model; those that may switch to a scene model are in `reduced`.

    `strict` refuses measured materials that cannot be read; otherwise (previews, the viewport) the nodes in
    their groups are rendered, with a note. `unit`: length of Blender's unit in the scene.
    """

    def __init__(self, scene, notes, strict=True, unit=1.0):
        self._scene = scene
        self._unit = unit
        self._notes = notes
        self.strict = strict
        self._numbers = {}
        self._labels = {}  # keys: material numbers
        self._uv_maps = {}
        self._colors = {}  # CornerColors of each
        self._tiles = {}  # Tiles of repeating materials
        self._turns = {}  # rotation of other anisotropic materials, radians
        self._textured = set()  # materials with textures
        self._programs = {}  # of materials; None: none
        self._textures = TextureTable(scene, notes)
        self._measured = MeasuredMaterials(scene, notes, unit)
        self.models = {}  # file hashes of measured materials, by full name
        self.glows = False  # whether any may emit light
        self.beyond_reflection = []  # notes: parts of mixed materials that a BTF cannot represent

    @property
    def reduced(self):
        return self._measured.reduced

    def find(self, material):
        """Number of an original material; None if nothing uses it."""
        return self._numbers.get(material.as_pointer())

    def tile(self, material):
        """Tile of an added material; None if it does not repeat."""
        return self._tiles.get(_key(material))

    def turn(self, material):
        """Rotation in radians of an added anisotropic material without tiles; 0 for others."""
        return self._turns.get(_key(material), 0.0)

    def uv_maps(self, material):
        """UvMaps of a material, which is added if needed."""
        self.number(material)
        return self._uv_maps[_key(material)]

    def colors(self, material):
        """CornerColors of a material in the order of their sets; the material is added if needed."""
        self.number(material)
        return self._colors.get(_key(material), ())

    def has_pictures(self, material):
        """Whether an added material uses textures."""
        return _key(material) in self._textured

    def needs_coordinates(self, material):
        """Whether an added material uses texture coordinates."""
        return self._uv_maps[_key(material)] != UNUSED

    def number(self, material):
        """Number of a material, which is added if needed; None: Blender's default gray."""
        key = _key(material)
        if key not in self._numbers:
            number = self._numbers[key] = self._add(material)
            self._labels[number] = _label(material)
        return self._numbers[key]

    def labels(self):
        """Name and pass index by number; the name is None for the default material."""
        return self._labels

    def renew(self, material):
        """Updates a changed material if it is in use.

        Returns whether its objects must be exported again, because texture coordinates or tiles changed.
        """
        key = _key(material)
        if key not in self._numbers:
            return False
        before = self._needs(key)
        if not self._adjust(material):
            self._add_anew(material)
        # Settings of the material determine how tiles are placed.
        return self._needs(key) != before or key in self._tiles

    def _adjust(self, material):
        """Updates a measured material in place; False if that is not enough: its model has changed."""
        number, measured = self._numbers[_key(material)], as_measured(surface_layers(material, self._notes))
        info = measured and self._measured.adjust(material, measured, number)
        if not info:
            return False
        self._forget_needs(material)
        self._note_measured(material, measured, info)
        self._labels[number] = _label(material)
        return True

    def _add_anew(self, material):
        key = _key(material)
        number = self._numbers.pop(key)
        self._forget_needs(material)
        self._measured.forget(material)
        self._measured.drop_reduced(number)
        added = self.number(material)
        self._scene.replace_material(number)
        self._numbers[key], self._labels[number] = number, self._labels.pop(added)
        self._measured.renumber(added, number)

    def _forget_needs(self, material):
        key = _key(material)
        self._tiles.pop(key, None)
        self._turns.pop(key, None)
        self._textured.discard(key)
        self._colors.pop(key, None)

    def _needs(self, key):
        placed = self._tiles.get(key), self._turns.get(key)
        return self._uv_maps[key], self._colors.get(key), placed, key in self._textured

    def _add(self, material):
        layers = surface_layers(material, self._notes, self._unit)
        if not any(layer.measured for layer in layers):
            return self._add_shader(material, layers)
        try:
            measured = as_measured(layers)
            if measured is None:
                return self._add_shader(material, layers)
            number, info = self._measured.add(material, measured)
            self._note_measured(material, measured, info)
            return number
        except (ExportError, VelourError) as error:
            if self.strict:
                raise
            self._notes.add(str(error))
        self._forget_needs(material)
        opened = surface_layers(material, Notes(), self._unit, opens_measured=True)
        return self._add_shader(material, opened)

    def _add_shader(self, material, layers):
        layers = [self._with_effect(layer, material) for layer in layers]
        sources, reliefs, draft = sources_of(layers)
        placed = self._note_mixed(material, layers)
        self._uv_maps[_key(material)] = shader_maps(_owner(material), sources, reliefs, self._notes, placed)
        self._colors[_key(material)] = shader_colors(_owner(material), sources, self._notes)
        self._programs[_key(material)] = draft and self._finished(draft, material)
        self.glows = self.glows or any(map(shines, layers))
        plain = as_principled(layers)
        self.beyond_reflection += [
            f"{_owner(material)}: {words} cannot be captured in a BTF; left out."
            for words in unlike_reflection(layers)
            if not plain or words == "transmitted light"
        ]
        if plain:
            values = plain.values | {"surface_correction": correction(material)}
            number = self._scene.add_textured_material(self._slots(plain, material), **values)
            return self._with_light_sampling(number, material)
        with Shader.new() as shader:
            for layer in layers:
                for part in split(layer):
                    for level in self._levels(part, material):
                        self._add_layer(shader, level, material)
            number = self._with_light_sampling(self._scene.add_shader_material(shader), material)
        if any(layer.measured for layer in layers):
            self._scene.hide_backs(number, hidden_backs(material))
        for shell in self._shells(material, layers):
            self._measured.set_shell(number, shell.node.velour)
        return number

    def _with_effect(self, layer, material):
        """The layer; if it is measured, without the pictures that its model does not support."""
        if not layer.measured or not layer.pictures:
            return layer
        layer, said = with_effect(layer, self._measured.of_layer(material, layer.measured).info)
        for sentence in said:
            self._notes.add(f"{_owner(material)}: {sentence}")
        return layer

    def _levels(self, layer, material):
        """The layer; layers with constant roughness offsets in place of a measured one with a varying one."""
        picture = layer.pictures.get("roughness") if layer.measured else None
        if picture is None or self._slot(picture, False, material) is None:
            return [layer]
        info = self._measured.of_layer(material, layer.measured).info
        return roughness_levels(layer, info["narrowest_roughness"])

    def _note_mixed(self, material, layers):
        """Records which coordinates the measured layers of a mixed material need.

        Returns the name of the UV map that places them; None if nothing is placed.
        """
        key, placed = _key(material), []
        mixed = [layer.measured for layer in layers if layer.measured]
        for measured in mixed:
            self._forget_needs(material)
            self._note_measured(material, measured, self._measured.of_layer(material, measured).info)
            if self._uv_maps[key] != UNUSED:
                placed.append((self._uv_maps[key].first, self._tiles.get(key), self._turns.get(key)))
        if mixed:
            self.models[material.name_full] = hashes_of([measured.node for measured in mixed])
        if not placed:
            return None
        if len({(name, tile and tile.place, turn) for name, tile, turn in placed}) > 1:
            self._notes.add(
                f"{_owner(material)}: its measured nodes are placed differently, but a material has one"
                " placement; that of the first node is used for all."
            )
        self._forget_needs(material)
        name, tile, turn = placed[0]
        self._tiles |= {key: tile} if tile else {}
        self._turns |= {key: turn} if turn is not None else {}
        if len(self._shells(material, layers)) > 1:
            raise ExportError(
                f"{_owner(material)}: it mixes two measured nodes with a silhouette (VOTF), but a surface has"
                " one silhouette; leave out one of them."
            )
        return name

    def _shells(self, material, layers):
        """The Measured of layers whose model has a VOTF."""
        measured = [layer.measured for layer in layers if layer.measured]
        return [each for each in measured if "shell" in self._measured.of_layer(material, each).info]

    def _finished(self, draft, material):
        """The Program of a Draft."""
        key = _key(material)

        def texture(picture, is_color):
            self._textured.add(key)
            return self._textures.texture(picture, is_color, _owner(material))

        return finished(draft, self._uv_maps[key], self._colors[key], texture)

    def _with_light_sampling(self, number, material):
        """Sets the light sampling of a material; returns its number."""
        if not draws_rays(material):
            self._scene.set_drawn_to(number, False)
        return number

    def _add_layer(self, shader, layer, material):
        values = dict(layer.values)
        if layer.relief:
            values["normal"] = self._slot(layer.relief.picture, True, material)
            values["normal_strength"] = layer.relief.strength
            values["normal_correction"] = "as-it-is" if layer.relief.is_surface else correction(material)
        if layer.coat_relief:
            values["coat_normal"] = self._slot(layer.coat_relief.picture, True, material)
            values["coat_normal_strength"] = layer.coat_relief.strength
            values.setdefault("normal_correction", correction(material))
        if layer.measured:
            values |= {n: s for n, s in self._slots(layer, material).items() if n in ("rotation", "scale")}
            tile = self._tiles.get(_key(material))
            values["aspect"] = tile.aspect if tile else 1.0
            self._measured.of_layer(material, layer.measured).add_layer(shader, **values)
            shader.weigh_layer("tint", layer.measured.look.gain)
        else:
            values["surface_correction"] = correction(material)
            shader.add_layer(layer.kind, self._slots(layer, material), **values)
        for factor in layer.factors:
            slot = factor.picture and self._slot(factor.picture, factor.kind == "tint", material)
            shader.weigh_layer(factor.kind, factor.value, *(slot or ()))

    def _slots(self, layer, material):
        """TextureSlots of a Layer's readable images and of its CornerColors."""
        slots = {n: self._slot(picture, n in COLORS, material) for n, picture in layer.pictures.items()}
        return {name: slot for name, slot in slots.items() if slot}

    def _slot(self, picture, is_color, material):
        """TextureSlot of a picture or of what replaces one; None: use the socket's own value."""
        if isinstance(picture, Computed):
            return TextureSlot(self._programs[_key(material)].texture(picture.index))
        if isinstance(picture, CornerColors):
            colors = self._colors[_key(material)]
            return self._textures.of_corners(colors.index(picture)) if picture in colors else None
        self._textured.add(_key(material))
        return self._textures.slot(picture, is_color, _owner(material), self._uv_maps[_key(material)])

    def _note_measured(self, material, measured, info):
        """Records which coordinates a measured material needs. `info`: info of its model or measurement."""
        node, look, key = *measured, _key(material)
        self.models[material.name_full] = hashes_of([node])
        tile = Tile.of(material, node, look, info)
        if tile:
            self._tiles[key] = tile
        elif not info["isotropic"]:
            self._turns[key] = look.rotation
        is_placed = tile or not info["isotropic"]
        self._uv_maps[key] = UvMaps((look.map_of(node),), projects=True) if is_placed else UNUSED


def _label(material):
    return (material.name, material.pass_index) if material else (None, 0)


def _owner(material):
    return f"Material '{material.name}'" if material else "The default material"


def draws_rays(material):
    """Whether Cycles light-samples emissive surfaces; the setting exists only while Cycles is enabled."""
    settings = getattr(material, "cycles", None)
    if settings is None:
        return True
    if hasattr(settings, "emission_sampling"):  # 3.5 and newer
        return settings.emission_sampling != "NONE"
    return getattr(settings, "sample_as_light", True)


def _key(material):
    """Pointer of the original datablock, for any evaluated copy of it."""
    return material.original.as_pointer() if material else None
