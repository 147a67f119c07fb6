"""A ball in a studio: shows materials side by side, in asset browsers and comparisons."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ..native import Job, Scene, render_job
from .srgb import encoded

ROWS = 12  # tiles from pole to pole; twice as many around
_FACETS = 8  # per side of a tile
_FIELD_OF_VIEW = 0.3  # radians
_ELEVATION = 0.3  # camera elevation, radians
_ROWS_OF_STUDIO = 256

# Soft boxes: azimuth and elevation of the center (the camera is at azimuth -90), half width and half height,
# all in degrees; radiance. Metals show nothing else, so they need bright parts, dark parts, and edges.
_BOXES = (
    (-140, 38, 32, 24, 5.0),  # key, left
    (-30, 20, 10, 40, 4.0),  # strip, right
    (75, 55, 50, 16, 3.5),  # from behind
)
_COLORS = np.array([(1.0, 0.95, 0.88), (0.94, 0.97, 1.0), (1.0, 1.0, 1.0)])
_WALL = np.array([0.42, 0.41, 0.4])
_FLOOR = np.array([0.2, 0.165, 0.13])  # wood
_SKIRTING = 0.12  # share of the wall's light that remains where it meets the floor


def studio(rows: int = _ROWS_OF_STUDIO) -> np.ndarray:
    """Equirectangular [rows x columns x 3]: row 0 at the top, +x in the middle, azimuth grows to the left."""
    elevation = 90 - (np.arange(rows)[:, None] + 0.5) * 180 / rows
    azimuth = 180 - (np.arange(2 * rows)[None, :] + 0.5) * 180 / rows
    rise = 1 / (1 + np.exp(-elevation / 2))
    dark = 1 - (1 - _SKIRTING) * np.exp(-np.abs(elevation) / 14)
    room = (_FLOOR + (_WALL - _FLOOR) * rise[..., None]) * dark[..., None]
    light = np.broadcast_to(room, (rows, 2 * rows, 3)).copy()
    for (middle, height, half_width, half_height, radiance), color in zip(_BOXES, _COLORS, strict=True):
        aside = np.abs((azimuth - middle + 180) % 360 - 180)
        inside = _edge(half_width - aside) * _edge(half_height - np.abs(elevation - height))
        falloff = 0.55 + 0.45 * np.clip((elevation - height) / half_height, -1, 1)  # brighter above
        light += (inside * falloff * radiance)[..., None] * color
    return light.astype(np.float32)


def _edge(degrees: np.ndarray) -> np.ndarray:
    return np.clip(degrees / 4 + 0.5, 0, 1)


def ball_mesh(rows: int = ROWS) -> dict[str, np.ndarray]:
    """A ball of radius 1 about the origin with its axis along z, as keywords of Scene.add_mesh. Texture
    coordinates count tiles."""
    columns, bands = 2 * rows * _FACETS, rows * _FACETS
    u, v = np.meshgrid(np.arange(columns + 1), np.arange(bands + 1))
    longitude, latitude = u * (2 * np.pi / columns), v * (np.pi / bands) - np.pi / 2
    across = np.cos(latitude)
    points = np.stack((across * np.cos(longitude), across * np.sin(longitude), np.sin(latitude)), axis=-1)
    points = points.reshape(-1, 3).astype(np.float32)
    uvs = (np.stack((u, v), axis=-1).reshape(-1, 2) / _FACETS).astype(np.float32)
    first = (np.arange(bands)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    opposite = first + columns + 2
    lower = np.stack((first, first + 1, opposite), axis=-1)
    upper = np.stack((first, opposite, opposite - 1), axis=-1)
    corners = np.concatenate((lower[columns:], upper[:-columns]))  # one triangle per quad at the poles
    return {
        "positions": points,
        "triangles": corners.astype(np.uint32),
        "corner_normals": points[corners],
        "corner_uvs": uvs[corners],
    }


def ball_scene(add: Callable[[Scene], int], rows: int = ROWS) -> Scene:
    """The committed scene of the studio and a ball of the material whose number `add` returns."""
    scene = Scene()
    try:
        material = add(scene)
        mesh, _dropped = scene.add_mesh(**ball_mesh(rows))
        scene.add_instance(mesh, np.eye(4)[:3], [material])
        scene.set_world_pixels(studio())
        away = 1.1 / math.tan(_FIELD_OF_VIEW / 2)
        eye = (0.0, -away * math.cos(_ELEVATION), away * math.sin(_ELEVATION))
        scene.look_at(eye, (0, 0, 0), _FIELD_OF_VIEW, 1.0)
        scene.commit()
        return scene
    except BaseException:
        scene.close()
        raise


def ball_job(scene: Scene, side: int, spp: int, threads: int = 0) -> Job:
    """Renders `side` x `side` pixels, transparent around the ball, with one seed for all materials."""
    options = {"width": side, "height": side, "spp": spp, "bounces": 3, "transparent": 1, "seed": 1}
    return render_job(scene, strategy="mis", threads=threads, **options)


def shown(linear: np.ndarray) -> np.ndarray:
    """A picture of ball_job() for previews: sRGB, opaque, over a backdrop that darkens upwards.

    [side x side x 4] float32, row 0 at the bottom. Highlights roll off, colors keep their hue."""
    side = linear.shape[0]
    backdrop = np.linspace(0.22, 0.05, side)[:, None, None]
    color = linear[..., :3] + (1 - linear[..., 3:]) * backdrop
    peak = color.max(axis=-1, keepdims=True)
    rolled = np.where(peak > 0.6, 0.6 + 0.4 * np.tanh((peak - 0.6) / 1.2), peak)
    # Colors brighter than white desaturate, as on film.
    pale = np.clip((peak - 1.5) / 8, 0, 0.6)
    color = color * (rolled / np.maximum(peak, 1e-6)) * (1 - pale) + rolled * pale
    opaque = np.ones((*color.shape[:2], 1))
    return np.concatenate([np.clip(encoded(color), 0, 1), opaque], axis=-1).astype(np.float32)
