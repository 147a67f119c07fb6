"""Normals, roughness and height of a model's tile, from pictures of it, and the error that remains."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ..native import Model, Scene, Shader, Texture, TextureSlot
from ..native.job_state import JobState
from .approximation_map import CENTER, show_tile, tile_job
from .heights import heights_of
from .luminance import LUMINANCE
from .photometric_stereo import normals_of, root_mean_square_slope
from .read_job import ReadJob, check

_MOST_TEXELS = 1024  # along a side; limited because all pictures are held at once
_SAMPLES = 1  # the suns have no extent: further samples would be the same
_RINGS, _AZIMUTHS = (15, 35, 55, 75), 6  # a flat texel keeps all of the third ring, and so stays flat
_JUDGES, _JUDGE_AZIMUTHS = (30, 60, 75), 3
_VIEWS = (5, 30, 60, 75, 85)  # degrees from the vertical, of the reported errors
_MEAN_UP_TO = 75  # degrees: views of the one number, as for the closures of a BRDF
_ROUGHNESS = (0.1, 0.18, 0.3, 0.45, 0.65, 0.9)
_SHOWS_HIGHLIGHTS = (
    _AZIMUTHS * 3
)  # pictures of the first rings; in the last, highlights need slopes of 37 degrees
_LEAST_SLOPE = 0.02  # root mean square; about five steps of an 8-bit map
_LEAST_GAIN = 0.1  # share of the error that a map must remove
_LEAST_HEIGHT = 2e-3  # root mean square, in widths of the tile


class TileMaps(NamedTuple):
    """Maps [rows x columns ...], row 0 at the bottom; None: not worth it.

    Errors are relative RMS errors of the approximation's pictures.
    """

    normals: np.ndarray | None = None  # unit vectors
    roughness: np.ndarray | None = None  # of the Principled BSDF, 0 to 1
    height: np.ndarray | None = None  # in widths of the tile, mean 0
    errors: tuple = ()  # from above: without maps, with normals, with roughness as well; as far as tried
    relative_l2: float | None = None  # mean of the views up to 75 degrees
    by_view_angle: dict = {}  # degrees as text: error


class TileMapsJob(ReadJob):
    """Renders the model's tile under all lights; result() is a TileMaps.

    principled, diffuse: values of the approximation; colors: its color map, RGBA; metres: size of the tile,
    if it is known.
    """

    def __init__(
        self,
        model: Model,
        principled: dict,
        diffuse: tuple | None,
        colors: np.ndarray,
        metres: tuple[float, float] | None = None,
    ):
        super().__init__(self._make)
        rows, columns = (min(side, _MOST_TEXELS) for side in colors.shape[:2])
        self._model, self._size = model, (columns, rows)
        self._principled, self._diffuse, self._colors = principled, diffuse, colors
        self._lights, self._judges = _rings(_RINGS, _AZIMUTHS), _rings(_JUDGES, _JUDGE_AZIMUTHS)
        metres = metres or colors.shape[1::-1]  # texels are square
        self._aspect = metres[1] / metres[0]
        self._done = 0
        self._all = len(self._lights) + 4 * len(self._judges) + len(_ROUGHNESS) * _SHOWS_HIGHLIGHTS
        self._all += 2 * len(_VIEWS) * len(self._judges)

    def poll(self) -> JobState:
        state = super().poll()
        return state._replace(
            fraction=self._done / self._all if state.running else state.fraction, stage="computing maps"
        )

    def _make(self) -> TileMaps:
        with Scene() as scene:
            show_tile(scene, scene.add_model_material(self._model))
            shown = list(self._pictures(scene, self._lights))
            truth = list(self._pictures(scene, self._judges))
            aside = [list(self._pictures(scene, self._judges, view)) for view in _VIEWS]
        radiance = np.array([picture[..., :3] @ LUMINANCE.astype(np.float32) for picture in shown])
        normals, roughness = normals_of(self._lights, radiance, shown[0][..., 3]), None
        errors = [self._distance(truth)]
        if root_mean_square_slope(normals) >= _LEAST_SLOPE:
            errors.append(self._distance(truth, normals))
        if len(errors) == 1 or errors[1] > (1 - _LEAST_GAIN) * errors[0]:
            normals = None
        found = self._roughness(shown[:_SHOWS_HIGHLIGHTS], normals)
        errors.append(self._distance(truth, normals, found))
        if errors[-1] <= (1 - _LEAST_GAIN) * (errors[0] if normals is None else errors[1]):
            roughness = found
        height = None if normals is None else heights_of(normals, self._aspect)
        if height is not None and np.sqrt((height**2).mean()) < _LEAST_HEIGHT:
            height = None
        by_view = {
            str(view): self._distance(pictures, normals, roughness, view)
            for view, pictures in zip(_VIEWS, aside, strict=True)
        }
        mean = float(np.mean([by_view[str(view)] for view in _VIEWS if view <= _MEAN_UP_TO]))
        return TileMaps(normals, roughness, height, tuple(errors), mean, by_view)

    def _roughness(self, shown: list, normals: np.ndarray | None) -> np.ndarray:
        """The roughness [rows x columns] that brings each texel and its neighbors nearest to the pictures."""
        weights = [1 / max(float((each[..., :3] ** 2).mean()), 1e-12) for each in shown]
        costs = np.zeros((len(_ROUGHNESS), *self._size[::-1]))
        for cost, value in zip(costs, _ROUGHNESS, strict=True):
            with Scene() as scene:
                show_tile(scene, self._approximation(scene, normals, value))
                pictures = self._pictures(scene, self._lights[: len(shown)])
                for weight, picture, wanted in zip(weights, pictures, shown, strict=True):
                    off = picture[..., :3] * wanted[..., 3:] - wanted[..., :3]
                    cost += weight * (off**2).sum(-1)
            cost[:] = _blurred(cost)
        found = np.exp(np.interp(_lowest(costs), np.arange(len(_ROUGHNESS)), np.log(_ROUGHNESS)))
        return np.where(shown[0][..., 3] > 0, found, self._principled["roughness"]).astype(np.float32)

    def _distance(self, truth: list, normals=None, roughness=None, view: float = 0) -> float:
        """Relative RMS error under the judges' lights, which have equal weight."""
        with Scene() as scene:
            show_tile(scene, self._approximation(scene, normals, roughness))
            errors = []
            for picture, wanted in zip(self._pictures(scene, self._judges, view), truth, strict=True):
                coverage = _resized(self._colors[..., 3:], wanted.shape[:2]) if view else wanted[..., 3:]
                most = max(float((wanted[..., :3] ** 2).mean()), 1e-12)
                errors.append(float(((picture[..., :3] * coverage - wanted[..., :3]) ** 2).mean()) / most)
        return math.sqrt(sum(errors) / len(errors))

    def _approximation(self, scene: Scene, normals: np.ndarray | None, roughness) -> int:
        """Adds the approximation, without anisotropy. `roughness`: None, a number or a map. Returns the
        material's number."""
        shader, relief = Shader.new(), None
        values = {name: value for name, value in self._principled.items() if name != "base_color"}
        textures = {"base_color": _slot(self._colors[..., :3])}
        if normals is not None:
            relief = _slot(encoded(normals))
        if isinstance(roughness, np.ndarray):
            textures["roughness"] = _slot(roughness[..., None], channel=0)
        elif roughness is not None:
            values["roughness"] = roughness
        shader.add_layer("principled", textures, normal=relief, **values)
        if self._diffuse:
            shader.add_layer("diffuse", normal=relief, base_color=self._diffuse)
        return scene.add_shader_material(shader)

    def _pictures(self, scene: Scene, lights: np.ndarray, view: float = 0) -> Iterable[np.ndarray]:
        """RGBA of the tile under each light, from `view` degrees from the vertical, toward -y."""
        width, height = self._size
        if view:
            height = max(round(height * math.cos(math.radians(view))), 1)
            _look_from(scene, math.radians(view))
        for light in lights:
            scene.clear_lights()
            scene.add_light("sun", (math.pi,) * 3, _shining_from(light), angle=0.0)
            scene.commit()
            with tile_job(scene, (width, height), _SAMPLES) as job:
                job.start().wait(lambda _state: check())
                self._done += 1
                yield job.read_pass("Combined")


