"""velour render --texture-scale, --texture-rotation, --texture-offset: a BTF placed on a mesh."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_line import refused, velour
from inputs import BTF_MODEL, write_octahedron
from velour.core.placement import texture_map
from velour.native import Scene, Status, VelourError, images

CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("placed")


def plane(path, uv_map=None):
    """Two metres wide; texture coordinates 0 to 1, taken through the map."""
    uvs = np.array([((x + 1) / 2, (y + 1) / 2, 1) for x, y in CORNERS])
    uvs = uvs[:, :2] if uv_map is None else uvs @ uv_map.T
    lines = [f"v {x} {y} 0" for x, y in CORNERS] + [f"vt {u:.9g} {v:.9g}" for u, v in uvs]
    path.write_text("\n".join([*lines, "f 1/1 2/2 3/3", "f 1/1 3/3 4/4", ""]))
    return path


def rendered(mesh, material, world, *options):
    path = mesh.with_suffix(".exr")
    done = velour(
        "render", "--mesh", mesh, "--up", "z", "--material", material, "--world", world, "--size", "32x32",
        "--spp", 64, "--camera", "0.3,-2,3,0,0,0,30", "-o", path, "--quiet", *options,
    )  # fmt: skip
    assert done.status == 0, done.err
    return images.read(path)[..., :3]


def test_a_placed_mesh_is_the_mesh_whose_coordinates_were_moved(folder, world_file):
    options = ["--texture-scale", "3,2", "--texture-rotation", 25, "--texture-offset", "0.2,-0.4"]
    placed = rendered(plane(folder / "placed.obj"), BTF_MODEL, world_file, *options)
    uv_map = texture_map((3, 2), np.radians(25), (0.2, -0.4))
    expected = rendered(plane(folder / "moved.obj", uv_map), BTF_MODEL, world_file)
    np.testing.assert_allclose(placed, expected, atol=2e-3 * expected.mean())
    plain = rendered(plane(folder / "plain.obj"), BTF_MODEL, world_file)
    assert np.abs(plain - expected).mean() > 0.05 * expected.mean()


def test_one_scale_is_of_both_axes(folder, world_file):
    mesh = plane(folder / "both.obj")
    one = rendered(mesh, BTF_MODEL, world_file, "--texture-scale", 3)
    assert (one == rendered(mesh, BTF_MODEL, world_file, "--texture-scale", "3,3")).all()


def test_a_material_without_texture_cannot_be_placed(folder, model_file, world_file):
    arguments = ["render", "--mesh", plane(folder / "brdf.obj"), "--material", model_file]
    arguments += ["--world", world_file, "-o", folder / "x.exr"]
    sentence = refused(*arguments, "--texture-scale", 2, "--texture-offset", "0,1")
    assert "paint.velour has no texture" in sentence
    assert "--texture-scale and --texture-offset" in sentence


def test_an_anisotropic_brdf_can_be_turned(folder, world_file):
    brushed = Path(__file__).parents[2] / "blend-tests/scenes/data/brushed.velour"
    turned = rendered(plane(folder / "turned.obj"), brushed, world_file, "--texture-rotation", 90)
    by_hand = plane(folder / "by-hand.obj", np.array(((0, 1, 0), (-1, 0, 0))))
    expected = rendered(by_hand, brushed, world_file)
    np.testing.assert_allclose(turned, expected, atol=5e-3 * expected.mean())
    plain = rendered(plane(folder / "plain.obj"), brushed, world_file)
    assert np.abs(plain - expected).mean() > 0.02 * expected.mean()
    arguments = ["render", "--mesh", by_hand, "--material", brushed, "--world", world_file]
    assert "has no texture" in refused(*arguments, "-o", folder / "x.exr", "--texture-scale", 2)


def test_a_mesh_without_coordinates_is_warned_of(folder, world_file):
    mesh = write_octahedron(folder / "octahedron.obj")
    done = velour(
        "render", "--mesh", mesh, "--material", BTF_MODEL, "--world", world_file, "--size", "8x8", "--spp", 8,
        "-o", folder / "x.exr",
    )  # fmt: skip
    assert done.status == 0
    assert "octahedron.obj has no texture coordinates" in done.err


@pytest.mark.parametrize("uv_map", [((0, 0, 0), (0, 1, 0)), ((1, 1, 0), (2, 2, 0))])
def test_placements_that_leave_no_width_are_refused(uv_map):
    with Scene() as scene:
        positions = np.array([[x, y, 0] for x, y in CORNERS], np.float32)
        mesh, _ = scene.add_mesh(positions, np.array([[0, 1, 2]], np.uint32))
        material = scene.add_principled_material()
        with pytest.raises(VelourError, match="scales the texture to zero") as caught:
            scene.add_instance(mesh, np.eye(4), [material], [uv_map])
        assert caught.value.status == Status.INVALID_ARGUMENT
        with pytest.raises(VelourError, match="6 numbers; 12 are needed"):
            scene.add_instance(mesh, np.eye(4), [material] * 2, [((1, 0, 0), (0, 1, 0))])
