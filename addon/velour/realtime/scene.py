"""Scene for the GPU, filled by the same exports as the library's scene."""

from __future__ import annotations

import contextlib
import math
import os
from functools import partial
from typing import NamedTuple

import numpy as np

from ..native import Scene, btf_maps_job, lobe_rows_job, principled_rows_job, shell_maps_job
from .errors import UnshownError
from .kept_tables import KeptTables, Part, digest
from .lamps import is_simpler, lamp_pixels
from .meshes import GpuMesh, split_meshes
from .pictures import GpuTexture, Picture
from .tables import (
    MOST_TERMS,
    BlackTables,
    BtfTables,
    LobeTables,
    PrincipledTables,
    ShellTables,
    WhiteTables,
)

_MOST_DRAWS = 20_000  # instance draws; more are slower than ray tracing
_MOST_LAMPS = 8  # with BTFs: btf.frag.glsl has room for these and as many narrow lobes of the environment
# Limits of parameters that may exceed 1; like the library's, a reflectance of 0.9 at normal incidence.
_MOST = {"specular": 11.25, "coat_index": 38.0}
_NUMBERS = ("metallic", "roughness", "specular", "coat", "coat_roughness", "coat_index")
_UNPLACED = np.array(((1, 0, 0), (0, 1, 0)), np.float32)


class Look(NamedTuple):
    """A material."""

    parts: tuple  # Parts; the first determines the shader, the last may be the VOTF
    emission: tuple = (0.0, 0.0, 0.0)
    is_simpler: bool = False  # drawn in a simpler way than by the ray tracer
    shell_aspect: float | None = None  # aspect of the VOTF's tile; None: no VOTF
    shell_tile: float = 0.0  # meters; 0: from the texture coordinates
    hides_backs: bool = False  # hides back faces from the camera

    @property
    def has_shell(self):
        return self.shell_aspect is not None


class Group(NamedTuple):
    """Instances that differ only in their transforms."""

    mesh: int
    materials: tuple  # None: the slot is not drawn
    # [instances x 5 x 4]: matrix, then the map of texture coordinates; [3, 3] is the tile's width in meters,
    # [4, 3] is 1 for a holdout
    rows: np.ndarray
    in_shell: bool  # the mesh is drawn as the top of a shell


