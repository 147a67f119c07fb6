"""The C header as ctypes: structs, and the result and argument types of every function.

native/include/velour/velour.h is the law; a test compares names, argument counts, sizes and offsets.
"""

from __future__ import annotations

import ctypes
from ctypes import (
    POINTER,
    c_char_p,
    c_double,
    c_float,
    c_int32,
    c_uint8,
    c_uint16,
    c_uint32,
    c_uint64,
    c_void_p,
)

from .errors import VelourError

JOB_STATES = ("ready", "running", "done", "failed", "cancelled")
KERNELS = ("gaussian", "abel-poisson")
MODELS = ("scattered", "parametric")
COMPRESS_METHODS = ("svd", "srbf", "tucker", "cta", "kcta", "svd-view")  # by number
COMPANDINGS = ("none", "root")  # by number
BTF_VALUES = ("automatic", "brdf", "reflectance", "radiance")
BTF_COLORS = ("rec709", "xyz")
PEERS = ("ggx", "principled", "plain_principled")
PLOTS = ("lobes", "order", "view-error", "albedo", "outline")
LIGHTS = ("sun", "point", "rectangle", "disk", "spot")
HIDDEN = {"camera": 1, "bounces": 2, "shadows": 4, "holdout": 8}  # VLR_HIDDEN_FROM_*, VLR_HOLDOUT
PASSES = {  # VLR_PASS_*
    "position": 1,
    "uv": 2,
    "object_index": 4,
    "material_index": 8,
    "mist": 16,
    "albedo": 32,
    "error": 64,
    "crypto_object": 128,
    "crypto_material": 256,
    "crypto_asset": 512,
    "denoising_albedo": 1024,
}
CAMERAS = ("perspective", "orthographic")
HEURISTICS = ("balance", "power")
SIDES = ("automatic", "one", "two")
SEQUENCES = ("random", "sobol")
WRAPS = ("repeat", "extend", "clip", "mirror")
FILTERS = ("closest", "linear")
LAYERS = ("principled", "diffuse", "glossy", "transparent", "emission")
FACTORS = ("share", "rest", "gain")
RELIEF_CORRECTIONS = ("turned", "faded", "shadowed", "as-it-is")
STRATEGIES = ("uniform", "cosine", "table", "srbf", "light", "mis", "ggx", "mis-ggx", "product")


class Struct(ctypes.Structure):
    """A struct that begins with its own size."""

    def __init__(self, **values):
        super().__init__(struct_size=ctypes.sizeof(type(self)), **values)


class JobStateStruct(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("state", c_int32),
        ("fraction", c_double),
        ("seconds", c_double),
        ("seconds_left", c_double),
        ("bytes_in_use", c_uint64),
        ("stage", c_char_p),
    ]


class FitOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("kernel", c_int32),
        ("tolerance", c_double),
        ("max_lobes", c_uint32),
        ("threads", c_uint32),
        ("max_bytes", c_uint64),
        ("seed", c_uint64),
        ("all_data", c_int32),
        ("align_views", c_int32),
        ("model", c_int32),
        ("limit_albedo", c_int32),
        ("symmetric", c_int32),
        ("pad", c_int32),
        ("for_scene", c_void_p),
        ("full_model", c_void_p),
    ]


class BtfOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("values", c_int32),
        ("colors", c_int32),
        ("gamma", c_float),
        ("tile_metres", c_float * 2),
    ]


class CompressOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("method", c_int32),
        ("companding", c_int32),
        ("threads", c_uint32),
        ("bytes", c_uint64),
        ("seed", c_uint64),
        ("held_out", c_void_p),
        ("for_scene", c_void_p),
        ("full_model", c_void_p),
        ("tolerance", c_double),
        ("memory", c_uint64),
        ("checkpoint", c_char_p),
        ("resume", c_int32),
        ("clusters", c_uint32),
        ("members", c_uint32),
        ("no_relief", c_int32),
    ]


class MicrosurfaceOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("threads", c_uint32),
        ("roughness", c_double),
        ("anisotropy", c_double),
        ("metal", c_char_p),
        ("base_albedo", c_float * 3),
        ("base_share", c_double),
        ("ior", c_double),
        ("flake_roughness", c_double),
        ("rays", c_uint64),
        ("seed", c_uint64),
    ]


class CaptureOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("texels", c_uint32 * 2),
        ("samples", c_uint32),
        ("bounces", c_uint32),
        ("sides", c_int32),
        ("threads", c_uint32),
        ("resume", c_int32),
        ("seed", c_uint64),
        ("views", POINTER(c_double)),
        ("lights", POINTER(c_double)),
        ("view_count", c_uint64),
        ("light_count", c_uint64),
        ("origin", c_double * 2),
        ("period", c_double * 2),
        ("metres_per_unit", c_double),
        ("reference_height", c_double),
        ("memory_limit", c_uint64),
        ("source", c_char_p),
        ("measure_ray_share", c_int32),
        ("held_out", c_uint32),
    ]


class VotfOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("texels", c_uint32),
        ("threads", c_uint32),
        ("check_views", c_uint32),
        ("seed", c_uint64),
        ("origin", c_double * 2),
        ("period", c_double * 2),
        ("metres_per_unit", c_double),
        ("surface", c_double),
        ("reference_height", c_double),
        ("source", c_char_p),
    ]


class MeshDesc(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("vertex_count", c_uint32),
        ("triangle_count", c_uint32),
        ("color_sets", c_uint32),
        ("positions", c_void_p),
        ("triangles", c_void_p),
        ("corner_normals", c_void_p),
        ("corner_uvs", c_void_p),
        ("material_slots", c_void_p),
        ("smooth", c_void_p),
        ("more_uvs", c_void_p),
        ("relief_uvs", c_void_p),
        ("more_uv_sets", c_uint32),
        ("corner_count", c_uint32),
        ("corner_vertices", c_void_p),
        ("vertex_normals", c_void_p),
        ("corner_colors", c_void_p),
    ]


class TileOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("count", c_uint32),
        ("kind", c_char_p),
        ("size", c_double),
        ("thickness", c_double),
        ("gap", c_double),
        ("irregularity", c_double),
        ("resolution", c_uint32),
        ("pad", c_uint32),
        ("seed", c_uint64),
    ]


class PrincipledDesc(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("base_color", c_float * 3),
        ("metallic", c_float),
        ("roughness", c_float),
        ("specular", c_float),
        ("emission", c_float * 3),
        ("alpha", c_float),
    ]


class TextureOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("wrap", c_int32),
        ("filter", c_int32),
        ("channel", c_int32),
        ("raw", c_int32),
    ]


class PrincipledTextures(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("pad", c_uint32),
        ("base_color", c_void_p),
        ("metallic", c_void_p),
        ("roughness", c_void_p),
        ("alpha", c_void_p),
        ("base_color_map", c_float * 6),
        ("metallic_map", c_float * 6),
        ("roughness_map", c_float * 6),
        ("alpha_map", c_float * 6),
        ("base_color_set", c_uint32),
        ("metallic_set", c_uint32),
        ("roughness_set", c_uint32),
        ("alpha_set", c_uint32),
    ]


class LayerDesc(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("surface", POINTER(PrincipledDesc)),
        ("textures", POINTER(PrincipledTextures)),
        ("normal", c_void_p),
        ("normal_map", c_float * 6),
        ("normal_strength", c_float),
        ("normal_set", c_uint32),
        ("normal_correction", c_int32),
        ("interreflection", c_int32),
    ]


class FactorDesc(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("value", c_float),
        ("set", c_uint32),
        ("texture", c_void_p),
        ("map", c_float * 6),
    ]


class LightDesc(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("type", c_int32),
        ("color", c_float * 3),
        ("light_to_world", c_float * 12),
        ("size", c_float * 2),
        ("angle", c_float),
        ("casts_shadow", c_int32),
        ("blend", c_float),
        ("spread", c_float),
        ("sphere", c_int32),
        ("cosine", c_int32),
        ("cone_scale", c_float * 2),
    ]


class CameraDesc(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("type", c_int32),
        ("camera_to_world", c_float * 12),
        ("window", c_float * 4),
        ("clip_start", c_float),
        ("clip_end", c_float),
        ("aperture", c_float),
        ("focus", c_float),
        ("blades", c_uint32),
        ("blade_rotation", c_float),
        ("aperture_ratio", c_float),
    ]


class PassOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("asked", c_uint32),
        ("cryptomatte_ranks", c_uint32),
        ("mist_start", c_float),
        ("mist_depth", c_float),
        ("mist_exponent", c_float),
        ("instances", c_void_p),
        ("instance_count", c_uint64),
        ("materials", c_void_p),
        ("material_count", c_uint64),
    ]


class InstanceLabel(ctypes.Structure):
    _fields_ = [
        ("index", c_float),
        ("object_id", c_float),
        ("asset_id", c_float),
        ("uv_set", c_int32),
    ]


class MaterialLabel(ctypes.Structure):
    _fields_ = [
        ("index", c_float),
        ("id", c_float),
    ]


class RenderOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("spp", c_uint32),
        ("split", c_uint32),
        ("bounces", c_uint32),
        ("strategy", c_int32),
        ("threads", c_uint32),
        ("seed", c_uint64),
        ("time_limit", c_double),
        ("transparent", c_int32),
        ("measure_ray_share", c_int32),
        ("heuristic", c_int32),
        ("sequence", c_int32),
        ("share", c_double),
        ("noise", c_double),
        ("cache_folder", c_char_p),
        ("hide_world", c_int32),
        ("samples_begin", c_uint32),
        ("samples_end", c_uint32),
        ("crop_x0", c_uint32),
        ("crop_y0", c_uint32),
        ("crop_x1", c_uint32),
        ("crop_y1", c_uint32),
        ("pad", c_uint32),
        ("passes", POINTER(PassOptions)),
    ]


class PlotStyle(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("side", c_uint32),
        ("text", c_float),
        ("background", c_float * 3),
        ("foreground", c_float * 3),
        ("model", c_float * 3),
        ("measured", c_float * 3),
        ("red", c_float * 3),
        ("green", c_float * 3),
        ("blue", c_float * 3),
    ]


class ProgressivePicture(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("samples", c_uint32),
        ("version", c_uint64),
    ]


class ObserveOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("bounces", c_uint32),
        ("threads", c_uint32),
        ("pad", c_uint32),
        ("seed", c_uint64),
    ]


class ImageFrame(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("x", c_int32),
        ("y", c_int32),
    ]


STRUCTS = {
    "vlr_job_state": JobStateStruct,
    "vlr_fit_options": FitOptions,
    "vlr_btf_options": BtfOptions,
    "vlr_compress_options": CompressOptions,
    "vlr_microsurface_options": MicrosurfaceOptions,
    "vlr_capture_options": CaptureOptions,
    "vlr_votf_options": VotfOptions,
    "vlr_mesh_desc": MeshDesc,
    "vlr_principled_desc": PrincipledDesc,
    "vlr_tile_options": TileOptions,
    "vlr_texture_options": TextureOptions,
    "vlr_principled_textures": PrincipledTextures,
    "vlr_layer_desc": LayerDesc,
    "vlr_factor_desc": FactorDesc,
    "vlr_light_desc": LightDesc,
    "vlr_camera_desc": CameraDesc,
    "vlr_instance_label": InstanceLabel,
    "vlr_material_label": MaterialLabel,
    "vlr_pass_options": PassOptions,
    "vlr_render_options": RenderOptions,
    "vlr_progressive_picture": ProgressivePicture,
    "vlr_observe_options": ObserveOptions,
    "vlr_plot_style": PlotStyle,
    "vlr_image_frame": ImageFrame,
}

_handle = c_void_p
_out_handle = POINTER(c_void_p)
_json = POINTER(c_char_p)
_floats = POINTER(c_float)
_number = POINTER(c_uint32)
ProgressFunction = ctypes.CFUNCTYPE(c_int32, c_void_p, c_double, c_char_p)

