"""Things and cameras that move, from Python."""

from __future__ import annotations

import numpy as np
import pytest
from velour.native import Passes, Scene, VelourError, render_job

_SQUARE = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float32)
_TRIANGLES = np.array([(0, 1, 2), (0, 2, 3)], np.uint32)
_WINDOW = (-2, 2, -2, 2)
_EVEN = np.ones(1, np.float32)


def _shifted(x, y=0.0):
    place = np.eye(4, dtype=np.float32)[:3]
    place[:2, 3] = x, y
    return place


def _rendered(place, camera=None, moved=None, name="Combined", passes=None, **view):
    """[16 x 16 x channels] of a square seen straight from above, 4 m wide."""
    camera = _shifted(0) if camera is None else camera
    camera = camera.copy()
    camera[..., 2, 3] = 5
    motion = {"motion": camera} if camera.ndim == 3 else {}
    shapes = {} if moved is None else {"moved_positions": moved}
    with Scene() as scene:
        mesh, _ = scene.add_mesh(_SQUARE, _TRIANGLES, **shapes)
        scene.add_instance(mesh, place, [scene.add_principled_material(base_color=(0.5, 0.5, 0.5))])
        scene.set_world_color((1, 1, 1))
        scene.set_camera("orthographic", camera.reshape(-1, 3, 4)[0], _WINDOW, **motion, **view)
        scene.commit()
        with render_job(scene, passes, width=16, height=16, spp=256, split=1, transparent=1) as job:
            job.run()
            return job.read_pass(name)


def test_a_square_that_moves_covers_its_share_of_the_time():
    moving = np.stack([_shifted(-1), _shifted(1)])
    alpha = _rendered(moving, shutter=_EVEN)[8, :, 3]
    ends = np.arange(17) / 4 - 2
    x = (ends[1:] + ends[:-1]) / 2
    np.testing.assert_allclose(alpha, 1 - np.abs(x) / 2, atol=0.02)
    back = moving[::-1].copy()
    np.testing.assert_allclose(_rendered(_shifted(0), back, shutter=_EVEN)[8, :, 3], alpha, atol=0.03)
    way = np.array((1, 0, 0), np.float32)
    shapes = np.stack([_SQUARE - way, _SQUARE + way])
    np.testing.assert_allclose(_rendered(_shifted(0), moved=shapes, shutter=_EVEN)[8, :, 3], alpha, atol=0.03)
    late = _rendered(moving, shutter=np.array([0, 0, 0, 1], np.float32))[8, :, 3]
    assert late[:4].max() < 0.1 < alpha[3]


def test_without_a_shutter_only_the_pass_vector_shows_motion():
    moving = np.stack([_shifted(-0.5), _shifted(0), _shifted(0, 1)])
    np.testing.assert_array_equal(_rendered(moving), _rendered(_shifted(0)))
    vector = _rendered(moving, name="Vector", passes=Passes(frozenset({"vector"})))
    np.testing.assert_allclose(vector[8, 8], (-2, 0, 0, -4), atol=1e-4)
    np.testing.assert_array_equal(vector[0, 0], 0)


def test_memory_of_shapes_and_steps_is_counted():
    sizes = []
    for steps in (2, 100):
        with Scene() as scene:
            moved = np.repeat(_SQUARE[None], steps, axis=0)
            mesh, _ = scene.add_mesh(_SQUARE, _TRIANGLES, moved_positions=moved)
            places = np.stack([_shifted(float(i)) for i in range(steps)])
            scene.add_instance(mesh, places, [scene.add_principled_material()])
            scene.commit()
            sizes.append(scene.info()["bytes"])
    assert sizes[1] >= sizes[0] + 98 * (48 + 10 * 12)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"shutter": np.zeros(4, np.float32)}, "never opens"),
        ({"shutter": np.array([1, -2], np.float32)}, "-2"),
        ({"motion": np.zeros((1, 3, 4), np.float32)}, "1; the camera moves in 2 to 129 steps"),
        ({"motion": np.full((2, 3, 4), np.nan, np.float32)}, "transform of the camera"),
        (
            {"motion": np.ones((2, 3, 4), np.float32), "motion_window": np.ones((3, 4), np.float32)},
            "shape",
        ),
    ],
)
def test_cameras_that_cannot_be(arguments, words):
    with Scene() as scene, pytest.raises(VelourError, match=words):
        scene.set_camera("orthographic", _shifted(0), _WINDOW, **arguments)


def test_meshes_and_instances_that_cannot_be():
    with Scene() as scene:
        with pytest.raises(VelourError, match="1 steps"):
            scene.add_mesh(_SQUARE, _TRIANGLES, moved_positions=_SQUARE[None])
        with pytest.raises(VelourError, match="moved_positions"):
            scene.add_mesh(_SQUARE, _TRIANGLES, moved_positions=np.zeros((2, 3, 3), np.float32))
        mesh, _ = scene.add_mesh(_SQUARE, _TRIANGLES)
        material = scene.add_principled_material()
        with pytest.raises(VelourError, match="130 steps"):
            scene.add_instance(mesh, np.repeat(_shifted(0)[None], 130, axis=0), [material])
        endless = np.stack([_shifted(0), _shifted(np.inf)])
        with pytest.raises(VelourError, match="not finite"):
            scene.add_instance(mesh, endless, [material])
