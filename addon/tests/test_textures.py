"""Textures through the wrapper classes: planes whose pixels are known."""

from __future__ import annotations

import numpy as np
import planes
import pytest
from planes import SIDE
from velour.native import Scene, Status, Texture, TextureSlot, VelourError, images


def _picture():
    rows, columns = np.mgrid[0:SIDE, 0:SIDE].astype(np.float32) / SIDE
    return np.ascontiguousarray(np.stack([columns, rows, np.full_like(rows, 0.25)], axis=-1))


def _rendered(textures, **values):
    with Scene() as scene:
        material = scene.add_textured_material(textures, specular=0.0, **values)
        scene.add_instance(planes.add(scene), np.eye(4), [material])
        scene.set_world_color((1, 1, 1))
        return planes.seen(scene, spp=32)[..., :3]


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
    path = tmp_path / "gray.png"
    images.write(path, np.full((2, 2, 3), 0.5, np.float32))
    with Texture.load(path) as color, Texture.load(path, raw=1) as data:
        assert _rendered({"base_color": TextureSlot(color)})[3, 3, 0] == pytest.approx(0.5, abs=0.01)
        assert _rendered({"base_color": TextureSlot(data)})[3, 3, 0] == pytest.approx(0.735, abs=0.01)


def test_values_hold_where_no_texture_is():
    pixels = _rendered({}, base_color=(0.1, 0.2, 0.3))
    np.testing.assert_allclose(pixels.mean(axis=(0, 1)), (0.1, 0.2, 0.3), atol=1e-4)


def test_colors_and_numbers_are_not_mixed_up():
    with Texture.from_pixels(_picture()) as color, Texture.from_pixels(_picture(), channel=2) as number:
        with pytest.raises(VelourError, match="roughness requires a texture of numbers"):
            _rendered({"roughness": TextureSlot(color)})
        with pytest.raises(VelourError, match="base_color requires a texture of colors"):
            _rendered({"base_color": TextureSlot(number)})


def test_wrong_textures_are_refused_with_a_sentence(tmp_path):
    with pytest.raises(VelourError, match="channel is 3, but the image has 3"):
        Texture.from_pixels(_picture(), channel=3)
    with pytest.raises(VelourError, match="wrap is 'tile'"):
        Texture.from_pixels(_picture(), wrap="tile")
    with pytest.raises(VelourError, match="nowhere") as caught:
        Texture.load(tmp_path / "nowhere.png")
    assert caught.value.status == Status.IO


def _painted_plane(scene, *colors):
    """[4 x 3] colors of the corners of a square each: one set a color array."""
    vertices = np.arange(4, dtype=np.uint32)
    return planes.add(scene, corner_vertices=vertices, corner_colors=np.array(colors, np.float32))


def _painted(textures, *colors):
    with Scene() as scene:
        material = scene.add_textured_material(textures, specular=0.0)
        scene.add_instance(_painted_plane(scene, *colors), np.eye(4), [material])
        scene.set_world_color((1, 1, 1))
        pixels = planes.seen(scene, spp=256)[..., :3]
        assert scene.info()["untextured"] == 0
        return pixels


def test_a_mesh_shows_the_colors_of_its_corners():
    ramp = np.array([[0.1, 0, 0.5], [0.9, 0, 0.5], [0.9, 0.8, 0.5], [0.1, 0.8, 0.5]])
    places = (np.arange(SIDE) + 0.5) / SIDE
    expected = np.empty((SIDE, SIDE, 3))
    expected[..., 0], expected[..., 1], expected[..., 2] = 0.1 + 0.8 * places, 0.8 * places[:, None], 0.5
    with Texture.of_corners(1) as texture:
        pixels = _painted({"base_color": TextureSlot(texture)}, np.zeros((4, 3)), ramp)
        np.testing.assert_allclose(pixels, expected, atol=5e-3)
        missing = _painted({"base_color": TextureSlot(texture)}, ramp)
    np.testing.assert_array_equal(missing, 0)


def test_numbers_are_the_first_channel_of_corners():
    open_or_not = np.array([[1, 0, 0], [0, 1, 1], [0, 1, 1], [1, 0, 0]])
    white = np.ones((4, 3))
    with Texture.of_corners(0) as alpha, Texture.of_corners(1) as color:
        slots = {"alpha": TextureSlot(alpha), "base_color": TextureSlot(color)}
        pixels = _painted(slots, open_or_not, 0 * white)
    expected = (np.arange(SIDE) + 0.5) / SIDE  # of the white sky behind
    np.testing.assert_allclose(pixels.mean(axis=(0, 2)), expected, atol=0.1)


def test_sets_of_corner_colors_are_few_and_whole():
    with pytest.raises(VelourError, match="no corner color set 4"):
        Texture.of_corners(4)
    with Scene() as scene:
        with pytest.raises(VelourError, match="color_sets is 5"):
            _painted_plane(scene, *[np.zeros((4, 3))] * 5)
        with pytest.raises(VelourError, match="corner_colors"):
            scene.add_mesh(
                np.eye(3, dtype=np.float32),
                np.array([[0, 1, 2]], np.uint32),
                corner_colors=np.zeros((1, 2, 3), np.float32),
            )
