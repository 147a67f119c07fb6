"""The structs of the C header as ctypes, field by field; table.py has the functions that take them."""

from __future__ import annotations

import ctypes
from ctypes import (
    POINTER,
    c_char_p,
    c_double,
    c_float,
    c_int32,
    c_uint32,
    c_uint64,
    c_void_p,
)


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


class ClosureOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("max_lobes", c_uint32),
        ("tolerance", c_double),
        ("masking", c_int32),
        ("threads", c_uint32),
    ]


class BtfOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("values", c_int32),
        ("colors", c_int32),
        ("gamma", c_float),
        ("tile_metres", c_float * 2),
        ("layer", c_char_p),
        ("angles", c_int32),
    ]


class PictureOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("as_stored", c_int32),
        ("layer", c_char_p),
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
        ("moved_positions", c_void_p),
        ("moved_corner_normals", c_void_p),
        ("moved_vertex_normals", c_void_p),
        ("steps", c_uint32),
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
        ("formula", c_int32),
        ("lobe", c_int32),
        ("specular_tint", c_float * 3),
        ("coat", c_float),
        ("coat_roughness", c_float),
        ("coat_index", c_float),
        ("coat_tint", c_float * 3),
        ("coat_lobe", c_int32),
        ("transmission", c_float),
        ("transmission_roughness", c_float),
        ("index", c_float),
        ("glass_fresnel", c_int32),
        ("sheen", c_float),
        ("sheen_roughness", c_float),
        ("sheen_tint", c_float * 3),
        ("specular_of_index", c_int32),
        ("surface_correction", c_int32),
    ]


class TextureOptions(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("wrap", c_int32),
        ("filter", c_int32),
        ("channel", c_int32),
        ("raw", c_int32),
        ("srgb", c_int32),
        ("premultiplied", c_int32),
        ("colors", c_float * 9),
    ]


class ParameterTexture(ctypes.Structure):
    _fields_ = [
        ("parameter", c_int32),
        ("set", c_uint32),
        ("texture", c_void_p),
        ("map", c_float * 6),
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
        ("more", POINTER(ParameterTexture)),
        ("more_count", c_uint32),
    ]


class Instruction(ctypes.Structure):
    _fields_ = [
        ("operation", c_int32),
        ("choice", c_int32 * 4),
        ("input", c_uint32 * 12),
        ("output", c_uint32),
        ("table", c_uint32),
        ("table_size", c_uint32),
    ]


class ProgramOutput(ctypes.Structure):
    _fields_ = [("first", c_uint32), ("kind", c_int32)]


class ProgramDesc(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("registers", c_uint32),
        ("constant_count", c_uint32),
        ("instruction_count", c_uint32),
        ("table_count", c_uint32),
        ("image_count", c_uint32),
        ("output_count", c_uint32),
        ("step", c_float),
        ("constants", c_void_p),
        ("instructions", c_void_p),
        ("tables", c_void_p),
        ("images", c_void_p),
        ("outputs", c_void_p),
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
        ("coat_normal", c_void_p),
        ("coat_normal_map", c_float * 6),
        ("coat_normal_strength", c_float),
        ("coat_normal_set", c_uint32),
    ]


class FactorDesc(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("value", c_float),
        ("set", c_uint32),
        ("texture", c_void_p),
        ("map", c_float * 6),
        ("color", c_float * 3),
        ("level", c_float * 3),
    ]


class MeasuredLayerDesc(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("neighbors", c_uint32),
        ("model", c_void_p),
        ("measurement", c_void_p),
        ("btf", c_void_p),
        ("most_bytes", c_uint64),
        ("map", c_float * 6),
        ("normal", c_void_p),
        ("normal_map", c_float * 6),
        ("normal_strength", c_float),
        ("normal_set", c_uint32),
        ("normal_correction", c_int32),
        ("aspect", c_float),
        ("rotation", c_void_p),
        ("scale", c_void_p),
        ("rotation_map", c_float * 6),
        ("scale_map", c_float * 6),
        ("rotation_set", c_uint32),
        ("scale_set", c_uint32),
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
        ("mirrored", c_int32),
        ("hidden_from", c_uint32),
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
        ("shutter", c_void_p),
        ("motion", c_void_p),
        ("motion_window", c_void_p),
        ("shutter_count", c_uint32),
        ("steps", c_uint32),
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
        ("clamp_direct", c_float),
        ("clamp_indirect", c_float),
        ("filter_glossy", c_float),
        ("reflective_caustics", c_int32),
        ("denoise", c_int32),
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
    "vlr_closure_options": ClosureOptions,
    "vlr_btf_options": BtfOptions,
    "vlr_compress_options": CompressOptions,
    "vlr_microsurface_options": MicrosurfaceOptions,
    "vlr_capture_options": CaptureOptions,
    "vlr_votf_options": VotfOptions,
    "vlr_mesh_desc": MeshDesc,
    "vlr_principled_desc": PrincipledDesc,
    "vlr_tile_options": TileOptions,
    "vlr_texture_options": TextureOptions,
    "vlr_parameter_texture": ParameterTexture,
    "vlr_instruction": Instruction,
    "vlr_program_output": ProgramOutput,
    "vlr_program_desc": ProgramDesc,
    "vlr_principled_textures": PrincipledTextures,
    "vlr_layer_desc": LayerDesc,
    "vlr_factor_desc": FactorDesc,
    "vlr_measured_layer_desc": MeasuredLayerDesc,
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
    "vlr_picture_options": PictureOptions,
}
