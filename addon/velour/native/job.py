"""Jobs: fit, compare, capture, render, observe. One mechanism for progress, cancellation and errors."""

from __future__ import annotations

import contextlib
import ctypes
import math
import os
import time

import numpy as np

from . import library, structs, table
from .arrays import pointer, small
from .errors import VelourError, refuse
from .handle import Handle, choice, path_bytes, set_fields, text_bytes
from .job_state import JobState, ProgressCallback
from .measurement import Measurement
from .model import Model
from .observation import Observation
from .passes import Passes, channels_of
from .plot import Plot, plot_arguments

_SLICE_SECONDS = 0.1  # longest time that a signal (Ctrl-C) has to wait for the interpreter


class Job(Handle):
    """poll(), cancel() and read_pass() may be called from any thread."""

    _free_name = "vlr_job_free"

    def __init__(self, lib, pointer, size: tuple[int, int] | None = None):
        super().__init__(lib, pointer)
        self.size = size  # width, height of the picture of a render job

    def start(self) -> Job:
        """Starts on a thread of the library. A cancelled or failed job may be started again."""
        self._lib.vlr_job_start(self.pointer)
        return self

    def poll(self) -> JobState:
        raw = structs.JobStateStruct()
        self._lib.vlr_job_poll(self.pointer, ctypes.byref(raw))
        return JobState(
            table.JOB_STATES[raw.state],
            raw.fraction,
            (raw.stage or b"").decode(),
            raw.seconds,
            raw.seconds_left if raw.seconds_left >= 0 else None,
            raw.bytes_in_use,
        )

    def cancel(self) -> None:
        """Requests a cancel; the job stops within 0.1 s."""
        self._lib.vlr_job_cancel(self.pointer)

    def stop(self) -> None:
        """Asks a render to end after a whole pass and to keep its samples; its report tells their number."""
        self._lib.vlr_job_stop(self.pointer)

    def wait(self, progress: ProgressCallback | None = None, timeout: float | None = None) -> bool:
        """Waits for the end; False if `timeout` seconds ran out first. Raises the error of a failed job.

        `progress` is called on this thread about ten times a second and once at the end. An exception from
        it, or Ctrl-C, cancels the job and propagates once the job has stopped.
        """
        end = math.inf if timeout is None else time.monotonic() + timeout
        try:
            while True:
                finished = self._wait_once(max(0.0, min(_SLICE_SECONDS, end - time.monotonic())))
                if progress:
                    progress(self.poll())
                if finished or time.monotonic() >= end:
                    return finished
        except BaseException:
            self._stop()
            raise

    def run(self, progress: ProgressCallback | None = None) -> dict:
        """start(), wait() and report() in one."""
        self.start().wait(progress)
        return self.report()

    def report(self) -> dict:
        """Report of a finished job, with the JSON keys of the command line's verb."""
        return library.json_of(self._lib.vlr_job_report_json, self.pointer)

    def result_model(self) -> Model:
        """The model of a finished fit."""
        return Model._create("vlr_job_result_model", self.pointer)

    def result_measurement(self) -> Measurement:
        """The measurement of a finished measurement_job()."""
        return Measurement._create("vlr_job_result_measurement", self.pointer)

    def result_plot(self) -> Plot:
        """The plot of a finished plot_job()."""
        return Plot._create("vlr_job_result_plot", self.pointer)

    def result_observation(self) -> Observation:
        """The observation of a finished observe_job()."""
        return Observation._create("vlr_job_result_observation", self.pointer)

    def result_table(self) -> np.ndarray:
        """The table of a finished job that makes one for shaders: [height x width x 4] float32."""
        floats, width, height = ctypes.POINTER(ctypes.c_float)(), ctypes.c_uint32(), ctypes.c_uint32()
        self._lib.vlr_job_result_table(
            self.pointer, ctypes.byref(floats), ctypes.byref(width), ctypes.byref(height)
        )
        return np.ctypeslib.as_array(floats, (height.value, width.value, 4)).copy()

    def read_pass(self, name: str, out: np.ndarray | None = None) -> np.ndarray:
        """The film so far, even while the job runs: [height x width x channels] float32, row 0 at the bottom.

        "Combined" 4 (RGBA, premultiplied), "Depth" 1, "Normal" 3 (world), "Sample Count" 1, and the requested
        Passes.
        """
        if self.size is None:
            raise refuse("This job does not render, so it has no passes.")
        shape = (self.size[1], self.size[0], channels_of(name))
        if out is None:
            out = np.empty(shape, np.float32)
        elif out.size != np.prod(shape) or out.dtype != np.float32 or not out.flags.c_contiguous:
            raise refuse(
                f"The buffer for {name} must be a contiguous float32 array of {np.prod(shape)} numbers."
            )
        self._lib.vlr_job_read_pass(self.pointer, name.encode(), pointer(out), out.size)
        return out

    def read_sums(self) -> np.ndarray:
        """The sums in the film, for add_sums(): [height x width x sums_per_pixel()] float32."""
        out = np.empty((self.size[1], self.size[0], self.sums_per_pixel()), np.float32)
        self._lib.vlr_job_read_sums(self.pointer, pointer(out), out.size, None)
        return out

    def sums_per_pixel(self) -> int:
        numbers = ctypes.c_uint32()
        self._lib.vlr_job_read_sums(self.pointer, None, 0, ctypes.byref(numbers))
        return numbers.value

    def add_sums(self, sums: np.ndarray) -> None:
        """Adds read_sums() of another run: before the start, sums of camera rays that precede those of this
        job; once it is done, sums of camera rays that follow them."""
        sums = np.ascontiguousarray(sums, np.float32)
        self._lib.vlr_job_add_sums(self.pointer, pointer(sums), sums.size)

    def _wait_once(self, seconds: float) -> bool:
        finished = ctypes.c_int32()
        no_callback = table.ProgressFunction()
        self._lib.vlr_job_wait(self.pointer, seconds, no_callback, None, ctypes.byref(finished))
        return bool(finished.value)

    def _stop(self) -> None:
        if not self.poll().running:
            return
        self.cancel()
        with contextlib.suppress(VelourError):  # "cancelled": the caller raises the reason
            self._wait_once(-1.0)


