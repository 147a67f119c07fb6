"""The scene to render: meshes, materials, instances, lights, world, camera.

Meters, +z up, matrices 3 x 4 row-major.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Mapping
from ctypes import byref, c_float, c_uint32

import numpy as np

from . import library, structs, table
from .arrays import address, affine, checked, pointer, small
from .btf import Btf
from .errors import refuse
from .handle import Handle, choice, path_bytes, set_fields
from .images import picture_options
from .measurement import Measurement
from .mesh_descs import checked_mesh, mesh_descs
from .model import Model
from .program import Program
from .shader import Shader, described
from .texture import Texture, TextureSlot

_COLORS = {"color": 3, "size": 2, "window": 4, "cone_scale": 2}


class Scene(Handle):
    """Colors are linear, in the working space (Rec. 709 unless set_working_space says otherwise)."""

    _free_name = "vlr_scene_free"

    def __init__(self, lib=None, handle=None):
        if lib is None:
            lib = library.load()
            handle = ctypes.c_void_p()
            lib.vlr_scene_create(byref(handle))
        super().__init__(lib, handle)

    def set_working_space(self, rec709_to_working) -> None:
        """3 x 3 row-major; takes colors of measurements and models to the space of all other colors."""
        self._lib.vlr_scene_set_working_space(self.pointer, small("rec709_to_working", rec709_to_working, 9))

    # ---- geometry

    def add_mesh(self, positions: np.ndarray, triangles: np.ndarray, **arrays) -> tuple[int, int]:
        """Returns the mesh's number and the number of degenerate or non-finite triangles left out.

        float32: positions [v x 3] in meters; uint32: triangles [t x 3]. The others are optional. float32:
        corner_normals [t x 3 x 3], corner_uvs [t x 3 x 2], more_uvs [sets x t x 3 x 2] (texture coordinate
        sets 1, 2, ...), relief_uvs [t x 3 x 2] (for tangents of normal maps; default: corner_uvs),
        corner_colors [sets x t x 3 x 3] (Texture.of_corners); uint32: material_slots [t] (default: 0);
        uint8: smooth [t], 0: the triangle is flat (default: smooth; not together with corner_normals).

        With corner_vertices (uint32 [c]: the vertex of each face corner) `triangles` index corners, and
        arrays of t x 3 corners have c instead. Without corner_normals, smooth triangles have vertex_normals
        [v x 3], by default the means of the triangles around each vertex. The library copies all arrays.

        A mesh that deforms while the shutter is open has moved_positions [steps x v x 3], at even times from
        its opening to its close, and moved_corner_normals or moved_vertex_normals of as many steps.
        """
        mesh = checked_mesh({"positions": positions, "triangles": triangles, **arrays})
        numbers, dropped = self.add_meshes(mesh)
        return int(numbers[0]), int(dropped[0])

    def add_meshes(self, meshes: Mapping[str, tuple]) -> tuple[np.ndarray, np.ndarray]:
        """Adds all meshes or none. Returns the results of add_mesh() for each mesh, as uint32 [n].

        meshes: {argument of add_mesh(): (numbers of all meshes back to back, an array [m] of its type; their
        count per mesh, [n], 0: not given)}
        """
        descs = mesh_descs(meshes)
        first, dropped = c_uint32(), np.zeros(len(descs), np.uint32)
        self._lib.vlr_scene_add_meshes(
            self.pointer, address(descs), len(descs), byref(first), address(dropped)
        )
        return np.arange(first.value, first.value + len(descs), dtype=np.uint32), dropped

    def remove_mesh(self, mesh: int) -> None:
        """Empties a mesh that no instance shows. Its number stays valid."""
        self._lib.vlr_scene_remove_mesh(self.pointer, mesh)

    def load_mesh(self, path: str | os.PathLike) -> int:
        """Reads a Wavefront OBJ or a Stanford PLY (.ply) file. Returns the mesh's number."""
        return self._numbered("vlr_scene_load_mesh", path_bytes(path))

    def add_instance(
        self, mesh: int, object_to_world, materials, placements=None, hidden=(), terminator: float = 0.0
    ) -> None:
        """`materials`: material number of each slot of the mesh.

        placements: for each slot a map [2 x 3] from the mesh's (u, v, 1) to the texture coordinates of its
        material, which also applies to footprints and tangents; None: the mesh's own. hidden: names of rays
        that pass through the instance ("camera", "bounces", "shadows"); "holdout": the camera sees neither
        the instance nor anything behind it. terminator: geometry offset of the shadow terminator, 0 to 1.

        object_to_world [3 x 4], or [steps x 3 x 4] of an instance that moves, at even times while the shutter
        is open.
        """
        moves = getattr(object_to_world, "ndim", 2) == 3
        steps = len(object_to_world) if moves else 1
        self._set_looks(hidden, terminator, steps)
        numbers = (c_uint32 * len(materials))(*materials)
        matrix = (
            small("object_to_world", object_to_world, 12 * steps)
            if moves
            else affine("object_to_world", object_to_world)
        )
        if placements is not None:
            placements = small("placements", placements, 6 * len(materials))
        self._lib.vlr_scene_add_placed_instance(self.pointer, mesh, matrix, numbers, placements, len(numbers))

    def add_instances(
        self, meshes: np.ndarray, object_to_world: np.ndarray, materials, hidden=(), terminator: float = 0.0
    ) -> None:
        """Adds instances that differ only in meshes, uint32 [n], and matrices, float32 [n x 3 x 4] or
        [n x steps x 3 x 4].

        Otherwise like add_instance().
        """
        rest = (None, 3, 4) if getattr(object_to_world, "ndim", 3) == 4 else (3, 4)
        matrices = checked("object_to_world", object_to_world, (None, *rest))
        meshes = checked("meshes", meshes, (len(matrices),), np.uint32)
        self._set_looks(hidden, terminator, matrices.shape[1] if matrices.ndim == 4 else 1)
        numbers = (c_uint32 * len(materials))(*materials)
        self._lib.vlr_scene_add_instances(
            self.pointer, address(meshes), address(matrices), len(matrices), numbers, len(numbers)
        )

    def _set_looks(self, hidden, terminator: float, steps: int) -> None:
        self._lib.vlr_scene_hide_instances(self.pointer, _hidden_from(hidden))
        self._lib.vlr_scene_soften_terminator(self.pointer, terminator)
        self._lib.vlr_scene_move_instances(self.pointer, steps)

    def clear_instances(self) -> None:
        """Removes all instances. Meshes and materials stay."""
        self._lib.vlr_scene_clear_instances(self.pointer)

    # ---- materials: each returns its number

    def add_model_material(self, model: Model, neighbors: int = 0) -> int:
        """`neighbors`: view directions mixed at run time; 0: the model's default."""
        return self._numbered("vlr_scene_add_model_material", model.pointer, neighbors)

    def set_model_material(self, material: int, model: Model, neighbors: int = 0) -> None:
        """Replaces a material by a model; a shell keeps its tile and softness.

        A committed scene stays committed unless the shells differ in height. No job may run on it."""
        self._lib.vlr_scene_set_model_material(self.pointer, material, model.pointer, neighbors)

    def replace_material(self, material: int) -> None:
        """Moves the last material into slot `material` (swap and pop)."""
        self._lib.vlr_scene_replace_material(self.pointer, material)

    def set_gain(self, material: int, gain: tuple[float, float, float]) -> None:
        """Sets the factor on the material's reflected light, in the working space; at least 0."""
        self._lib.vlr_scene_set_gain(self.pointer, material, (c_float * 3)(*gain))

    def hide_backs(self, material: int, hidden) -> None:
        """hidden: rays ("camera", "bounces", "transmission", "shadows") that pass through its back faces."""
        self._lib.vlr_scene_hide_backs(self.pointer, material, _hidden_from(hidden))

    def set_shell_softness(self, material: int, widths: float) -> None:
        """Sets the share of the tile's width over which a shell's edge fades out: 0 (hard) to below 1."""
        self._lib.vlr_scene_set_shell_softness(self.pointer, material, widths)

    def set_shell_tile(self, material: int, metres: float) -> None:
        """Sets the width of a tile of the material's shell (VOTF) in meters; 0: from texture coordinates."""
        self._lib.vlr_scene_set_shell_tile(self.pointer, material, metres)

    def set_drawn_to(self, material: int, drawn: bool) -> None:
        """Whether emissive surfaces of the material are light-sampled; the picture converges to the same."""
        self._lib.vlr_scene_set_drawn_to(self.pointer, material, drawn)

    def add_measurement_material(
        self, measurement: Measurement, proposal: Model | None = None, neighbors: int = 0
    ) -> int:
        """Reference mode: f of the raw data; `proposal` is sampled from (None: a coarse model made here)."""
        proposal_pointer = proposal.pointer if proposal else None
        return self._numbered(
            "vlr_scene_add_measurement_material", measurement.pointer, proposal_pointer, neighbors
        )

    def add_btf_material(self, btf: Btf, most_bytes: int = 0) -> int:
        """Reference mode: f of the BTF itself, read into at most `most_bytes` of memory (0: 4 GiB)."""
        return self._numbered("vlr_scene_add_btf_material", btf.pointer, most_bytes)

    def add_principled_material(self, **values) -> int:
        """base_color [3], metallic, roughness (GGX alpha is its square): 0..1; specular: 0..11.25, 0.5 is an
        index of refraction of 1.5.

        emission [3]: radiance; alpha: 0..1, coverage of the surface; rays pass through the rest. formula:
        layered (Blender since 4.0) or disney (before). lobe: whole (with multiple scattering), single, or
        separable (separable masking and shadowing: before Blender 3.5). specular_tint [3]: for dielectrics at
        normal incidence, not negative; for metals near 82 degrees, 0..1. coat: 0..1, weight of a dielectric
        layer on top (disney: of its clear coat); coat_roughness; only layered: coat_index (at least 1),
        coat_tint [3], coat_lobe: whole (Blender since 4.5) or single. transmission: 0..1, share of glass in
        what is not metal; index: its index of refraction; transmission_roughness: only disney. sheen: weight
        of fuzz; sheen_tint [3]; only layered: sheen_roughness.
        """
        return self.add_textured_material({}, **values)

    def texture(self, pixels: np.ndarray, **options) -> Texture:
        """A texture for the scene's materials, made by Texture.from_pixels()."""
        return Texture.from_pixels(pixels, **options)

    def add_textured_material(self, textures: dict[str, TextureSlot], **values) -> int:
        """Like add_principled_material(); textures override base_color, metallic, roughness, alpha."""
        desc, pictures = described(self._lib, textures, values)
        return self._numbered("vlr_scene_add_textured_material", byref(desc), byref(pictures))

    def add_shader_material(self, shader: Shader) -> int:
        """Uses the layers that the shader has now."""
        return self._numbered("vlr_scene_add_shader_material", shader.pointer)

    # ---- light

    def add_light(self, kind: str, color, light_to_world, hidden=(), **values) -> None:
        """`kind`: sun, point, rectangle, disk, spot; shines along its -z.

        color [3]: a sun's irradiance on a facing plane, W/m^2; the others' power, W. angle: a sun's angular
        diameter or the angle of a spot's cone, radians. size [2]: a point's or spot's radius, a rectangle's
        sides, a disk's diameters, meters. blend: share of a spot's cone over which it fades out. spread: the
        angle into which a rectangle or disk emits, radians. sphere: whether a point or spot is a sphere, or a
        disk facing each point it lights. cosine: whether a spot's light falls off with the cosine to its
        axis. cone_scale [2]: factors on the width of a spot's cone along its x and y. mirrored: whether
        clear glass shows it. hidden: rays ("bounces", "transmission") that it does not light.
        """
        values = {"type": choice("light", kind, table.LIGHTS), "color": color, **values}
        values["hidden_from"] = _hidden_from(hidden)
        desc = self._desc(structs.LightDesc, "vlr_light_desc_init", values)
        desc.light_to_world = affine("light_to_world", light_to_world)
        self._lib.vlr_scene_add_light(self.pointer, byref(desc))

    def clear_lights(self) -> None:
        self._lib.vlr_scene_clear_lights(self.pointer)

    def hide_world(self, hidden) -> None:
        """hidden: rays ("bounces", "transmission") that the world does not light."""
        self._lib.vlr_scene_hide_world(self.pointer, _hidden_from(hidden))

    def set_world_color(self, color) -> None:
        """Radiance [3] from every direction."""
        self._lib.vlr_scene_set_world_color(self.pointer, small("color", color, 3))

    def set_world_pixels(self, pixels: np.ndarray, strength: float = 1.0, world_to_image=None) -> None:
        """Equirectangular [height x width x channels] float32, row 0 at the top (+z); Blender's convention.

        `world_to_image` [3 x 3] rotates a world direction before the look-up.
        """
        pixels = checked("pixels", pixels, (None, None, None))
        height, width, channels = pixels.shape
        self._lib.vlr_scene_set_world_pixels(
            self.pointer, width, height, channels, pointer(pixels), strength, _rotation(world_to_image)
        )

    def set_world_file(
        self,
        path: str | os.PathLike,
        strength: float = 1.0,
        world_to_image=None,
        layer: str = "",
        as_stored: bool = False,
    ) -> None:
        """Like set_world_pixels, from an image file; `layer` and `as_stored` as in images.read_picture()."""
        self._lib.vlr_scene_load_world_picture(
            self.pointer,
            path_bytes(path),
            byref(picture_options(layer, as_stored)),
            strength,
            _rotation(world_to_image),
        )

    def set_world_program(self, program: Program, output: int, width: int, height: int) -> None:
        """Like set_world_pixels, of a program's output by direction (vlr_scene_set_world_program)."""
        self._lib.vlr_scene_set_world_program(self.pointer, program.pointer, output, width, height)

    def place_world(self, strength: float, world_to_image=None) -> None:
        """Changes the strength and the rotation of the current world picture."""
        self._lib.vlr_scene_place_world(self.pointer, strength, _rotation(world_to_image))

    # ---- camera

    def set_camera(
        self, kind: str, camera_to_world, window, shutter=None, motion=None, motion_window=None, **values
    ) -> None:
        """`kind`: perspective, orthographic; looks along its -z, +y up.

        window: left, right, bottom, top of the picture at distance 1 (perspective) or in meters
        (orthographic). clip_start, clip_end in meters. aperture: radius of the lens, focus: focus distance,
        meters; blades, blade_rotation (radians), aperture_ratio (height over width): shape of the aperture.

        shutter, float32 [n]: how far it is open, at even times; None: nothing blurs. motion [steps x 3 x 4]
        and motion_window [steps x 4], float32: in place of camera_to_world and window, if they change.
        """
        values = {"type": choice("camera", kind, table.CAMERAS), "window": window, **values}
        desc = self._desc(structs.CameraDesc, "vlr_camera_desc_init", values)
        desc.camera_to_world = affine("camera_to_world", camera_to_world)
        if shutter is not None:
            desc.shutter = address(checked("shutter", shutter, (None,)))
            desc.shutter_count = len(shutter)
        keys = [len(each) for each in (motion, motion_window) if each is not None]
        desc.steps = max(keys, default=0)
        for name, array, rest in (("motion", motion, (3, 4)), ("motion_window", motion_window, (4,))):
            if array is not None:
                setattr(desc, name, address(checked(name, array, (desc.steps, *rest))))
        self._lib.vlr_scene_set_camera(self.pointer, byref(desc))

    def look_at(self, eye, target, fov: float, aspect: float) -> None:
        """Perspective, from `eye` to `target`, +z up. `fov`: vertical, radians; `aspect`: width / height."""
        self._lib.vlr_scene_look_at(
            self.pointer, small("eye", eye, 3), small("target", target, 3), fov, aspect
        )

    def frame_camera(self, aspect: float, up_axis: int = 2) -> None:
        """Frames the bounding box of all instances to the picture's height. `up_axis` 1 (y) or 2 (z)."""
        if up_axis not in (1, 2):
            raise refuse(f"up_axis is {up_axis}; it must be 1 (y) or 2 (z).")
        self._lib.vlr_scene_frame_camera(self.pointer, aspect, up_axis)

    # ---- end

    def stay(self) -> None:
        """Call before commit() if no geometry will change after it: makes rays faster."""
        self._lib.vlr_scene_stay(self.pointer)

    def commit(self) -> None:
        """Builds the acceleration structure; needed before a render job is made, after every change."""
        self._lib.vlr_scene_commit(self.pointer)

    def info(self) -> dict:
        """From vlr_scene_info_json: triangles, instances, lights, camera_inside, bytes, warnings and more."""
        return library.json_of(self._lib.vlr_scene_info_json, self.pointer)

    def _numbered(self, function_name: str, *arguments) -> int:
        number = c_uint32()
        getattr(self._lib, function_name)(self.pointer, *arguments, byref(number))
        return number.value

    def _desc(self, struct_type, init_name: str, values: dict):
        desc = struct_type()
        getattr(self._lib, init_name)(byref(desc))
        set_fields(desc, {n: small(n, v, _COLORS[n]) if n in _COLORS else v for n, v in values.items()})
        return desc


def _hidden_from(rays) -> int:
    return sum(table.HIDDEN[name] for name in set(rays))


def _rotation(matrix):
    return None if matrix is None else small("world_to_image", matrix, 9)
