"""Tables for shaders: the light of a scene's world, BRDFs as rows of lobes (docs/engine/realtime.md).

`threads`: 0: all; jobs without it use one.
"""

from __future__ import annotations

import ctypes

from . import library, structs
from .handle import path_bytes
from .job import Job
from .model import Model
from .shader import fill_principled


def light_map_job(scene, cache_folder=None, threads=0) -> Job:
    """Light of the world that `scene` has. Result: result_table(); the report has the world's mixture."""
    folder = path_bytes(cache_folder) if cache_folder else None
    return Job._create("vlr_light_map_create_job", scene.pointer, folder, threads)


def lobe_rows_job(model: Model, threads=0) -> Job:
    """Result: result_table(). Report: isotropic, side, blends, lobes. Not for models of BTFs."""
    return Job._create("vlr_lobe_rows_create_job", model.pointer, threads)


def btf_maps_job(model: Model) -> Job:
    """Maps of an SRBF model of a BTF. Result: result_table(), its layers one above the other."""
    return Job._create("vlr_btf_maps_create_job", model.pointer)


def shell_maps_job(model: Model) -> Job:
    """Maps of a model's VOTF. Result: result_table(), its layers one above the other, the lowest first."""
    return Job._create("vlr_shell_maps_create_job", model.pointer)


def principled_rows_job(base_color, threads=0, **values) -> Job:
    """Like lobe_rows_job(), for a Principled material with the values of Scene.add_principled_material."""
    desc = structs.PrincipledDesc()
    library.load().vlr_principled_desc_init(ctypes.byref(desc))
    fill_principled(desc, {"base_color": base_color, **values})
    return Job._create("vlr_principled_rows_create_job", ctypes.byref(desc), threads)
