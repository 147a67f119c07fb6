"""velour votf: a model gets the outline and the holes of a tile, and keeps them."""

from __future__ import annotations

import numpy as np
import pytest
from command_line import refused, velour
from kept import captured
from velour.native import Model, Scene, Tile, images, render_job, votf_job

_UNMOVED = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))


@pytest.fixture(scope="module")
def made(tmp_path_factory, model_file):
    """A model with the silhouette of a net, and the report of how it was made."""
    path = tmp_path_factory.mktemp("votf") / "net.velour"
    return path, velour("votf", "net", "--material", model_file, "--texels", 96, "-o", path, "--json").json


@pytest.fixture
def net(made):
    return made[0]


def test_the_report(made):
    _, report = made
    assert 0.3 < report["coverage"] < 0.8
    assert report["wrong"] < 0.01
    assert not report["closed"]
    assert report["warning_codes"] == []


def test_info_tells_of_it(net, model_file):
    shell = velour("info", net, "--json").json["shell"]
    assert shell["source"] == "net"
    assert shell["points"][:2] == [96, 96]
    assert shell["heights"][0] < 0 < shell["heights"][1]
    assert shell["bytes"] == np.prod(shell["points"])
    assert "shell" not in velour("info", model_file, "--json").json


def test_the_model_itself_stays(net, model_file):
    up = (0.0, 0.0, 1.0)
    wl = np.array([[0.6, 0, 0.8]], np.float32)
    with Model.load(net) as with_shell, Model.load(model_file) as without:
        np.testing.assert_array_equal(with_shell.eval(up, wl)[0], without.eval(up, wl)[0])


def _coverage(material: Model) -> float:
    """Mean alpha of a large square seen from far above."""
    with Scene() as scene:
        mesh, _ = scene.add_mesh(
            np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32),
            np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
            corner_uvs=np.array([[[0, 0], [9, 0], [9, 9]], [[0, 0], [9, 9], [0, 9]]], np.float32),
        )
        scene.add_instance(mesh, _UNMOVED, [scene.add_model_material(material)])
        scene.set_world_color((1, 1, 1))
        scene.look_at((0, 0, 50), (0, 1e-6, 0), 0.038, 1.0)
        scene.commit()
        with render_job(scene, width=64, height=64, spp=16, split=1, transparent=1) as job:
            job.run()
            return float(job.read_pass("Combined")[..., 3].mean())


def test_a_picture_shows_its_holes(net, model_file):
    with Tile.create("net") as tile:
        solid = 1 - tile.info()["open_area"]
    with Model.load(net) as with_shell, Model.load(model_file) as without:
        assert _coverage(with_shell) == pytest.approx(solid, abs=0.01)
        assert _coverage(without) == 1


def test_bits_do_not_depend_on_threads(model_file):
    with Scene() as scene, Model.load(model_file) as model, Tile.create("gravel") as tile:
        mesh, materials = tile.add_to(scene)
        scene.add_instance(mesh, _UNMOVED, materials)
        scene.commit()
        period, found = tile.info()["period"], []
        for threads in (1, 2):
            with votf_job(
                scene,
                model,
                texels=24,
                reference_height=0,
                origin=(0, 0),
                period=period,
                check_views=0,
                threads=threads,
            ) as job:
                report = job.run()
                found.append(job.result_model().bytes())
    assert found[0] == found[1]
    assert report["closed"]
    assert report["coverage"] is None


def test_what_is_wrong_is_said(model_file, tmp_path):
    out = tmp_path / "x.velour"
    for expected, arguments in {
        "none.velour": ("net", "--material", tmp_path / "none.velour"),
        "burlap": ("burlap", "--material", model_file),
        "--period": ("net", "--material", model_file, "--period", "1,1"),
    }.items():
        assert expected in refused("votf", *arguments, "-o", out)
    assert not out.exists()


@pytest.fixture(scope="module")
def captured_net():
    return captured("net", 96, 60, 1, 4)


def test_a_capture_tells_what_its_geometry_would(captured_net, made, model_file, tmp_path):
    found = velour("votf", captured_net, "--material", model_file, "-o", tmp_path / "x.velour", "--json").json
    _, known = made
    assert found["points"] == known["points"]
    assert not found["closed"]
    assert found["wrong"] < 0.06
    assert found["tile_width"] == known["tile_width"]
    assert found["heights"][0] == pytest.approx(-1 / 96)  # its lowest point lies on the surface
    with Tile.create("net") as tile:
        solid = 1 - tile.info()["open_area"]
    with Model.load(tmp_path / "x.velour") as model:
        assert _coverage(model) == pytest.approx(solid, abs=0.05)


def test_images_with_alpha_are_read_with_the_options_of_btfs(model_file, tmp_path):
    half = np.ones((8, 8, 4), np.float32)
    half[:, :4, 3] = 0
    folder, out = tmp_path / "set", tmp_path / "x.velour"
    folder.mkdir()
    for view in range(8):
        images.write(folder / f"{view:05d} tl000 pl000 tv030 pv{45 * view:03d}.exr", half)
    made = ["votf", folder, "--material", model_file, "--check-views", 0, "-o", out, "--json"]
    assert velour(*made).json["tile_width"] is None
    found = velour(*made, "--tile-size", "0.02,0.04").json
    assert found["tile_width"] == pytest.approx(0.02)
    assert found["points"][:2] == [8, 16]  # as fine along y


def test_of_a_btf_what_does_not_fit_is_refused(captured_net, model_file, tmp_path):
    out = tmp_path / "x.velour"
    velour("export", captured_net, "-o", tmp_path / "plain")
    for expected, arguments in {
        "alpha": (tmp_path / "plain",),
        "--period": (captured_net, "--period", "1,1"),
        "--seed": (captured_net, "--seed", "3"),
    }.items():
        assert expected in refused("votf", *arguments, "--material", model_file, "-o", out)
    assert not out.exists()