# Calls that return vlr_status: argument types.
STATUS_CALLS = {
    "vlr_self_test": [],
    "vlr_system_json": [_json],
    "vlr_select_simd": [c_char_p],
    "vlr_measurement_load": [c_char_p, _out_handle],
    "vlr_measurement_load_create_job": [c_char_p, _out_handle],
    "vlr_measurement_info_json": [_handle, _json],
    "vlr_measurement_eval": [_handle, _floats, c_uint64, _floats, _floats, POINTER(c_uint8)],
    "vlr_model_load": [c_char_p, _out_handle],
    "vlr_model_load_memory": [c_void_p, c_uint64, c_char_p, _out_handle],
    "vlr_model_save": [_handle, c_char_p],
    "vlr_model_bytes": [_handle, POINTER(c_void_p), POINTER(c_uint64)],
    "vlr_model_info_json": [_handle, _json],
    "vlr_model_eval": [_handle, _floats, c_uint64, _floats, _floats, _floats],
    "vlr_model_sample": [_handle, _floats, c_uint64, _floats, _floats, _floats],
    "vlr_model_out_of_domain": [_handle, _handle, POINTER(c_double)],
    "vlr_file_info_json": [c_char_p, _json],
    "vlr_btf_load": [c_char_p, POINTER(BtfOptions), _out_handle],
    "vlr_btf_info_json": [_handle, _json],
    "vlr_btf_angles": [_handle, POINTER(c_double), c_uint64],
    "vlr_btf_read": [_handle, c_uint64, c_uint64, POINTER(c_uint16), c_uint64],
    "vlr_btf_export_create_job": [_handle, c_char_p, _out_handle],
    "vlr_compress_create_job": [_handle, POINTER(CompressOptions), _out_handle],
    "vlr_compress_size": [_handle, POINTER(CompressOptions), *3 * [POINTER(c_uint64)]],
    "vlr_btf_compare_create_job": [_handle, _handle, _out_handle],
    "vlr_btf_compare_btf_create_job": [_handle, _handle, _out_handle],
    "vlr_job_start": [_handle],
    "vlr_job_poll": [_handle, POINTER(JobStateStruct)],
    "vlr_job_cancel": [_handle],
    "vlr_job_wait": [_handle, c_double, ProgressFunction, c_void_p, POINTER(c_int32)],
    "vlr_job_report_json": [_handle, _json],
    "vlr_job_result_model": [_handle, _out_handle],
    "vlr_job_result_measurement": [_handle, _out_handle],
    "vlr_fit_create_job": [_handle, POINTER(FitOptions), _out_handle],
    "vlr_compare_create_job": [_handle, _handle, _out_handle],
    "vlr_compare_peer_create_job": [_handle, c_int32, _out_handle],
    "vlr_model_roughened": [_handle, c_float, _out_handle],
    "vlr_model_peer_create_job": [_handle, c_int32, _out_handle],
    "vlr_microsurface_create_job": [POINTER(MicrosurfaceOptions), c_char_p, _out_handle],
    "vlr_directions": [c_char_p, POINTER(c_double), POINTER(c_uint64)],
    "vlr_capture_create_job": [_handle, POINTER(CaptureOptions), c_char_p, _out_handle],
    "vlr_votf_create_job": [_handle, _handle, POINTER(VotfOptions), _out_handle],
    "vlr_votf_data_create_job": [_handle, _handle, POINTER(VotfOptions), _out_handle],
    "vlr_scene_create": [_out_handle],
    "vlr_scene_set_working_space": [_handle, _floats],
    "vlr_scene_add_mesh": [_handle, POINTER(MeshDesc), _number, _number],
    "vlr_scene_remove_mesh": [_handle, c_uint32],
    "vlr_scene_add_meshes": [_handle, c_void_p, c_uint64, _number, c_void_p],
    "vlr_scene_load_mesh": [_handle, c_char_p, _number],
    "vlr_scene_add_model_material": [_handle, _handle, c_uint32, _number],
    "vlr_scene_set_shell_tile": [_handle, c_uint32, c_float],
    "vlr_scene_set_shell_softness": [_handle, c_uint32, c_float],
    "vlr_scene_hide_backs": [_handle, c_uint32, c_uint32],
    "vlr_scene_set_gain": [_handle, c_uint32, POINTER(c_float)],
    "vlr_scene_set_drawn_to": [_handle, c_uint32, c_int32],
    "vlr_scene_replace_material": [_handle, c_uint32],
    "vlr_scene_set_model_material": [_handle, c_uint32, _handle, c_uint32],
    "vlr_scene_add_measurement_material": [_handle, _handle, _handle, c_uint32, _number],
    "vlr_scene_add_btf_material": [_handle, _handle, c_uint64, _number],
    "vlr_scene_add_principled_material": [_handle, POINTER(PrincipledDesc), _number],
    "vlr_texture_create": [
        c_uint32,
        c_uint32,
        c_uint32,
        _floats,
        POINTER(TextureOptions),
        _out_handle,
    ],
    "vlr_texture_of_corners": [c_uint32, _out_handle],
    "vlr_texture_load": [c_char_p, POINTER(TextureOptions), _out_handle],
    "vlr_shader_create": [_out_handle],
    "vlr_shader_add_layer": [_handle, POINTER(LayerDesc)],
    "vlr_shader_weigh_layer": [_handle, POINTER(FactorDesc)],
    "vlr_scene_add_shader_material": [_handle, _handle, _number],
    "vlr_scene_add_textured_material": [
        _handle,
        POINTER(PrincipledDesc),
        POINTER(PrincipledTextures),
        _number,
    ],
    "vlr_scene_add_instance": [_handle, c_uint32, _floats, _number, c_uint32],
    "vlr_scene_add_placed_instance": [_handle, c_uint32, _floats, _number, _floats, c_uint32],
    "vlr_scene_add_instances": [_handle, c_void_p, c_void_p, c_uint64, _number, c_uint32],
    "vlr_scene_clear_instances": [_handle],
    "vlr_scene_hide_instances": [_handle, c_uint32],
    "vlr_scene_add_light": [_handle, POINTER(LightDesc)],
    "vlr_scene_clear_lights": [_handle],
    "vlr_scene_set_world_color": [_handle, _floats],
    "vlr_scene_set_world_pixels": [_handle, c_uint32, c_uint32, c_uint32, _floats, c_float, _floats],
    "vlr_scene_load_world": [_handle, c_char_p, c_float, _floats],
    "vlr_scene_place_world": [_handle, c_float, _floats],
    "vlr_scene_set_camera": [_handle, POINTER(CameraDesc)],
    "vlr_scene_look_at": [_handle, _floats, _floats, c_float, c_float],
    "vlr_scene_frame_camera": [_handle, c_float, c_uint32],
    "vlr_scene_commit": [_handle],
    "vlr_scene_info_json": [_handle, _json],
    "vlr_tile_kinds_json": [_json],
    "vlr_tile_create": [POINTER(TileOptions), _out_handle],
    "vlr_tile_desc": [_handle, POINTER(MeshDesc)],
    "vlr_tile_material": [_handle, c_uint32, POINTER(PrincipledDesc)],
    "vlr_tile_info_json": [_handle, _json],
    "vlr_cryptomatte_id": [c_char_p, _number, POINTER(c_float)],
    "vlr_render_create_job": [_handle, POINTER(RenderOptions), _out_handle],
    "vlr_progressive_create_job": [_handle, POINTER(RenderOptions), _out_handle],
    "vlr_progressive_restart": [_handle],
    "vlr_progressive_read": [_handle, _floats, c_uint64, POINTER(ProgressivePicture)],
    "vlr_job_read_pass": [_handle, c_char_p, _floats, c_uint64],
    "vlr_job_read_sums": [_handle, _floats, c_uint64, POINTER(c_uint32)],
    "vlr_job_add_sums": [_handle, _floats, c_uint64],
    "vlr_job_stop": [_handle],
    "vlr_observation_create": [_out_handle],
    "vlr_observation_load": [c_char_p, _out_handle],
    "vlr_observation_save": [_handle, c_char_p],
    "vlr_observation_merge": [_handle, _handle],
    "vlr_observation_info_json": [_handle, _json],
    "vlr_observe_create_job": [_handle, c_uint32, POINTER(ObserveOptions), _out_handle],
    "vlr_job_result_observation": [_handle, _out_handle],
    "vlr_light_map_create_job": [_handle, c_char_p, c_uint32, _out_handle],
    "vlr_lobe_rows_create_job": [_handle, c_uint32, _out_handle],
    "vlr_principled_rows_create_job": [POINTER(PrincipledDesc), c_uint32, _out_handle],
    "vlr_btf_maps_create_job": [_handle, _out_handle],
    "vlr_shell_maps_create_job": [_handle, _out_handle],
    "vlr_job_result_table": [_handle, POINTER(_floats), _number, _number],
    "vlr_plot_create": [_handle, _handle, c_int32, c_double, c_double, _out_handle],
    "vlr_plot_create_job": [_handle, _handle, c_int32, c_double, c_double, _out_handle],
    "vlr_job_result_plot": [_handle, _out_handle],
    "vlr_plot_json": [_handle, _json],
    "vlr_plot_draw": [_handle, POINTER(PlotStyle), _floats, c_uint64],
    "vlr_plot_save": [_handle, POINTER(PlotStyle), c_char_p],
    "vlr_image_write": [c_char_p, c_uint32, c_uint32, c_uint32, _floats],
    "vlr_image_read": [c_char_p, _number, _number, _number, _floats, c_uint64],
    "vlr_image_write_part": [
        c_char_p,
        c_uint32,
        c_uint32,
        c_uint32,
        _floats,
        POINTER(ImageFrame),
        POINTER(c_char_p),
        c_uint32,
    ],
    "vlr_image_header_json": [c_char_p, _json],
    "vlr_image_compare": [c_uint64, c_uint32, _floats, _floats, POINTER(c_double), POINTER(c_double)],
}

