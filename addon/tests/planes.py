"""A plane from -1 to 1 seen from above, whose pixels are known."""

from __future__ import annotations

import numpy as np
from velour.native import Scene, render_job

SIDE = 8  # pixels
_POSITIONS = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
_TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)


def add(scene: Scene, **corners) -> int:
    """The number of the plane's mesh. `corners`: arguments of add_mesh() in place of texture coordinates."""
    uvs = np.ascontiguousarray(0.5 + 0.5 * _POSITIONS[_TRIANGLES][..., :2], np.float32)
    return scene.add_mesh(_POSITIONS, _TRIANGLES, **(corners or {"corner_uvs": uvs}))[0]


def seen(scene: Scene, half: float = 1.0, **options) -> np.ndarray:
    """Commits the scene and renders what lies between -half and half, [row, column, 4]."""
    look_down = np.eye(4)
    look_down[2, 3] = 5
    scene.set_camera("orthographic", look_down, (-half, half, -half, half))
    scene.commit()
    options = {"width": SIDE, "height": SIDE, "strategy": "cosine", **options}
    with render_job(scene, **options) as job:
        job.run()
        return job.read_pass("Combined")
