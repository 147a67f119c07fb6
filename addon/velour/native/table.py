"""The C header as ctypes: names of choices, and the result and argument types of every function.

native/include/velour/velour.h is authoritative; a test compares names, argument counts, sizes and offsets.
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

from . import structs
from .errors import VelourError

JOB_STATES = ("ready", "running", "done", "failed", "cancelled")
KERNELS = ("gaussian", "abel-poisson")
MODELS = ("scattered", "parametric", "auto")
COMPRESS_METHODS = ("svd", "srbf", "tucker", "cta", "kcta", "svd-view")  # in the order of the C enum
COMPANDINGS = ("none", "root")
BTF_VALUES = ("automatic", "brdf", "reflectance", "radiance")
BTF_COLORS = ("rec709", "xyz")
BTF_ANGLES = ("automatic", "degrees", "radians")
PEERS = ("ggx", "principled", "plain_principled")
MASKINGS = ("separable", "correlated")
PLOTS = ("lobes", "order", "view-error", "albedo", "outline")
LIGHTS = ("sun", "point", "rectangle", "disk", "spot")
# VLR_HIDDEN_FROM_*, VLR_HOLDOUT
HIDDEN = {"camera": 1, "bounces": 2, "shadows": 4, "holdout": 8, "transmission": 16}
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
    "halves": 2048,
    "vector": 4096,
}
CAMERAS = ("perspective", "orthographic")
HEURISTICS = ("balance", "power")
SIDES = ("automatic", "one", "two")
SEQUENCES = ("random", "sobol", "independent")
WRAPS = ("repeat", "extend", "clip", "mirror")
FILTERS = ("closest", "linear")
PARAMETERS = (
    "specular",
    "coat",
    "coat_roughness",
    "coat_index",
    "transmission",
    "transmission_roughness",
    "index",
    "sheen",
    "sheen_roughness",
    "specular_tint",
    "coat_tint",
    "sheen_tint",
)
LAYERS = (
    "principled",
    "diffuse",
    "glossy",
    "transparent",
    "emission",
    "glass",
    "refraction",
    "translucent",
)
GLASS_FRESNELS = ("facets", "surface")
FORMULAS = ("layered", "disney")
LOBES = ("whole", "single", "separable")
FACTORS = ("share", "rest", "gain", "tint", "level")
RELIEF_CORRECTIONS = ("turned", "faded", "shadowed", "as-it-is")
OPERATIONS = (
    "source",
    "image",
    "math",
    "vector_math",
    "mix_color",
    "mix_vector",
    "combine",
    "separate",
    "ramp",
    "curves",
    "hue_saturation",
    "invert",
    "gamma",
    "bright_contrast",
    "clamp",
    "map_range",
    "mapping",
    "transform",
    "fresnel",
    "layer_weight",
    "noise",
    "voronoi",
    "wave",
    "gradient",
    "checker",
    "brick",
    "magic",
    "white_noise",
    "normal_map",
    "bump",
    "mix_number",
    "map_range_vector",
)
SOURCES = (
    "uv",
    "corner",
    "position",
    "object_position",
    "normal",
    "object_normal",
    "geometric_normal",
    "incoming",
    "backfacing",
    "map_tangent",
    "map_bitangent",
    "map_normal",
    "step_x",
    "step_y",
    "camera_ray",
    "shadow_ray",
)
SHIFTS = ("none", "x", "y")
WORLD_RAYS = ("others", "camera", "shadow")
MATH = (
    "add",
    "subtract",
    "multiply",
    "divide",
    "multiply_add",
    "power",
    "logarithm",
    "sqrt",
    "inverse_sqrt",
    "absolute",
    "exponent",
    "minimum",
    "maximum",
    "less_than",
    "greater_than",
    "sign",
    "compare",
    "smooth_min",
    "smooth_max",
    "round",
    "floor",
    "ceil",
    "trunc",
    "fract",
    "modulo",
    "floored_modulo",
    "wrap",
    "snap",
    "pingpong",
    "sine",
    "cosine",
    "tangent",
    "arcsine",
    "arccosine",
    "arctangent",
    "arctan2",
    "sinh",
    "cosh",
    "tanh",
    "radians",
    "degrees",
)
VECTOR_MATH = (
    "add",
    "subtract",
    "multiply",
    "divide",
    "multiply_add",
    "cross_product",
    "project",
    "reflect",
    "refract",
    "faceforward",
    "dot_product",
    "distance",
    "length",
    "scale",
    "normalize",
    "absolute",
    "minimum",
    "maximum",
    "floor",
    "ceil",
    "fraction",
    "modulo",
    "wrap",
    "snap",
    "sine",
    "cosine",
    "tangent",
    "power",
    "sign",
    "round",
)
BLENDS = (
    "mix",
    "darken",
    "multiply",
    "burn",
    "lighten",
    "screen",
    "dodge",
    "add",
    "overlay",
    "soft_light",
    "linear_light",
    "difference",
    "exclusion",
    "subtract",
    "divide",
    "hue",
    "saturation",
    "color",
    "value",
)
COLOR_MODELS = ("rgb", "hsv", "hsl")
RANGES = ("linear", "stepped", "smoothstep", "smootherstep")
MAPPINGS = ("point", "texture", "vector", "normal")
NOISES = ("fbm", "multifractal", "hybrid_multifractal", "ridged_multifractal", "hetero_terrain")
VORONOI_FEATURES = ("f1", "f2", "smooth_f1", "distance_to_edge", "n_sphere_radius")
METRICS = ("euclidean", "manhattan", "chebychev", "minkowski")
WAVE_AXES = ("x", "y", "z", "whole")
WAVE_PROFILES = ("sin", "saw", "tri")
GRADIENTS = ("linear", "quadratic", "easing", "diagonal", "spherical", "quadratic_sphere", "radial")
VALUES = ("color", "number", "normal")
STRATEGIES = (
    *("uniform", "cosine", "table", "srbf", "light", "mis", "ggx", "mis-ggx", "product"),
    *("dissertation", "mis-dissertation", "auto"),
)
MOST_SPLIT = 48  # maximum of vlr_render_options.split

_handle = c_void_p
_out_handle = POINTER(c_void_p)
_json = POINTER(c_char_p)
_floats = POINTER(c_float)
_number = POINTER(c_uint32)
ProgressFunction = ctypes.CFUNCTYPE(c_int32, c_void_p, c_double, c_char_p)

# Calls that return vlr_status: argument types.
STATUS_CALLS = {
    "vlr_self_test": [],
    "vlr_denoiser_json": [_json],
    "vlr_set_denoiser_file": [c_char_p],
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
    "vlr_model_closures_json": [_handle, POINTER(structs.ClosureOptions), _json],
    "vlr_file_info_json": [c_char_p, _json],
    "vlr_btf_load": [c_char_p, POINTER(structs.BtfOptions), _out_handle],
    "vlr_btf_info_json": [_handle, _json],
    "vlr_btf_angles": [_handle, POINTER(c_double), c_uint64],
    "vlr_btf_read": [_handle, c_uint64, c_uint64, POINTER(c_uint16), c_uint64],
    "vlr_btf_export_create_job": [_handle, c_char_p, _out_handle],
    "vlr_compress_create_job": [_handle, POINTER(structs.CompressOptions), _out_handle],
    "vlr_compress_size": [_handle, POINTER(structs.CompressOptions), *3 * [POINTER(c_uint64)]],
    "vlr_btf_compare_create_job": [_handle, _handle, _out_handle],
    "vlr_btf_compare_btf_create_job": [_handle, _handle, _out_handle],
    "vlr_job_start": [_handle],
    "vlr_job_poll": [_handle, POINTER(structs.JobStateStruct)],
    "vlr_job_cancel": [_handle],
    "vlr_job_wait": [_handle, c_double, ProgressFunction, c_void_p, POINTER(c_int32)],
    "vlr_job_report_json": [_handle, _json],
    "vlr_job_result_model": [_handle, _out_handle],
    "vlr_job_result_measurement": [_handle, _out_handle],
    "vlr_fit_create_job": [_handle, POINTER(structs.FitOptions), _out_handle],
    "vlr_compare_create_job": [_handle, _handle, _out_handle],
    "vlr_compare_peer_create_job": [_handle, c_int32, _out_handle],
    "vlr_model_roughened": [_handle, c_float, _out_handle],
    "vlr_model_peer_create_job": [_handle, c_int32, _out_handle],
    "vlr_microsurface_create_job": [POINTER(structs.MicrosurfaceOptions), c_char_p, _out_handle],
    "vlr_directions": [c_char_p, POINTER(c_double), POINTER(c_uint64)],
    "vlr_capture_create_job": [_handle, POINTER(structs.CaptureOptions), c_char_p, _out_handle],
    "vlr_votf_create_job": [_handle, _handle, POINTER(structs.VotfOptions), _out_handle],
    "vlr_votf_data_create_job": [_handle, _handle, POINTER(structs.VotfOptions), _out_handle],
    "vlr_scene_create": [_out_handle],
    "vlr_scene_set_working_space": [_handle, _floats],
    "vlr_scene_add_mesh": [_handle, POINTER(structs.MeshDesc), _number, _number],
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
    "vlr_scene_add_principled_material": [_handle, POINTER(structs.PrincipledDesc), _number],
    "vlr_texture_create": [
        c_uint32,
        c_uint32,
        c_uint32,
        _floats,
        POINTER(structs.TextureOptions),
        _out_handle,
    ],
    "vlr_texture_of_corners": [c_uint32, _out_handle],
    "vlr_texture_load": [c_char_p, POINTER(structs.TextureOptions), _out_handle],
    "vlr_program_create": [POINTER(structs.ProgramDesc), _out_handle],
    "vlr_texture_of_program": [_handle, c_uint32, _out_handle],
    "vlr_shader_create": [_out_handle],
    "vlr_shader_add_layer": [_handle, POINTER(structs.LayerDesc)],
    "vlr_shader_add_measured_layer": [_handle, POINTER(structs.MeasuredLayerDesc)],
    "vlr_shader_weigh_layer": [_handle, POINTER(structs.FactorDesc)],
    "vlr_scene_add_shader_material": [_handle, _handle, _number],
    "vlr_scene_add_textured_material": [
        _handle,
        POINTER(structs.PrincipledDesc),
        POINTER(structs.PrincipledTextures),
        _number,
    ],
    "vlr_scene_add_instance": [_handle, c_uint32, _floats, _number, c_uint32],
    "vlr_scene_add_placed_instance": [_handle, c_uint32, _floats, _number, _floats, c_uint32],
    "vlr_scene_add_instances": [_handle, c_void_p, c_void_p, c_uint64, _number, c_uint32],
    "vlr_scene_clear_instances": [_handle],
    "vlr_scene_soften_terminator": [_handle, c_float],
    "vlr_scene_hide_instances": [_handle, c_uint32],
    "vlr_scene_add_light": [_handle, POINTER(structs.LightDesc)],
    "vlr_scene_clear_lights": [_handle],
    "vlr_scene_hide_world": [_handle, c_uint32],
    "vlr_scene_set_world_color": [_handle, _floats],
    "vlr_scene_set_world_pixels": [_handle, c_uint32, c_uint32, c_uint32, _floats, c_float, _floats],
    "vlr_program_radiance": [_handle, c_uint32, c_int32, c_uint32, _floats, _floats],
    "vlr_scene_set_world_program": [_handle, _handle, c_uint32, c_uint32, c_uint32],
    "vlr_scene_load_world": [_handle, c_char_p, c_float, _floats],
    "vlr_scene_load_world_picture": [
        _handle,
        c_char_p,
        POINTER(structs.PictureOptions),
        c_float,
        _floats,
    ],
    "vlr_scene_place_world": [_handle, c_float, _floats],
    "vlr_scene_move_instances": [_handle, c_uint32],
    "vlr_scene_set_camera": [_handle, POINTER(structs.CameraDesc)],
    "vlr_scene_look_at": [_handle, _floats, _floats, c_float, c_float],
    "vlr_scene_frame_camera": [_handle, c_float, c_uint32],
    "vlr_scene_commit": [_handle],
    "vlr_scene_stay": [_handle],
    "vlr_scene_info_json": [_handle, _json],
    "vlr_tile_kinds_json": [_json],
    "vlr_tile_create": [POINTER(structs.TileOptions), _out_handle],
    "vlr_tile_desc": [_handle, POINTER(structs.MeshDesc)],
    "vlr_tile_material": [_handle, c_uint32, POINTER(structs.PrincipledDesc)],
    "vlr_tile_info_json": [_handle, _json],
    "vlr_cryptomatte_id": [c_char_p, _number, POINTER(c_float)],
    "vlr_render_create_job": [_handle, POINTER(structs.RenderOptions), _out_handle],
    "vlr_denoise_create_job": [_handle, c_uint32, _out_handle],
    "vlr_progressive_create_job": [_handle, POINTER(structs.RenderOptions), _out_handle],
    "vlr_progressive_restart": [_handle],
    "vlr_progressive_read": [_handle, _floats, c_uint64, POINTER(structs.ProgressivePicture)],
    "vlr_job_read_pass": [_handle, c_char_p, _floats, c_uint64],
    "vlr_job_read_sums": [_handle, _floats, c_uint64, POINTER(c_uint32)],
    "vlr_job_add_sums": [_handle, _floats, c_uint64],
    "vlr_job_stop": [_handle],
    "vlr_observation_create": [_out_handle],
    "vlr_observation_load": [c_char_p, _out_handle],
    "vlr_observation_save": [_handle, c_char_p],
    "vlr_observation_merge": [_handle, _handle],
    "vlr_observation_info_json": [_handle, _json],
    "vlr_observe_create_job": [_handle, c_uint32, POINTER(structs.ObserveOptions), _out_handle],
    "vlr_job_result_observation": [_handle, _out_handle],
    "vlr_light_map_create_job": [_handle, c_char_p, c_uint32, _out_handle],
    "vlr_lobe_rows_create_job": [_handle, c_uint32, _out_handle],
    "vlr_principled_rows_create_job": [POINTER(structs.PrincipledDesc), c_uint32, _out_handle],
    "vlr_btf_maps_create_job": [_handle, _out_handle],
    "vlr_shell_maps_create_job": [_handle, _out_handle],
    "vlr_job_result_table": [_handle, POINTER(_floats), _number, _number],
    "vlr_plot_create": [_handle, _handle, c_int32, c_double, c_double, _out_handle],
    "vlr_plot_create_job": [_handle, _handle, c_int32, c_double, c_double, _out_handle],
    "vlr_job_result_plot": [_handle, _out_handle],
    "vlr_plot_json": [_handle, _json],
    "vlr_plot_draw": [_handle, POINTER(structs.PlotStyle), _floats, c_uint64],
    "vlr_plot_save": [_handle, POINTER(structs.PlotStyle), c_char_p],
    "vlr_text_draw": [c_char_p, c_float, POINTER(c_uint32), POINTER(c_uint32), _floats, c_uint64],
    "vlr_image_write": [c_char_p, c_uint32, c_uint32, c_uint32, _floats],
    "vlr_image_read": [c_char_p, _number, _number, _number, _floats, c_uint64],
    "vlr_image_write_part": [
        c_char_p,
        c_uint32,
        c_uint32,
        c_uint32,
        _floats,
        POINTER(structs.ImageFrame),
        POINTER(c_char_p),
        c_uint32,
    ],
    "vlr_image_header_json": [c_char_p, _json],
    "vlr_picture_read": [
        c_char_p,
        POINTER(structs.PictureOptions),
        _number,
        _number,
        _number,
        _floats,
        c_uint64,
    ],
    "vlr_picture_notes_json": [c_char_p, POINTER(structs.PictureOptions), _json],
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
    "vlr_program_free": (None, [_handle]),
    "vlr_shader_free": (None, [_handle]),
    "vlr_texture_free": (None, [_handle]),
    "vlr_observation_free": (None, [_handle]),
    "vlr_tile_free": (None, [_handle]),
    "vlr_plot_free": (None, [_handle]),
    "vlr_btf_options_init": (None, [POINTER(structs.BtfOptions)]),
    "vlr_compress_options_init": (None, [POINTER(structs.CompressOptions)]),
    "vlr_fit_options_init": (None, [POINTER(structs.FitOptions)]),
    "vlr_closure_options_init": (None, [POINTER(structs.ClosureOptions)]),
    "vlr_microsurface_options_init": (None, [POINTER(structs.MicrosurfaceOptions)]),
    "vlr_capture_options_init": (None, [POINTER(structs.CaptureOptions)]),
    "vlr_votf_options_init": (None, [POINTER(structs.VotfOptions)]),
    "vlr_tile_options_init": (None, [POINTER(structs.TileOptions)]),
    "vlr_principled_desc_init": (None, [POINTER(structs.PrincipledDesc)]),
    "vlr_picture_options_init": (None, [POINTER(structs.PictureOptions)]),
    "vlr_program_desc_init": (None, [POINTER(structs.ProgramDesc)]),
    "vlr_texture_options_init": (None, [POINTER(structs.TextureOptions)]),
    "vlr_principled_textures_init": (None, [POINTER(structs.PrincipledTextures)]),
    "vlr_layer_desc_init": (None, [POINTER(structs.LayerDesc)]),
    "vlr_factor_desc_init": (None, [POINTER(structs.FactorDesc)]),
    "vlr_measured_layer_desc_init": (None, [POINTER(structs.MeasuredLayerDesc)]),
    "vlr_light_desc_init": (None, [POINTER(structs.LightDesc)]),
    "vlr_camera_desc_init": (None, [POINTER(structs.CameraDesc)]),
    "vlr_pass_options_init": (None, [POINTER(structs.PassOptions)]),
    "vlr_render_options_init": (None, [POINTER(structs.RenderOptions)]),
    "vlr_observe_options_init": (None, [POINTER(structs.ObserveOptions)]),
    "vlr_plot_style_init": (None, [POINTER(structs.PlotStyle)]),
}


def bind(library: ctypes.CDLL) -> None:
    """Sets the types of every function of `library`. AttributeError names the first one that is missing."""

    def check(status, function, _arguments):
        if status:
            text = library.vlr_last_error()
            sentence = (
                text.decode("utf-8", "replace") if text else f"{function.__name__} failed without a message."
            )
            raise VelourError(status, sentence)
        return status

    for name, (result, arguments) in PLAIN_CALLS.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    for name, arguments in STATUS_CALLS.items():
        function = getattr(library, name)
        function.restype, function.argtypes, function.errcheck = c_int32, arguments, check