def encoded(normals: np.ndarray) -> np.ndarray:
    """Normals as colors of a normal map, float32 from 0 to 1."""
    return (0.5 + 0.5 * normals).astype(np.float32)


def _slot(pixels: np.ndarray, **options) -> TextureSlot:
    return TextureSlot(Texture.from_pixels(np.ascontiguousarray(pixels), **options))


def _blurred(values: np.ndarray) -> np.ndarray:
    """Sums over 3 x 3 texels of a tile that repeats."""
    for axis in (0, 1):
        values = values + np.roll(values, 1, axis) + np.roll(values, -1, axis)
    return values


def _lowest(costs: np.ndarray) -> np.ndarray:
    """Place along the first axis of the lowest cost, between entries by a parabola through three of them."""
    best = costs.argmin(0)
    at = np.clip(best, 1, len(costs) - 2)
    before, middle, after = (np.take_along_axis(costs, at[None] + i, axis=0)[0] for i in (-1, 0, 1))
    bend = before - 2 * middle + after
    shift = 0.5 * (before - after) / np.where(bend > 0, bend, 1)
    return np.where(bend > 0, at + np.clip(shift, -1, 1), best)


def _resized(pixels: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """The nearest pixels of a picture of this many rows and columns."""
    rows, columns = ((np.arange(n) * m) // n for n, m in zip(shape, pixels.shape, strict=False))
    return pixels[rows][:, columns]


def _rings(degrees: tuple[int, ...], azimuths: int) -> np.ndarray:
    """Unit directions [n x 3] at these angles from the vertical, every second ring rotated by half a step."""
    theta = np.radians(degrees)[:, None]
    step = 2 * np.pi / azimuths
    phi = step * (np.arange(azimuths) + 0.5 * (np.arange(len(degrees)) % 2)[:, None])
    z = np.broadcast_to(np.cos(theta), phi.shape)
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), z], axis=-1).reshape(-1, 3)


def _look_from(scene: Scene, theta: float) -> None:
    """An orthographic camera that frames the tile, `theta` from the vertical toward -y."""
    sin, cos = math.sin(theta), math.cos(theta)
    camera = np.eye(4)
    camera[:3, 1], camera[:3, 2] = (0, cos, sin), (0, -sin, cos)
    camera[:3, 3] = np.array(CENTER) + 2 * camera[:3, 2]
    scene.set_camera(
        "orthographic", camera, (-0.5, 0.5, -0.5 * cos, 0.5 * cos), clip_start=0.01, clip_end=4.0
    )


def _shining_from(light: np.ndarray) -> np.ndarray:
    """4 x 4 transform with +z towards `light`, which must not be vertical."""
    x = np.cross((0.0, 0.0, 1.0), light)
    matrix = np.eye(4)
    matrix[:3, 2], matrix[:3, 0] = light, x / np.linalg.norm(x)
    matrix[:3, 1] = np.cross(light, matrix[:3, 0])
    return matrix
