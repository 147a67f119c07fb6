"""A View as GPU matrices."""

from __future__ import annotations

import numpy as np

from .shaders import PICTURES


def jitter(i):
    """Subpixel offset of image i of PICTURES, -1/2 to 1/2 per axis; the first is near the center.

    A lattice: together with the rings of btf.frag.glsl (step 7), the most even one in three dimensions.
    """
    return tuple(((step * i + PICTURES // 2) % PICTURES + 0.5) / PICTURES - 0.5 for step in (21, 19))


def view_projection(view, shift=(0.0, 0.0)):
    """[4 x 4], and the eye: its position and 1, or for parallel rays the direction towards it and 0.

    `shift`: shift of the image, in pixels.
    """
    left, right, bottom, top = view.window
    near, far = max(view.clip_start, 1e-6), max(view.clip_end, view.clip_start + 1e-5)
    to_world = np.eye(4)
    to_world[:3] = np.asarray(view.camera_to_world, float).reshape(3, 4)
    is_perspective = view.kind == "perspective"
    lens = np.zeros((4, 4))
    lens[0, 0], lens[1, 1] = 2 / (right - left), 2 / (top - bottom)
    if is_perspective:
        lens[0, 2], lens[1, 2] = (right + left) / (right - left), (top + bottom) / (top - bottom)
        lens[2, 2], lens[2, 3] = -(far + near) / (far - near), -2 * far * near / (far - near)
        lens[3, 2] = -1
        eye = (*to_world[:3, 3], 1.0)
    else:
        near = view.clip_start
        lens[0, 3], lens[1, 3] = -(right + left) / (right - left), -(top + bottom) / (top - bottom)
        lens[2, 2], lens[2, 3], lens[3, 3] = -2 / (far - near), -(far + near) / (far - near), 1
        eye = (*to_world[:3, 2], 0.0)
    moved = np.eye(4)
    moved[:2, 3] = 2 * shift[0] / view.width, 2 * shift[1] / view.height
    return moved @ lens @ np.linalg.inv(to_world), eye