def measurement_job(path: str | os.PathLike) -> Job:
    """Reads a measurement like Measurement.load(). Result: result_measurement()."""
    return Job._create("vlr_measurement_load_create_job", path_bytes(path))


def plot_job(model: Model, kind: str, measurement: Measurement | None = None, **view: float) -> Job:
    """Like Plot.of(). Result: result_plot()."""
    return Job._create("vlr_plot_create_job", *plot_arguments(model, kind, measurement, **view))


def fit_job(measurement: Measurement, **options) -> Job:
    """Options: model ("auto", "parametric", "scattered"), kernel (scattered: "gaussian", "abel-poisson"),
    tolerance, max_lobes, threads, max_bytes, seed, all_data, align_views (scattered), limit_albedo and
    symmetric (parametric); for_scene (an Observation) and full_model (a Model) make a scene model of a
    parametric one. The library has defaults for all. Result: result_model()."""
    raw = _defaults(structs.FitOptions, "vlr_fit_options_init")
    for name in {"for_scene", "full_model"} & options.keys():
        options[name] = options[name].pointer
    enums = {"model": table.MODELS, "kernel": table.KERNELS}
    for name in enums.keys() & options.keys():
        options[name] = choice(name, options[name], enums[name])
    set_fields(raw, options)
    return Job._create("vlr_fit_create_job", measurement.pointer, ctypes.byref(raw))


def compare_job(measurement: Measurement, model: Model) -> Job:
    """Errors of the model at the held-out directions."""
    return Job._create("vlr_compare_create_job", measurement.pointer, model.pointer)


