"""Textures through the wrapper classes: planes whose pixels are known."""

from __future__ import annotations

import numpy as np
import pytest
from velour.native import Scene, Status, Texture, TextureSlot, VelourError, images, render_job

SIDE = 8


def _picture():
    rows, columns = np.mgrid[0:SIDE, 0:SIDE].astype(np.float32) / SIDE
    return np.ascontiguousarray(np.stack([columns, rows, np.full_like(rows, 0.25)], axis=-1))


def _plane(scene):
    positions = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
    uvs = (0.5 + 0.5 * positions[triangles][..., :2]).astype(np.float32)
    return scene.add_mesh(positions, triangles, corner_uvs=np.ascontiguousarray(uvs))[0]


def _rendered(textures, **values):
    with Scene() as scene:
        material = scene.add_textured_material(textures, specular=0.0, **values)
        scene.add_instance(_plane(scene), np.eye(4), [material])
        scene.set_world_color((1, 1, 1))
        look_down = np.eye(4)
        look_down[2, 3] = 5
        scene.set_camera("orthographic", look_down, (-1, 1, -1, 1))
        scene.commit()
        with render_job(scene, width=SIDE, height=SIDE, spp=32, strategy="cosine") as job:
            job.run()
            return job.read_pass("Combined")[..., :3]


def test_a_plane_shows_its_picture():
    with Texture.from_pixels(_picture(), filter="closest") as texture:
        pixels = _rendered({"base_color": TextureSlot(texture)})
    np.testing.assert_allclose(pixels, _picture(), atol=2e-4)


def test_maps_turn_pictures():
    turned = ((0, 1, 0), (1, 0, 0.25))
    with Texture.from_pixels(_picture(), filter="closest") as texture:
        pixels = _rendered({"base_color": TextureSlot(texture, turned)})
    expected = np.roll(_picture(), -SIDE // 4, axis=0).transpose(1, 0, 2)
    np.testing.assert_allclose(pixels, expected, atol=2e-4)


def test_files_are_decoded_unless_they_hold_data(tmp_path):
    path = tmp_path / "grey.png"
    images.write(path, np.full((2, 2, 3), 0.5, np.float32))
    with Texture.load(path) as colour, Texture.load(path, raw=1) as data:
        assert _rendered({"base_color": TextureSlot(colour)})[3, 3, 0] == pytest.approx(0.5, abs=0.01)
        assert _rendered({"base_color": TextureSlot(data)})[3, 3, 0] == pytest.approx(0.735, abs=0.01)


def test_values_hold_where_no_texture_is():
    pixels = _rendered({}, base_color=(0.1, 0.2, 0.3))
    np.testing.assert_allclose(pixels.mean(axis=(0, 1)), (0.1, 0.2, 0.3), atol=1e-4)


def test_colours_and_numbers_are_not_mixed_up():
    with Texture.from_pixels(_picture()) as colour, Texture.from_pixels(_picture(), channel=2) as number:
        with pytest.raises(VelourError, match="roughness needs a texture of numbers"):
            _rendered({"roughness": TextureSlot(colour)})
        with pytest.raises(VelourError, match="base_color needs a texture of colours"):
            _rendered({"base_color": TextureSlot(number)})


def test_wrong_textures_are_refused_with_a_sentence(tmp_path):
    with pytest.raises(VelourError, match="channel is 3; the picture has 3"):
        Texture.from_pixels(_picture(), channel=3)
    with pytest.raises(VelourError, match="wrap is 'tile'"):
        Texture.from_pixels(_picture(), wrap="tile")
    with pytest.raises(VelourError, match="nowhere") as caught:
        Texture.load(tmp_path / "nowhere.png")
    assert caught.value.status == Status.IO
