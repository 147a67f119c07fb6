"""The picture of a preset in the asset browser: a ball in a studio, by Velour's own renderer."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from preset_table import Preset, Weave
from velour.native import Model, Scene, render_job
from votf_shapes import Sphere, smooth_mesh

SIDE = 256  # pixels
_FIELD_OF_VIEW = 0.3
_ELEVATION = 0.3  # of the camera
_ROWS = 12  # of cells of the ball of a material without tiles
_HEIGHT = 256  # of the studio's picture

# Soft boxes: azimuth and elevation of the middle, degrees (the camera stands at azimuth -90), half width and
# half height, radiance. Metals show nothing else: there must be something bright, something dark, and edges.
_BOXES = (
    (-140, 38, 32, 24, 5.0),  # key, left
    (-30, 20, 10, 40, 4.0),  # strip, right
    (75, 55, 50, 16, 3.5),  # from behind
)
_COLORS = np.array([(1.0, 0.95, 0.88), (0.94, 0.97, 1.0), (1.0, 1.0, 1.0)])
_WALL = np.array([0.42, 0.41, 0.4])
_FLOOR = np.array([0.2, 0.165, 0.13])  # of wood
_SKIRTING = 0.12  # the share of the wall's light that is left where it meets the floor


def studio() -> np.ndarray:
    """Equirectangular [rows x columns x 3]: row 0 at the top, +x in the middle, azimuth grows to the left."""
    elevation = 90 - (np.arange(_HEIGHT)[:, None] + 0.5) * 180 / _HEIGHT
    azimuth = 180 - (np.arange(2 * _HEIGHT)[None, :] + 0.5) * 180 / _HEIGHT
    rise = 1 / (1 + np.exp(-elevation / 2))
    dark = 1 - (1 - _SKIRTING) * np.exp(-np.abs(elevation) / 14)
    room = (_FLOOR + (_WALL - _FLOOR) * rise[..., None]) * dark[..., None]
    light = np.broadcast_to(room, (_HEIGHT, 2 * _HEIGHT, 3)).copy()
    for (middle, height, half_width, half_height, radiance), color in zip(_BOXES, _COLORS, strict=True):
        aside = np.abs((azimuth - middle + 180) % 360 - 180)
        inside = _edge(half_width - aside) * _edge(half_height - np.abs(elevation - height))
        falloff = 0.55 + 0.45 * np.clip((elevation - height) / half_height, -1, 1)  # brighter above
        light += (inside * falloff * radiance)[..., None] * color
    return light.astype(np.float32)


def _edge(degrees: np.ndarray) -> np.ndarray:
    return np.clip(degrees / 4 + 0.5, 0, 1)


def picture(preset: Preset, model_path: Path, spp: int) -> np.ndarray:
    """[SIDE x SIDE x 4] float32, sRGB as shown, opaque; row 0 at the bottom, as Blender has previews."""
    made_of = preset.made_of
    rows = made_of.repeats // 2 if isinstance(made_of, Weave) else _ROWS
    ball = Sphere(rows, math.pi / rows)  # of radius 1
    with Scene() as scene, Model.load(model_path) as model:
        material = scene.add_model_material(model)
        mesh, _dropped = scene.add_mesh(**smooth_mesh(ball))
        scene.add_instance(mesh, np.eye(4)[:3], [material])
        scene.set_world_pixels(studio())
        eye = (
            1.1 / math.tan(_FIELD_OF_VIEW / 2) * np.array([0.0, -math.cos(_ELEVATION), math.sin(_ELEVATION)])
        )
        scene.look_at(tuple(eye), (0, 0, 0), _FIELD_OF_VIEW, 1.0)
        scene.commit()
        options = {"width": SIDE, "height": SIDE, "spp": spp, "bounces": 3, "transparent": 1, "seed": 1}
        with render_job(scene, strategy="mis", **options) as job:
            job.run()
            return _shown(job.read_pass("Combined"))


def _shown(linear: np.ndarray) -> np.ndarray:
    """Over a backdrop that grows darker upwards; highlights roll off, colours keep their hue."""
    backdrop = np.linspace(0.22, 0.05, SIDE)[:, None, None]
    color = linear[..., :3] + (1 - linear[..., 3:]) * backdrop
    peak = color.max(axis=-1, keepdims=True)
    rolled = np.where(peak > 0.6, 0.6 + 0.4 * np.tanh((peak - 0.6) / 1.2), peak)
    # What is brighter than white loses some of its colour, as on film.
    pale = np.clip((peak - 1.5) / 8, 0, 0.6)
    color = color * (rolled / np.maximum(peak, 1e-6)) * (1 - pale) + rolled * pale
    encoded = np.where(
        color <= 0.0031308, 12.92 * color, 1.055 * np.maximum(color, 0.0031308) ** (1 / 2.4) - 0.055
    )
    opaque = np.ones((*color.shape[:2], 1))
    return np.concatenate([np.clip(encoded, 0, 1), opaque], axis=-1).astype(np.float32)
