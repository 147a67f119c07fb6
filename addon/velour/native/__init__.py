"""The shared library as Python sees it. Importing this opens nothing; the first call does."""

from . import images, library
from .btf import Btf, compare_btf_job, compress_job, compress_size, export_btf_job
from .capture import capture_job, directions, votf_data_job, votf_job
from .errors import LibraryError, Status, VelourError
from .job import (
    Job,
    JobState,
    compare_job,
    compare_peer_job,
    fit_job,
    measurement_job,
    microsurface_job,
    model_peer_job,
    observe_job,
    plot_job,
    render_job,
)
from .measurement import Measurement
from .model import Model
from .observation import Observation
from .passes import INSTANCE_LABEL, MATERIAL_LABEL, Passes, cryptomatte_id
from .plot import Plot
from .progressive import Picture, ProgressiveJob
from .realtime import btf_maps_job, light_map_job, lobe_rows_job, principled_rows_job, shell_maps_job
from .scene import Scene
from .shader import Shader
from .texture import Texture, TextureSlot
from .tile import Tile

__all__ = [
    "INSTANCE_LABEL",
    "MATERIAL_LABEL",
    "Btf",
    "Job",
    "JobState",
    "LibraryError",
    "Measurement",
    "Model",
    "Observation",
    "Passes",
    "Picture",
    "Plot",
    "ProgressiveJob",
    "Scene",
    "Shader",
    "Status",
    "Texture",
    "TextureSlot",
    "Tile",
    "VelourError",
    "btf_maps_job",
    "capture_job",
    "compare_btf_job",
    "compare_job",
    "compare_peer_job",
    "compress_job",
    "compress_size",
    "cryptomatte_id",
    "directions",
    "export_btf_job",
    "fit_job",
    "images",
    "library",
    "light_map_job",
    "lobe_rows_job",
    "measurement_job",
    "microsurface_job",
    "model_peer_job",
    "observe_job",
    "plot_job",
    "principled_rows_job",
    "render_job",
    "shell_maps_job",
    "votf_data_job",
    "votf_job",
]
