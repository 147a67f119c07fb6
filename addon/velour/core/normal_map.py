"""The normal map of a model's approximation, from pictures of its tile; kept if it reduces the error."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..native import Model, Scene, Shader, Texture, TextureSlot
from ..native.job_state import JobState
from .approximation_map import show_tile, tile_job
from .luminance import LUMINANCE
from .photometric_stereo import normals_of, root_mean_square_slope
from .read_job import ReadJob, check

_MOST_TEXELS = 1024  # along a side; limited because all pictures are held at once
_SAMPLES = 1  # the suns have no extent: further samples would be the same
_RINGS, _AZIMUTHS = (15, 35, 55, 75), 6  # a flat texel keeps all of the third ring, and so stays flat
_JUDGES, _JUDGE_AZIMUTHS = (30, 60, 75), 3
_LEAST_SLOPE = 0.02  # root mean square; about five steps of an 8-bit map
_LEAST_GAIN = 0.1  # share of the error that a map must remove


class NormalMap(NamedTuple):
    """The errors are relative RMS errors of the approximation's pictures under the validation lights."""

    normals: np.ndarray | None  # [rows x columns x 3], row 0 at the bottom; None: not worth it
    error_without: float = 0.0
    error_with: float = 0.0


class NormalMapJob(ReadJob):
    """Renders the model's tile under all lights; result() is a NormalMap.

    principled, diffuse: values of the approximation; colors: its color map, RGBA.
    """

    def __init__(self, model: Model, principled: dict, diffuse: tuple | None, colors: np.ndarray):
        super().__init__(self._make)
        rows, columns = (min(side, _MOST_TEXELS) for side in colors.shape[:2])
        self._model, self._size = model, (columns, rows)
        self._principled, self._diffuse, self._colors = principled, diffuse, colors
        self._done, self._all = 0, len(_RINGS) * _AZIMUTHS + 3 * len(_JUDGES) * _JUDGE_AZIMUTHS

    def poll(self) -> JobState:
        state = super().poll()
        return state._replace(
            fraction=self._done / self._all if state.running else state.fraction, stage="computing normals"
        )

    def _make(self) -> NormalMap:
        with Scene() as scene:
            show_tile(scene, scene.add_model_material(self._model))
            lights = _rings(_RINGS, _AZIMUTHS)
            radiance = np.empty((len(lights), *self._size[::-1]), np.float32)
            for light, seen in zip(lights, radiance, strict=True):
                picture = self._picture(scene, light)
                seen[:] = picture[..., :3] @ LUMINANCE.astype(np.float32)
            normals = normals_of(lights, radiance, picture[..., 3])
            if root_mean_square_slope(normals) < _LEAST_SLOPE:
                return NormalMap(None)
            judges = _rings(_JUDGES, _JUDGE_AZIMUTHS)
            truth = [self._picture(scene, light) for light in judges]
        without, with_map = (self._distance(each, judges, truth) for each in (None, normals))
        is_worth_it = with_map <= (1 - _LEAST_GAIN) * without
        return NormalMap(normals if is_worth_it else None, without, with_map)

    def _distance(self, normals: np.ndarray | None, lights: np.ndarray, truth: list) -> float:
        """Relative RMS error; all lights have equal weight."""
        with Scene() as scene:
            show_tile(scene, self._approximation(scene, normals))
            errors = []
            for light, wanted in zip(lights, truth, strict=True):
                shown = self._picture(scene, light)[..., :3] * wanted[..., 3:]
                most = max(float((wanted[..., :3] ** 2).mean()), 1e-12)
                errors.append(float(((shown - wanted[..., :3]) ** 2).mean()) / most)
        return math.sqrt(sum(errors) / len(errors))

    def _approximation(self, scene: Scene, normals: np.ndarray | None) -> int:
        """Adds the approximation without coat, tint and anisotropy. Returns the material's number."""
        shader, relief = Shader.new(), None
        values = {name: self._principled[name] for name in ("metallic", "roughness", "specular")}
        if normals is not None:
            relief = TextureSlot(Texture.from_pixels(np.ascontiguousarray(encoded(normals))))
        colors = Texture.from_pixels(np.ascontiguousarray(self._colors[..., :3]))
        shader.add_layer("principled", {"base_color": TextureSlot(colors)}, normal=relief, **values)
        if self._diffuse:
            shader.add_layer("diffuse", normal=relief, base_color=self._diffuse)
        return scene.add_shader_material(shader)

    def _picture(self, scene: Scene, light: np.ndarray) -> np.ndarray:
        scene.clear_lights()
        scene.add_light("sun", (math.pi,) * 3, _shining_from(light), angle=0.0)
        scene.commit()
        with tile_job(scene, self._size, _SAMPLES) as job:
            job.start().wait(lambda _state: check())
            self._done += 1
            return job.read_pass("Combined")


def encoded(normals: np.ndarray) -> np.ndarray:
    """Normals as colors of a normal map, float32 from 0 to 1."""
    return (0.5 + 0.5 * normals).astype(np.float32)


def _rings(degrees: tuple[int, ...], azimuths: int) -> np.ndarray:
    """Unit directions [n x 3] at these angles from the vertical, every second ring rotated by half a step."""
    theta = np.radians(degrees)[:, None]
    step = 2 * np.pi / azimuths
    phi = step * (np.arange(azimuths) + 0.5 * (np.arange(len(degrees)) % 2)[:, None])
    z = np.broadcast_to(np.cos(theta), phi.shape)
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), z], axis=-1).reshape(-1, 3)


def _shining_from(light: np.ndarray) -> np.ndarray:
    """4 x 4 transform with +z towards `light`, which must not be vertical."""
    x = np.cross((0.0, 0.0, 1.0), light)
    matrix = np.eye(4)
    matrix[:3, 2], matrix[:3, 0] = light, x / np.linalg.norm(x)
    matrix[:3, 1] = np.cross(light, matrix[:3, 0])
    return matrix
