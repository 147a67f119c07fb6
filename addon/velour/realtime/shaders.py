"""The shaders, compiled once per session."""

from functools import wraps
from pathlib import Path

from .errors import UnshownError, log

PICTURES = 32  # number of averaged images
_FOLDER = Path(__file__).parent

_compiled = {}  # None: failed to compile


def _once(make):
    """Does not retry shaders that fail to compile: the driver would fail again and log a long message."""

    @wraps(make)
    def shader(*arguments):
        key = make.__name__, *arguments
        if key not in _compiled:
            _compiled[key] = _tried(make, arguments)
        _check(_compiled[key])
        return _compiled[key]

    return shader


def _tried(make, arguments):
    try:
        return make(*arguments)
    except Exception as error:
        log.error("%s%s does not compile", make.__name__, arguments, exc_info=error)
    return None


def _check(shader):
    if shader is None:
        raise UnshownError(
            "the graphics driver cannot compile Velour's shaders, so the ray tracer shows the scene; update"
            " the driver and restart Blender"
        )


def all_compile():
    """Whether all shaders that were requested so far have compiled."""
    return None not in _compiled.values()


def check():
    """Raises UnshownError if a shader has failed to compile."""
    for shader in _compiled.values():
        _check(shader)


def _source(*names):
    return "\n".join((_FOLDER / f"{name}.glsl").read_text(encoding="utf-8") for name in names)


@_once
def lobes_shader(has_shell):
    """GPUShader of BRDFs; raises UnshownError if it does not compile."""
    return _surface_shader("lobes", (("FLOAT_2D", "lobe_rows"),), has_shell)


@_once
def picture_shader(_has_shell):
    """GPUShader of BRDFs with a base color texture, which have no shell."""
    more = (("FLOAT_2D", "white_rows"), ("FLOAT_2D", "picture"), ("FLOAT_2D", "picture_terms"))
    return _surface_shader("lobes", (("FLOAT_2D", "lobe_rows"), *more), False, ("PICTURE",))


@_once
def btf_shader(has_shell):
    return _surface_shader("btf", (("FLOAT_2D", "btf_terms"), ("FLOAT_2D_ARRAY", "btf_maps")), has_shell)


def _surface_shader(name, tables, has_shell, defines=()):
    """`has_shell`: for meshes with the attribute `lift`, whose surface is in a shell over them."""
    import gpu

    info = gpu.types.GPUShaderCreateInfo()
    surface, attributes = "smooth", (("VEC3", "position"), ("VEC3", "normal"), ("VEC2", "uv"))
    for define in defines:
        info.define(define)
    info.define("PICTURES", f"{PICTURES}.0")
    if has_shell:
        surface, attributes = "shell", (*attributes, ("VEC3", "lift"))
        tables = (*tables, ("FLOAT_2D", "shell_terms"), ("FLOAT_3D", "shell_maps"))
        info.define("SHELL")
    shared = (("FLOAT_2D", "instances"), ("FLOAT_2D", "light_map"), ("FLOAT_2D", "lamps"))
    for slot, (kind, sampler) in enumerate((*shared, *tables)):
        info.sampler(slot, kind, sampler)
    info.push_constant("MAT4", "view_projection")
    info.push_constant("VEC4", "eye")  # its position, 1; or the direction towards it, 0
    info.push_constant("VEC4", "gain")  # w: number of lights
    info.push_constant("VEC4", "emission")  # w: number of previous images
    info.push_constant("IVEC4", "layout_")
    for slot, (kind, attribute) in enumerate(attributes):
        info.vertex_in(slot, kind, attribute)
    between = gpu.types.GPUStageInterfaceInfo(f"velour_{name}_{surface}")
    between.smooth("VEC3", "world")
    between.smooth("VEC3", "shading_normal")
    between.smooth("VEC2", "coordinates")
    between.smooth("FLOAT", "handed")  # -1: mirrored instance
    between.smooth("FLOAT", "holdout")  # 1: cuts a hole into the image
    if has_shell:
        between.smooth("VEC3", "up")
        between.smooth("FLOAT", "tile_width")
    info.vertex_out(between)
    info.fragment_out(0, "VEC4", "pixel")
    info.vertex_source(_source("surface.vert"))
    info.fragment_source(_source("light", "site", surface, "picture", f"{name}.frag"))
    return gpu.shader.create_from_info(info)


@_once
def sky_shader():
    import gpu

    info = gpu.types.GPUShaderCreateInfo()
    info.sampler(0, "FLOAT_2D", "light_map")
    info.push_constant("MAT4", "inverse_projection")
    info.push_constant("FLOAT", "exposure")
    return _full_screen(gpu, info, "light", "sky.frag")


@_once
def average_shader():
    import gpu

    info = gpu.types.GPUShaderCreateInfo()
    for slot, name in enumerate(("average", "latest")):
        info.sampler(slot, "FLOAT_2D", name)
    info.push_constant("FLOAT", "share")
    return _full_screen(gpu, info, "average.frag")


def _full_screen(gpu, info, *fragment):
    info.vertex_in(0, "VEC2", "position")
    between = gpu.types.GPUStageInterfaceInfo(f"velour_{fragment[-1].partition('.')[0]}")
    between.smooth("VEC2", "place")
    info.vertex_out(between)
    info.fragment_out(0, "VEC4", "pixel")
    info.vertex_source(_source("full_screen.vert"))
    info.fragment_source(_source(*fragment))
    return gpu.shader.create_from_info(info)