def compare_peer_job(measurement: Measurement, peer: str) -> Job:
    """The errors of compare_job() for the best fit of a `peer` (table.PEERS), and its parameters."""
    number = choice("peer", peer, table.PEERS)
    return Job._create("vlr_compare_peer_create_job", measurement.pointer, number)


def model_peer_job(model: Model, peer: str) -> Job:
    """Like compare_peer_job(), for a model instead of a measurement."""
    return Job._create("vlr_model_peer_create_job", model.pointer, choice("peer", peer, table.PEERS))


def microsurface_job(path: str | os.PathLike, **options) -> Job:
    """Writes a virtual measurement to `path`. Options: roughness, anisotropy, metal, base_albedo, base_share,
    ior, flake_roughness, rays, seed, threads."""
    raw = _defaults(structs.MicrosurfaceOptions, "vlr_microsurface_options_init")
    if "metal" in options:
        options["metal"] = text_bytes(options["metal"])
    if "base_albedo" in options:
        options["base_albedo"] = small("base_albedo", options["base_albedo"], 3)
    set_fields(raw, options)
    return Job._create("vlr_microsurface_create_job", ctypes.byref(raw), path_bytes(path))


def render_job(scene, passes: Passes | None = None, **options) -> Job:
    """Renders a committed `scene` with extra `passes`. Options: width, height, spp, split, bounces, strategy
    (table.STRATEGIES), threads, seed, time_limit (seconds), transparent, measure_ray_share, heuristic
    (table.HEURISTICS), sequence (table.SEQUENCES), share, noise, cache_folder (keeps fits of the environment;
    default: none), clamp_direct, clamp_indirect, filter_glossy, reflective_caustics, denoise; for parts:
    samples_begin, samples_end, crop_x0, crop_y0, crop_x1, crop_y1 (vlr_render_options)."""
    raw = render_options(options)
    if passes:
        raw.passes = ctypes.pointer(passes.raw())
    size = (raw.crop_x1 - raw.crop_x0, raw.crop_y1 - raw.crop_y0) if raw.crop_x1 else (raw.width, raw.height)
    return Job._create("vlr_render_create_job", scene.pointer, ctypes.byref(raw), size=size)


def render_options(options: dict) -> structs.RenderOptions:
    raw = _defaults(structs.RenderOptions, "vlr_render_options_init")
    enums = {"strategy": table.STRATEGIES, "heuristic": table.HEURISTICS, "sequence": table.SEQUENCES}
    chosen = {name: choice(name, options[name], enums[name]) for name in enums.keys() & options.keys()}
    if options.get("cache_folder") is not None:
        chosen["cache_folder"] = path_bytes(options["cache_folder"])
    set_fields(raw, {**options, **chosen})
    return raw


def denoise_job(render: Job, threads: int = 0) -> Job:
    """Adds the pass "Denoised" to a render_job() with the option `denoise` that has ended. Report: relmse and
    relmse_bound of the denoised picture (None: unknown), noisy_share, path."""
    return Job._create("vlr_denoise_create_job", render.pointer, threads)


def biases(options: dict) -> list[str]:
    """Names of the options of render_job() that bias its picture, which its noise does not show."""
    raw = render_options(options)
    names = [name for name in ("clamp_direct", "clamp_indirect", "filter_glossy") if getattr(raw, name) > 0]
    return names if raw.reflective_caustics else [*names, "reflective_caustics"]


def observe_job(scene, material: int, **options) -> Job:
    """Records the views and lights under which a committed `scene` shows the material with this number.
    Options: width, height, bounces, threads, seed. Result: result_observation()."""
    raw = _defaults(structs.ObserveOptions, "vlr_observe_options_init")
    set_fields(raw, options)
    return Job._create("vlr_observe_create_job", scene.pointer, material, ctypes.byref(raw))


def _defaults(struct_type, init_name: str):
    raw = struct_type()
    getattr(library.load(), init_name)(ctypes.byref(raw))
    return raw