# Calls that cannot fail: result type and argument types.
PLAIN_CALLS = {
    "vlr_last_error": (c_char_p, []),
    "vlr_version": (c_uint32, []),
    "vlr_abi_version": (c_uint32, []),
    "vlr_measurement_free": (None, [_handle]),
    "vlr_btf_free": (None, [_handle]),
    "vlr_model_free": (None, [_handle]),
    "vlr_job_free": (None, [_handle]),
    "vlr_scene_free": (None, [_handle]),
    "vlr_shader_free": (None, [_handle]),
    "vlr_texture_free": (None, [_handle]),
    "vlr_observation_free": (None, [_handle]),
    "vlr_tile_free": (None, [_handle]),
    "vlr_plot_free": (None, [_handle]),
    "vlr_btf_options_init": (None, [POINTER(BtfOptions)]),
    "vlr_compress_options_init": (None, [POINTER(CompressOptions)]),
    "vlr_fit_options_init": (None, [POINTER(FitOptions)]),
    "vlr_microsurface_options_init": (None, [POINTER(MicrosurfaceOptions)]),
    "vlr_capture_options_init": (None, [POINTER(CaptureOptions)]),
    "vlr_votf_options_init": (None, [POINTER(VotfOptions)]),
    "vlr_tile_options_init": (None, [POINTER(TileOptions)]),
    "vlr_principled_desc_init": (None, [POINTER(PrincipledDesc)]),
    "vlr_texture_options_init": (None, [POINTER(TextureOptions)]),
    "vlr_principled_textures_init": (None, [POINTER(PrincipledTextures)]),
    "vlr_layer_desc_init": (None, [POINTER(LayerDesc)]),
    "vlr_factor_desc_init": (None, [POINTER(FactorDesc)]),
    "vlr_light_desc_init": (None, [POINTER(LightDesc)]),
    "vlr_camera_desc_init": (None, [POINTER(CameraDesc)]),
    "vlr_pass_options_init": (None, [POINTER(PassOptions)]),
    "vlr_render_options_init": (None, [POINTER(RenderOptions)]),
    "vlr_observe_options_init": (None, [POINTER(ObserveOptions)]),
    "vlr_plot_style_init": (None, [POINTER(PlotStyle)]),
}


def bind(library: ctypes.CDLL) -> None:
    """Gives every function of `library` its types; AttributeError names the first one that is not there."""

    def check(status, function, _arguments):
        if status:
            text = library.vlr_last_error()
            sentence = (
                text.decode("utf-8", "replace") if text else f"{function.__name__} failed without a word"
            )
            raise VelourError(status, sentence)
        return status

    for name, (result, arguments) in PLAIN_CALLS.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    for name, arguments in STATUS_CALLS.items():
        function = getattr(library, name)
        function.restype, function.argtypes, function.errcheck = c_int32, arguments, check