class RealtimeScene(Scene):
    """Receives a scene from export/. The library's scene in it contains only the environment."""

    def __init__(self, tables=None, threads=0):
        """`tables`: KeptTables that make the tables of materials; `threads`: threads per job, 0: all."""
        super().__init__()
        self.threads = threads
        self._tables = KeptTables() if tables is None else tables
        self.looks = []
        self.meshes = []  # GpuMesh; None: removed
        self.groups = []
        self.gains = []
        self.lamps = []
        self.simpler_lamps = 0  # number of lights drawn in a simpler way than by the ray tracer
        self.to_working = np.eye(3, dtype=np.float32)
        self._world = None  # part of world_key that place_world() does not change
        self.world_key = None  # identifies everything that the environment is made from
        self.is_stale = False  # something changed that requires another export

    def set_working_space(self, rec709_to_working):
        super().set_working_space(rec709_to_working)
        self.to_working = np.asarray(rec709_to_working, np.float32).reshape(3, 3)

    # ---- geometry

    def add_meshes(self, meshes):
        first = len(self.meshes)
        self.meshes += [GpuMesh(arrays) for arrays in split_meshes(meshes)]
        count = len(self.meshes) - first
        return np.arange(first, first + count, dtype=np.uint32), np.zeros(count, np.uint32)

    def remove_mesh(self, mesh):
        self.meshes[mesh] = None

    def add_instance(self, mesh, object_to_world, materials, placements=None, hidden=(), terminator=0.0):
        matrix = np.asarray(object_to_world, np.float32).reshape(1, 3, 4)
        maps = [_UNPLACED] if placements is None else np.asarray(placements, np.float32).reshape(-1, 2, 3)
        for slot, placed in enumerate(maps):
            only = None if placements is None else slot
            self._add_group(mesh, matrix, materials, placed, hidden, only)

    def add_instances(self, meshes, object_to_world, materials, hidden=(), terminator=0.0):
        for mesh in np.unique(meshes):
            self._add_group(int(mesh), object_to_world[meshes == mesh], materials, _UNPLACED, hidden)

    def _add_group(self, mesh, matrices, materials, placed, hidden, only=None):
        """`only`: the only slot to be drawn; None: all slots."""
        if "camera" in hidden:
            return
        is_holdout = "holdout" in hidden
        slots = range(len(materials)) if only is None else (only,)
        plain = []
        for slot in slots:
            widths = self._tile_widths(mesh, matrices, materials, slot, placed)
            if widths is None or not widths.all():  # the height of the shell is unknown
                plain.append(slot)
            else:
                self.groups.append(_group(mesh, matrices, materials, placed, [slot], is_holdout, widths))
        if plain:
            self.groups.append(_group(mesh, matrices, materials, placed, plain, is_holdout))

    def _tile_widths(self, mesh, matrices, materials, slot, placed):
        """Tile widths in meters for a material with a VOTF; None without one."""
        look, gpu_mesh = self.looks[materials[slot]], self.meshes[mesh]
        if not look.has_shell or not gpu_mesh.has_uvs:
            return None
        if not gpu_mesh.prepare_shell():
            self.is_stale = True
            return None
        stretch = abs(np.linalg.det(np.asarray(placed, float)[:, :2]))
        widths = gpu_mesh.widths.of_instances(matrices, slot, len(materials) - 1, stretch, look.shell_aspect)
        return np.where(widths > 0, look.shell_tile, 0) if look.shell_tile > 0 else widths

    def clear_instances(self):
        self.groups = []

    # ---- materials

    def add_model_material(self, model, neighbors=0):
        info, content = model.info(), digest(model.bytes())
        if "texels" not in info:
            parts = [self._part(content, LobeTables, lambda: lobe_rows_job(model, self.threads))]
        elif info["model"] == "srbf-btf" and info["coefficients"] <= MOST_TERMS:
            parts = [self._part(content, BtfTables, lambda: btf_maps_job(model))]
        else:
            raise UnshownError("BTF models other than SRBF are supported by the ray tracer only")
        aspect = None
        if "shell" in info:
            aspect = info["shell"]["points"][1] / info["shell"]["points"][0]
            parts.append(self._part(content, ShellTables, lambda: shell_maps_job(model)))
        return self._add_look(Look(tuple(parts), shell_aspect=aspect))

    def add_measurement_material(self, measurement, proposal=None, neighbors=0):
        raise UnshownError("measurements are supported by the ray tracer only")

    def add_btf_material(self, btf, most_bytes=0):
        raise UnshownError("BTFs without a model are supported by the ray tracer only")

    def texture(self, pixels, **options):
        return GpuTexture.from_pixels(pixels, **options)

    def add_textured_material(self, textures, **values):
        emission = tuple(values.pop("emission", (0.0, 0.0, 0.0)))
        slot = textures.get("base_color")
        is_drawn = slot is not None and Picture.can_be(slot)
        is_simpler = len(textures) > is_drawn or values.pop("alpha", 1.0) < 1.0 or "coat" in values
        if not is_drawn:
            return self._add_look(Look((self._rows(values, PrincipledTables),), emission, is_simpler))
        picture = Picture(slot)
        # Multiple scattering of rough metals is not linear in the color: dark colors are drawn too bright.
        is_simpler = is_simpler or (values.get("metallic", 0.0) > 0.0 and values.get("lobe") == "whole")
        black = self._rows({**values, "base_color": (0.0, 0.0, 0.0)}, BlackTables)
        white = self._rows({**values, "base_color": (1.0, 1.0, 1.0)}, WhiteTables, picture)
        return self._add_look(Look((black, white), emission, is_simpler))

    def add_shader_material(self, shader):
        return self._add_look(Look((self._rows({}, PrincipledTables),), is_simpler=True))

    def replace_material(self, material):
        self.is_stale |= self.looks[material].has_shell or self.looks[-1].has_shell  # other meshes are drawn
        self.looks[material], self.gains[material] = self.looks.pop(), self.gains.pop()

    def set_gain(self, material, gain):
        self.gains[material] = tuple(gain)

    def hide_backs(self, material, hidden):
        look = self.looks[material]
        self.looks[material] = look._replace(hides_backs="camera" in hidden and not look.has_shell)

    def set_drawn_to(self, material, drawn):
        """Ignored: emissive surfaces do not light others here."""

    def set_shell_tile(self, material, metres):
        self.looks[material] = self.looks[material]._replace(shell_tile=metres)

    def set_shell_softness(self, material, widths):
        """Ignored: edges are always hard."""

    def _part(self, content, tables, make_job, *shown):
        """Requests a table, from which `tables` is made with the arguments *shown; returns its Part."""
        key = (tables, content, self.to_working.tobytes(), *(each.key for each in shown))
        self._tables.ask(key, make_job)
        return Part(key, partial(tables, *shown))

    def _rows(self, values, tables, *shown):
        """The Part of a Principled material with these parameters."""
        values = _principled(values)
        key = tuple(sorted(values.items()))
        return self._part(key, tables, lambda: principled_rows_job(threads=self.threads, **values), *shown)

    def _add_look(self, look):
        self.looks.append(look)
        self.gains.append((1.0, 1.0, 1.0))
        return len(self.looks) - 1

    # ---- light

    def add_light(self, kind, color, light_to_world, **values):
        self.lamps.append(lamp_pixels(kind, color, np.asarray(light_to_world, float).reshape(3, 4), values))
        self.simpler_lamps += is_simpler(kind, values)

    def clear_lights(self):
        self.lamps, self.simpler_lamps = [], 0

    def set_world_color(self, color):
        super().set_world_color(color)
        self._note_world(("color", *color))

    def set_world_pixels(self, pixels, strength=1.0, world_to_image=None):
        super().set_world_pixels(pixels, strength, world_to_image)
        self._note_world(("pixels", digest(pixels), pixels.shape), strength, world_to_image)

    def set_world_file(self, path, strength=1.0, world_to_image=None, **options):
        stamp = _stamp(path)  # taken before the file is read
        super().set_world_file(path, strength, world_to_image, **options)
        self._note_world(("file", path, stamp, *options.values()), strength, world_to_image)

    def set_world_program(self, program, output, width, height):
        super().set_world_program(program, output, width, height)
        self._note_world(("program", object()))  # no other key is equal: programs cannot be compared

    def place_world(self, strength, world_to_image=None):
        super().place_world(strength, world_to_image)
        self._note_world(self._world, strength, world_to_image)

    def _note_world(self, world, strength=1.0, world_to_image=None):
        turn = None if world_to_image is None else np.asarray(world_to_image, np.float32).tobytes()
        self._world, self.world_key = world, (world, strength, turn, self.to_working.tobytes())

    def check(self):
        """Raises UnshownError if the scene exceeds the limits."""
        if self.draws > _MOST_DRAWS:
            raise UnshownError(f"more than {_MOST_DRAWS:,} instances are supported by the ray tracer only")
        if len(self.lamps) > _MOST_LAMPS and any(
            look.parts[0].tables.func is BtfTables for look in self.looks
        ):
            raise UnshownError(
                f"BTFs with more than {_MOST_LAMPS} lights are supported by the ray tracer only"
            )

    @property
    def draws(self):
        """Number of draws if each instance is drawn separately."""
        return sum(len(group.rows) * len(group.materials) for group in self.groups)


