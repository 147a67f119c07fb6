"""The colors of a model's tile, seen from above under a white environment."""

from __future__ import annotations

import numpy as np

from ..native import Job, Model, Scene, render_job

_MOST_TEXELS = 4096  # along a side
_SAMPLES = 64
_CORNERS = np.array([(-1, -1, 0), (2, -1, 0), (2, 2, 0), (-1, 2, 0)], np.float32)  # a tile and its neighbors
CENTER = (0.5, 0.5, 0.0)
_TRIANGLES = np.array([(0, 1, 2), (0, 2, 3)], np.uint32)


def size_of(info: dict) -> tuple[int, int] | None:
    """Columns and rows of a model's map, from its info; None if its surface is uniform."""
    sizes = [info.get("texels"), info.get("shell", {}).get("points")]
    sizes = [size[:2] for size in sizes if size]
    if not sizes:
        return None
    return tuple(min(max(sides), _MOST_TEXELS) for sides in zip(*sizes, strict=True))


def show_tile(scene: Scene, material: int) -> None:
    """Shows one tile of a material from above in an empty scene, with neighbors that its VOTF may overlap."""
    uvs = np.ascontiguousarray(_CORNERS[_TRIANGLES][..., :2])
    mesh, _dropped = scene.add_mesh(_CORNERS, _TRIANGLES, corner_uvs=uvs)
    scene.add_instance(mesh, np.eye(4), [material])
    above = np.eye(4)
    above[2, 3] = 2.0
    scene.set_camera("orthographic", above, (0, 1, 0, 1), clip_start=0.01, clip_end=4.0)


def tile_job(scene: Scene, size: tuple[int, int], samples: int) -> Job:
    """Renders the tile of a committed scene, one pixel per texel."""
    return render_job(
        scene, width=size[0], height=size[1], spp=samples, bounces=0, strategy="cosine", transparent=1
    )


def map_job(model: Model, size: tuple[int, int]) -> Job:
    """Renders one tile: its premultiplied albedo and its coverage."""
    with Scene() as scene:
        show_tile(scene, scene.add_model_material(model))
        scene.set_world_color((1.0, 1.0, 1.0))
        scene.commit()
        return tile_job(scene, size, _SAMPLES)


def map_of(picture: np.ndarray, base_color) -> np.ndarray:
    """RGBA [rows x columns x 4], not premultiplied, from the picture of a map_job().

    It is scaled to the mean `base_color`, which was fitted to the tile's mean, because its albedo includes
    the highlights, which would be counted twice.
    """
    alpha = np.clip(picture[..., 3:], 0.0, 1.0)
    albedo = picture[..., :3] / np.maximum(alpha, 1e-6)
    mean = picture[..., :3].sum((0, 1)) / max(float(alpha.sum()), 1e-6)
    color = np.where(alpha > 0, albedo * (np.asarray(base_color) / np.maximum(mean, 1e-6)), base_color)
    return np.concatenate([np.clip(color, 0.0, 1.0), alpha], axis=-1).astype(np.float32)
