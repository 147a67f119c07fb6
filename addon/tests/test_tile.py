"""Procedural tiles through the wrapper and the command line."""

from __future__ import annotations

import numpy as np
import pytest
from command_line import refused, velour
from velour.native import Scene, Tile, VelourError, render_job

NAMES = [
    "weave",
    "twill",
    "net",
    "chainmail",
    "gravel",
    "corduroy",
    "satin",
    "knit",
    "velvet",
    "leather",
    "denim",
]


def test_kinds_with_their_defaults():
    kinds = Tile.kinds()
    assert [kind["name"] for kind in kinds] == NAMES
    for kind in kinds:
        assert kind["defaults"]["size"] > 0
        assert kind["summary"]
    taken = {kind["name"]: set(kind["defaults"]) for kind in kinds}
    assert taken["weave"] - taken["gravel"] == {"gap"}
    assert taken["weave"] - taken["chainmail"] == {"gap", "irregularity"}


@pytest.mark.parametrize("kind", NAMES)
def test_arrays_and_info_agree(kind):
    with Tile.create(kind, size=0.1, seed=3) as tile:
        info, mesh = tile.info(), tile.mesh()
    assert info["period"] == pytest.approx([0.1, 0.1])
    assert info["shape"]["seed"] == 3
    assert (len(mesh.positions), len(mesh.triangles)) == (info["vertices"], info["triangles"])
    assert mesh.corner_normals.shape == (info["triangles"], 3, 3)
    assert mesh.corner_uvs.shape == (info["triangles"], 3, 2)
    assert mesh.material_slots.max() + 1 == len(info["materials"])
    assert [mesh.positions[:, 2].min(), mesh.positions[:, 2].max()] == pytest.approx(info["heights"])


def test_arrays_outlive_the_handle():
    with Tile.create("net") as tile:
        mesh = tile.mesh()
    assert np.isfinite(mesh.positions).all()


def test_renders():
    with Scene() as scene, Tile.create("gravel", count=3, resolution=8) as tile:
        mesh, materials = tile.add_to(scene)
        scene.add_instance(mesh, np.eye(4), materials)
        scene.set_world_color((1, 1, 1))
        scene.look_at((0.01, 0.01, 0.05), (0.01, 0.0101, 0), 0.3, 1.0)
        scene.commit()
        with render_job(scene, width=8, height=8, spp=16) as job:
            job.run()
            pixels = job.read_pass("Combined")
    assert (pixels[..., 3] == 1).all()
    assert 0.01 < pixels[..., :3].mean() < 0.5


@pytest.mark.parametrize(
    ("kind", "shape", "word"),
    [("felt", {}, "felt"), ("weave", {"count": 3}, "count"), ("gravel", {"gap": 0.2}, "gap")],
)
def test_refusals(kind, shape, word):
    with pytest.raises(VelourError, match=word):
        Tile.create(kind, **shape)


def test_unknown_parameters_are_named():
    with pytest.raises(TypeError, match="ply"):
        Tile.create("weave", ply=3)


def test_command_line_writes_what_the_library_reads(tmp_path):
    path = tmp_path / "cloth.obj"
    report = velour("tile", "twill", "-o", path, "--size", 0.004, "--count", 8, "--json").json
    assert (report["kind"], report["shape"]["count"]) == ("twill", 8)
    with Scene() as scene:
        scene.load_mesh(path)
        scene.set_world_color((0, 0, 0))
        scene.add_instance(0, np.eye(4), [scene.add_principled_material()])
        scene.commit()
        assert scene.info()["triangles"] == report["triangles"]
    text = path.read_text()
    assert "mtllib cloth.mtl" in text
    assert text.count("usemtl") == 2
    assert (tmp_path / "cloth.mtl").read_text().startswith("newmtl warp\nKd 0.02 ")


def test_command_line_refuses(tmp_path):
    assert "felt" in refused("tile", "felt", "-o", tmp_path / "x.obj")
    assert "gap" in refused("tile", "gravel", "--gap", 0.5, "-o", tmp_path / "x.obj")
    assert list(tmp_path.iterdir()) == []
