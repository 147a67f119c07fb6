"""Placement of tiles as transforms of other programs, and values of glTF, without Blender."""

import math
from typing import NamedTuple

import pytest
from velour.core.approximation import UNFITTED
from velour.core.approximation_gltf import base_and_metallic, extensions
from velour.core.approximation_uv import affine, gltf_transform, nearest_step

POINTS = (0.0, 0.0), (1.0, 0.0), (0.3, 0.8)


class Placed(NamedTuple):
    offset: tuple = (0.0, 0.0)
    rotation: float = 0.0
    repeats: tuple = (1.0, 1.0)


def by_gltf(transform, u, v):
    """Texture coordinates, v upward, of KHR_texture_transform's matrices, whose v is downward."""
    angle, (x, y) = transform.get("rotation", 0), transform.get("scale", (1, 1))
    start_u, start_v = transform.get("offset", (0, 0))
    u, v = x * u, y * (1 - v)
    turned = math.cos(angle) * u + math.sin(angle) * v, math.cos(angle) * v - math.sin(angle) * u
    return turned[0] + start_u, 1 - (turned[1] + start_v)


@pytest.mark.parametrize(
    "placed",
    [
        Placed(repeats=(20.0, 20.0)),
        Placed(repeats=(1.5, 4.0), offset=(0.1, 0.2)),
        Placed(repeats=(1.5, 1.5), rotation=0.4, offset=(0.1, -0.2)),
        Placed(repeats=(2.0, 2.0), rotation=-2.8),
        Placed(repeats=(1.5, 4.0), rotation=math.pi / 2, offset=(0.3, 0.2)),
    ],
)
def test_gltf_places_tiles_as_they_are(placed):
    step, is_exact = nearest_step(placed)
    assert is_exact
    assert min(step.scale) > 0
    for u, v in POINTS:
        expected = [a * u + b * v + c for a, b, c in affine(placed)]
        assert by_gltf(gltf_transform(step), u, v) == pytest.approx(expected, abs=1e-9)


def test_tiles_that_would_be_sheared_keep_their_corner():
    placed = Placed((0.1, 0.2), 0.7, (1.5, 4.0))
    step, is_exact = nearest_step(placed)
    assert not is_exact
    assert by_gltf(gltf_transform(step), *placed.offset) == pytest.approx((0, 0), abs=1e-9)

    def error_of(degrees):
        turn = math.radians(degrees)
        (a, b, _), (c, d, _) = affine(placed)
        cos, sin = math.cos(turn), math.sin(turn)
        x, y = cos * a + sin * c, cos * d - sin * b
        return (cos * x - a) ** 2 + (sin * x - c) ** 2 + (-sin * y - b) ** 2 + (cos * y - d) ** 2

    assert error_of(step.degrees) <= min(map(error_of, range(-180, 180)))


def test_tiles_without_a_placement_need_no_transform():
    assert gltf_transform(nearest_step(Placed())[0]) == {}


def test_a_metal_over_a_diffuse_base_reflects_its_color():
    metal = {**UNFITTED.principled, "base_color": (0.03, 0.02, 0.02), "metallic": 1.0}
    assert base_and_metallic(metal, (0.5, 0.1, 0.1)) == ((0.5, 0.1, 0.1), 0.0)
    bright = {**metal, "base_color": (0.44, 0.44, 0.44)}
    base, metallic = base_and_metallic(bright, (0.2, 0.2, 0.2))
    assert base == pytest.approx((0.6, 0.6, 0.6))
    assert [metallic * base[0], (1 - metallic) * base[0]] == pytest.approx([0.4, 0.2])
    assert base_and_metallic(bright, (0.0, 0.0, 0.0)) == ((0.44, 0.44, 0.44), 1.0)


def test_coat_and_specular_reflection_are_extensions():
    none = 0.0, 0.0, 0.0
    assert extensions(UNFITTED.principled, none) == {}
    coated = {**UNFITTED.principled, "coat": 0.4, "coat_roughness": 0.1, "specular": 0.3}
    assert extensions(coated, none) == {
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.4, "clearcoatRoughnessFactor": 0.1},
        "KHR_materials_specular": {"specularFactor": 0.6, "specularColorFactor": [1.0, 1.0, 1.0]},
    }
    bright = {**UNFITTED.principled, "specular": 0.75, "specular_tint": (1.0, 0.5, 0.5)}
    assert extensions(bright, none)["KHR_materials_specular"] == {
        "specularFactor": 1.0,
        "specularColorFactor": [1.5, 0.75, 0.75],
    }
    assert extensions({**bright, "metallic": 1.0}, none) == extensions(bright, (0.5, 0.5, 0.5)) == {}
