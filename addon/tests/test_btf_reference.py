"""velour render with a BTF itself as the material: what models of it are judged by."""

from __future__ import annotations

import numpy as np
import pytest
from command_line import refused, velour
from inputs import BTF_MODEL
from kept import captured
from velour.native import Btf, images

LIGHTS = 40


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("reference")


@pytest.fixture(scope="module")
def btf():
    return captured("corduroy", 12, 30, LIGHTS, 16, seed=1)


@pytest.fixture(scope="module")
def scene(folder):
    """Arguments of render: a plane of 90 x 90 tiles from above under an even sky of 1."""
    plane, sky = folder / "plane.obj", folder / "sky.exr"
    plane.write_text(
        "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nvt 0 0\nvt 90 0\nvt 90 90\nvt 0 90\n"
        "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
    )
    images.write(sky, np.ones((16, 32, 3), np.float32))
    camera = "0,0.001,10,0,0,0,10"
    return ["--mesh", plane, "--up", "z", "--world", sky, "--size", "32x32", "--camera", camera]


def mean_pixel(picture) -> np.ndarray:
    return images.read(picture)[..., :3].mean(axis=(0, 1))


def steepest_albedo(path) -> np.ndarray:
    """Albedo seen from the view nearest to the normal, as a sum over lights of equal solid angle."""
    with Btf.load(path) as btf:
        angles = btf.angles()
        view = int(angles[:, 2].argmin() // LIGHTS)
        f = btf.read(view * LIGHTS, LIGHTS).astype(np.float64).mean(axis=(1, 2))
    cosine = np.cos(np.radians(angles[:LIGHTS, 0]))
    return 2 * np.pi / LIGHTS * (f * cosine[:, None]).sum(axis=0)


def test_a_far_plane_reflects_the_albedo_of_the_btf(folder, btf, scene):
    picture = folder / "itself.exr"
    done = velour("render", *scene, "--material", btf, "--spp", 64, "-o", picture, "--quiet")
    assert done.status == 0, done.err
    np.testing.assert_allclose(mean_pixel(picture), steepest_albedo(btf), rtol=0.02)


def test_an_export_of_it_renders_alike(folder, btf, scene):
    """Pictures in another order of directions, read by another reader."""
    export, pictures = folder / "exported", [folder / "a.exr", folder / "b.exr"]
    assert velour("export", btf, "-o", export, "--quiet").status == 0
    for material, picture in zip((btf, export), pictures, strict=True):
        velour("render", *scene, "--material", material, "--spp", 8, "-o", picture, "--quiet")
    a, b = (images.read(picture) for picture in pictures)
    np.testing.assert_allclose(a, b, rtol=1e-4)


def test_what_numbers_mean_can_be_said(folder, btf, scene):
    """Pictures of albedo 1 / pi too bright: the same numbers taken as reflectances."""
    plain, scaled = folder / "plain.exr", folder / "scaled.exr"
    export = folder / "exported-again"
    assert velour("export", btf, "-o", export, "--quiet").status == 0
    velour("render", *scene, "--material", export, "--spp", 8, "-o", plain, "--quiet")
    velour(
        "render", *scene, "--material", export, "--values", "reflectance", "--spp", 8, "-o", scaled, "--quiet"
    )
    np.testing.assert_allclose(mean_pixel(plain) / mean_pixel(scaled), np.pi, rtol=1e-3)


def test_refusals(folder, btf, scene):
    output = folder / "refused.exr"
    sentence = refused("render", *scene, "--material", btf, "--memory", 1000, "-o", output)
    assert "memory" in sentence
    assert "limit" in sentence
    proposal = ["--proposal", BTF_MODEL]
    assert "--proposal" in refused("render", *scene, "--material", btf, *proposal, "-o", output)
    assert not output.exists()