def _group(mesh, matrices, materials, placed, slots, is_holdout, widths=None):
    """The Group that draws these slots; `widths`: tile widths if it is the top of a shell."""
    rows = np.zeros((len(matrices), 5, 4), np.float32)
    rows[:, :3] = matrices
    rows[:, 3:, :3] = placed
    rows[:, 4, 3] = is_holdout
    if widths is not None:
        rows[:, 3, 3] = widths
    shown = tuple(m if slot in slots else None for slot, m in enumerate(materials))
    return Group(mesh, shown, rows, widths is not None)


def _stamp(path):
    """A value that differs for changed content; None if there is no file, which the reader refuses."""
    with contextlib.suppress(OSError):
        found = os.stat(path)
        return found.st_mtime_ns, found.st_size
    return None


def _principled(values):
    """Clamped parameters that determine a material's rows, as keywords of principled_rows_job."""
    known = {name: values[name] for name in _NUMBERS if name in values}
    choices = {name: values[name] for name in ("formula", "lobe", "coat_lobe") if name in values}
    color = tuple(min(max(c, 0.0), 1.0) for c in values.get("base_color", (0.8, 0.8, 0.8)))
    tints = {name: tuple(values[name]) for name in ("specular_tint", "coat_tint") if name in values}
    numbers = {n: min(max(v, 0.0), _MOST.get(n, 1.0)) if math.isfinite(v) else 0.5 for n, v in known.items()}
    return {"base_color": color, **tints, **numbers, **choices}
