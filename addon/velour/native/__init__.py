"""Python bindings of the shared library. Importing them does not open it; the first call does.

Names are imported from their modules on first use: most modules need numpy, which takes longer to import than
a command like `velour info` takes in total.
"""

import importlib

_MODULES = {
    "btf": ("Btf", "compare_btf_job", "compress_job", "compress_size", "export_btf_job"),
    "capture": ("capture_job", "directions", "votf_data_job", "votf_job"),
    "errors": ("LibraryError", "Status", "VelourError"),
    "job": (
        "Job",
        "biases",
        "compare_job",
        "compare_peer_job",
        "denoise_job",
        "fit_job",
        "measurement_job",
        "microsurface_job",
        "model_peer_job",
        "observe_job",
        "plot_job",
        "render_job",
    ),
    "job_state": ("JobState",),
    "measurement": ("Measurement",),
    "model": ("Model",),
    "observation": ("Observation",),
    "passes": ("INSTANCE_LABEL", "MATERIAL_LABEL", "Passes", "cryptomatte_id"),
    "plot": ("Plot",),
    "program": ("Instruction", "Output", "Program"),
    "progressive": ("Picture", "ProgressiveJob"),
    "realtime": ("btf_maps_job", "light_map_job", "lobe_rows_job", "principled_rows_job", "shell_maps_job"),
    "scene": ("Scene",),
    "shader": ("Shader",),
    "texture": ("Texture", "TextureSlot"),
    "tile": ("Tile",),
}
_SUBMODULES = ("images", "library")
_MODULE_OF = {name: module for module, names in _MODULES.items() for name in names}


def __getattr__(name: str):
    if name in _SUBMODULES:
        return importlib.import_module(f"{__name__}.{name}")
    if name not in _MODULE_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(f"{__name__}.{_MODULE_OF[name]}"), name)
    globals()[name] = value  # no further calls for this name
    return value
