"""Mixed materials through the wrapper classes: planes whose pixels are known."""

from __future__ import annotations

import numpy as np
import planes
import pytest
from planes import SIDE
from velour.native import Model, Scene, Shader, Texture, TextureSlot, VelourError


def _rendered(shader, transparent=False):
    with Scene() as scene:
        scene.add_instance(planes.add(scene), np.eye(4), [scene.add_shader_material(shader)])
        scene.set_world_color((1, 1, 1))
        return planes.seen(scene, spp=256, transparent=int(transparent))


def _diffuse(shader, color):
    shader.add_layer("diffuse", base_color=color, roughness=0.0)


def test_layers_are_summed_by_their_weights():
    with Shader.new() as shader:
        _diffuse(shader, (1, 0, 0))
        shader.weigh_layer("share", 0.25)
        _diffuse(shader, (0, 1, 0))
        shader.weigh_layer("rest", 0.25)
        shader.add_layer("emission", base_color=(0, 0, 3))
        shader.weigh_layer("gain", 2.0)
        shader.weigh_layer("share", 0.5)
        pixels = _rendered(shader)
    np.testing.assert_allclose(pixels.mean(axis=(0, 1)), (0.25, 0.75, 3, 1), atol=2e-3)


def test_images_cut_out():
    mask = np.indices((SIDE, SIDE)).sum(axis=0)[..., None].astype(np.float32) % 2
    with Shader.new() as shader, Texture.from_pixels(mask, channel=0, filter="closest") as texture:
        _diffuse(shader, (1, 0.5, 0))
        shader.weigh_layer("share", texture=texture)
        shader.add_layer("transparent", base_color=(1, 1, 1))
        shader.weigh_layer("rest", texture=texture)
        pixels = _rendered(shader, transparent=True)
    np.testing.assert_array_equal(pixels[..., 3], mask[..., 0])
    np.testing.assert_allclose(pixels[..., :2], mask * (1, 0.5), atol=1e-3)


def test_panes_have_colors_by_images():
    colors = np.random.default_rng(1).uniform(0.1, 0.9, (SIDE, SIDE, 3)).astype(np.float32)
    with Shader.new() as shader, Texture.from_pixels(colors, filter="closest") as texture:
        shader.add_layer("transparent", {"base_color": TextureSlot(texture)})
        pixels = _rendered(shader)
    np.testing.assert_allclose(pixels[..., :3], colors, atol=1e-5)


def test_half_emission_mixed_into_a_model_gives_the_mean_of_both_pictures(model_file):
    with Model.load(model_file) as model, Shader.new() as alone, Shader.new() as mixed:
        alone.add_measured_layer(model)
        mixed.add_measured_layer(model)
        mixed.weigh_layer("rest", 0.5)
        mixed.add_layer("emission", base_color=(0, 1, 3))
        mixed.weigh_layer("share", 0.5)
        reflected, both = _rendered(alone)[..., :3], _rendered(mixed)[..., :3]
    assert reflected.mean() > 0.01
    np.testing.assert_allclose(both, 0.5 * np.add(reflected, (0, 1, 3)), rtol=1e-4, atol=1e-5)


def test_tints_are_colors_or_images(model_file):
    colors = np.random.default_rng(1).uniform(0.1, 0.9, (SIDE, SIDE, 3)).astype(np.float32)
    with (
        Model.load(model_file) as model,
        Shader.new() as plain,
        Shader.new() as tinted,
        Texture.from_pixels(colors, filter="closest") as texture,
    ):
        plain.add_measured_layer(model)
        tinted.add_measured_layer(model)
        tinted.weigh_layer("tint", texture=texture)
        tinted.weigh_layer("tint", (1, 0.5, 0))
        expected = _rendered(plain)[..., :3] * colors * (1, 0.5, 0)
        np.testing.assert_allclose(_rendered(tinted)[..., :3], expected, rtol=1e-4, atol=1e-5)


def test_wrong_calls_are_refused_with_a_sentence():
    with Shader.new() as shader:
        with pytest.raises(VelourError, match="add a layer before"):
            shader.weigh_layer("share", 0.5)
        with pytest.raises(VelourError, match="kind is 'toon'"):
            shader.add_layer("toon")
        shader.add_layer("glossy", roughness=0.2)
        with pytest.raises(VelourError, match="not finite"):
            shader.weigh_layer("gain", float("nan"))
        with pytest.raises(VelourError, match="needs one of"):
            shader.add_measured_layer()
        color = Texture.from_pixels(np.ones((2, 2, 3), np.float32))
        with pytest.raises(VelourError, match=r"vlr_factor_desc\.texture requires a texture of numbers"):
            shader.weigh_layer("share", texture=color)
        color.close()


def _floor_under_glow(strategy, drawn):
    """Mean of a floor under a square that glows, and the scene's warnings."""
    with Scene() as scene:
        mesh = planes.add(scene)
        scene.add_instance(
            mesh, np.eye(4), [scene.add_principled_material(base_color=(0.5,) * 3, specular=0)]
        )
        glow = scene.add_principled_material(base_color=(0,) * 3, specular=0, emission=(2, 2, 2))
        if not drawn:
            scene.set_drawn_to(glow, False)
        above = np.eye(4)
        above[2, 3] = 1
        scene.add_instance(mesh, above, [glow], hidden=["camera"])
        pixels = planes.seen(scene, 0.01, spp=4096, strategy=strategy)
        return pixels[..., :3].mean(), scene.info()["warning_codes"]


def test_what_glows_lights_without_bounces():
    # A unit square's view factor from a metre below its middle: 4 pieces of a corner's.
    side = np.sqrt(2)
    factor = 4 * (2 / side * np.arctan(1 / side)) / (2 * np.pi)
    for strategy, drawn in (("mis", True), ("mis", False), ("light", True), ("cosine", True)):
        mean, warnings = _floor_under_glow(strategy, drawn)
        assert abs(mean - 0.5 * 2 * factor) < 0.01, (strategy, drawn)
        assert warnings == []
    assert _floor_under_glow("light", False)[0] == 0.0
