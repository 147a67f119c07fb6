"""The colours of a model's tile, as one sees them from above under a white sky."""

from __future__ import annotations

import numpy as np

from ..native import Job, Model, Scene, render_job

_MOST_TEXELS = 4096  # along a side
_SAMPLES = 64
_CORNERS = np.array([(-1, -1, 0), (2, -1, 0), (2, 2, 0), (-1, 2, 0)], np.float32)  # tiles around the one seen
_TRIANGLES = np.array([(0, 1, 2), (0, 2, 3)], np.uint32)


def size_of(info: dict) -> tuple[int, int] | None:
    """Columns and rows of a model's map, by its info; None where all of its surface is alike."""
    sizes = [info.get("texels"), info.get("shell", {}).get("points")]
    sizes = [size[:2] for size in sizes if size]
    if not sizes:
        return None
    return tuple(min(max(sides), _MOST_TEXELS) for sides in zip(*sizes, strict=True))


def show_tile(scene: Scene, material: int) -> None:
    """One tile of a material of an empty scene, seen from above, amid tiles that its outline may lean on."""
    uvs = np.ascontiguousarray(_CORNERS[_TRIANGLES][..., :2])
    mesh, _dropped = scene.add_mesh(_CORNERS, _TRIANGLES, corner_uvs=uvs)
    scene.add_instance(mesh, np.eye(4), [material])
    above = np.eye(4)
    above[2, 3] = 2.0
    scene.set_camera("orthographic", above, (0, 1, 0, 1), clip_start=0.01, clip_end=4.0)


def tile_job(scene: Scene, size: tuple[int, int], samples: int) -> Job:
    """A picture of the tile of a committed scene, each texel a pixel."""
    return render_job(
        scene, width=size[0], height=size[1], spp=samples, bounces=0, strategy="cosine", transparent=1
    )


def map_job(model: Model, size: tuple[int, int]) -> Job:
    """A picture of one tile: its albedo, premultiplied, and how much of it is there."""
    with Scene() as scene:
        show_tile(scene, scene.add_model_material(model))
        scene.set_world_color((1.0, 1.0, 1.0))
        scene.commit()
        return tile_job(scene, size, _SAMPLES)


def map_of(picture: np.ndarray, base_color) -> np.ndarray:
    """RGBA [rows x columns x 4], not premultiplied, from the picture of a map_job().

    Its mean is `base_color`, the fit to the mean of the tile, so that its highlights are not counted twice.
    """
    alpha = np.clip(picture[..., 3:], 0.0, 1.0)
    albedo = picture[..., :3] / np.maximum(alpha, 1e-6)
    mean = picture[..., :3].sum((0, 1)) / max(float(alpha.sum()), 1e-6)
    color = np.where(alpha > 0, albedo * (np.asarray(base_color) / np.maximum(mean, 1e-6)), base_color)
    return np.concatenate([np.clip(color, 0.0, 1.0), alpha], axis=-1).astype(np.float32)
