"""Measured BTFs through the library and the command line."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from command_line import refused, velour
from velour.native import Btf, VelourError, export_btf_job, images

INFO_KEYS = [
    "kind", "format", "name", "path", "description", "sha256", "bytes", "raw_bytes", "texels", "views",
    "lights", "pairs", "complete", "largest_theta", "tile_metres", "shell", "errors", "structure", "entries",
    "details", "warnings", "warning_codes",
]  # fmt: skip
LIGHTS = [(0, 0), (15, 0), (60, 90)]
VIEWS = [(0, 0), (45, 180)]


def picture(light: int, view: int) -> np.ndarray:
    """4 x 2 pixels, of every pair its own; linear."""
    ramp = np.linspace(0.1, 0.8, 8, dtype=np.float32).reshape(2, 4, 1)
    return np.repeat(ramp / (1 + light + 3 * view), 3, axis=2)


def write_set(folder, extension: str, angle=lambda degrees: f"{degrees:03d}"):
    folder.mkdir()
    for v, view in enumerate(VIEWS):
        for i, light in enumerate(LIGHTS):
            (tl, pl), (tv, pv) = map(lambda d: tuple(map(angle, d)), (light, view))
            name = f"{i * len(VIEWS) + v:05d} tl{tl} pl{pl} tv{tv} pv{pv}{extension}"
            images.write(folder / name, picture(i, v))
    return folder


@pytest.fixture
def named_set(tmp_path):
    return write_set(tmp_path / "wool", ".exr")


def expected_f(light: int, view: int) -> np.ndarray:
    return picture(light, view) / (np.pi * np.cos(np.radians(LIGHTS[light][0])))


def test_info_of_named_pictures(named_set):
    report = velour("info", named_set, "--json").json
    assert list(report) == INFO_KEYS
    assert (report["kind"], report["format"], report["name"]) == ("btf", "ubo2003", "wool")
    assert report["texels"] == [4, 2]
    assert (report["views"], report["lights"], report["pairs"], report["complete"]) == (2, 3, 6, True)
    assert report["raw_bytes"] == 6 * 8 * 3 * 2
    assert report["largest_theta"] == {"view": 45, "light": 60}
    assert report["tile_metres"] is None
    assert report["entries"] == {"pairs": 6, "values": 6 * 24, "not_finite": 0, "negative": 0}
    assert report["details"]["values"] == "f = number / (pi cos(theta_l))"


def test_options_say_what_numbers_mean(named_set):
    report = velour(
        "info", named_set, "--values", "reflectance", "--gamma", "2.2", "--tile-size", "0.02,0.01", "--json"
    ).json
    assert report["details"]["values"] == "f = number / pi"
    assert report["tile_metres"] == pytest.approx([0.02, 0.01])
    assert velour("info", named_set, "--gamma", "99").status == 2
    assert velour("info", named_set, "--tile-size", "1").status == 2


def test_fits_and_comparisons_read_all_btfs_with_the_options(named_set, tmp_path):
    """Radiance is divided by the cosine of the light, reflectance is not."""
    model, reflectance = tmp_path / "wool.velour", ["--values", "reflectance"]
    fit = ["compress", named_set, "-o", model, "--method", "svd", *reflectance, "--held-out", named_set]
    report = velour(*fit, "--json").json
    assert report["psnr_held_out"] == pytest.approx(report["psnr"])
    found = velour("compare", named_set, model, *reflectance, "--json").json
    assert found["psnr"] == pytest.approx(report["psnr"])
    assert velour("compare", named_set, model, "--json").json["psnr"] < report["psnr"] - 10
    assert velour("compare", named_set, named_set, *reflectance, "--json").json["ser"] < 1e-9


@pytest.mark.parametrize("verb", ["compare", "tile", "mesh", "export", "render"])
def test_options_of_btfs_are_refused_by_name_for_what_is_no_btf(
    verb, measurement_file, model_file, mesh_file, world_file, tmp_path
):
    out = tmp_path / ("x.mtlx" if verb == "export" else "x.exr" if verb == "render" else "x.velour")
    silhouette = ["--material", model_file, "--texels", 8, "--check-views", 0]
    name, *words = {
        "compare": [measurement_file, "compare", measurement_file, model_file],
        "tile": ["net", "votf", "net", *silhouette],
        "mesh": [mesh_file, "votf", mesh_file, *silhouette],
        "export": [model_file, "export", model_file, "--to", "openpbr"],
        "render": [model_file, "render", "--mesh", mesh_file, "--material", model_file, "--world", world_file,
                   "--size", "8x8", "--spp", 1],
    }[verb]  # fmt: skip
    words += [] if verb == "compare" else ["-o", out]
    layer = "--btf-layer" if verb == "render" else "--layer"
    for option, value in {"--tile-size": "1,1", "--values": "brdf", layer: "a", "--gamma": "srgb"}.items():
        assert f"{name} is not a BTF; leave out {option}." in refused(*words, option, value)
    both = refused(*words, "--tile-size", "1,1", "--angles", "degrees")
    assert "--tile-size and --angles" in both or "--angles and --tile-size" in both
    assert not out.exists()
    assert velour(*words).status == 0


@pytest.mark.parametrize("extension", [".exr", ".png"])
def test_pictures_become_brdfs(tmp_path, extension):
    with Btf.load(write_set(tmp_path / "set", extension)) as btf:
        angles = btf.angles()
        assert angles[4].tolist() == [15, 0, 45, 180]
        f = btf.read(0, 6).astype(np.float64)
    tolerance = 1e-3 if extension == ".exr" else 0.05  # 8 bits of a dark picture
    for pair in range(6):
        assert f[pair] == pytest.approx(expected_f(pair % 3, pair // 3), rel=tolerance)


@pytest.mark.parametrize("whole", [True, False])
def test_exports_come_back_bit_for_bit(tmp_path, whole):
    source = write_set(tmp_path / "set", ".exr", str if whole else lambda degrees: f"{degrees + 0.5}")
    report = velour("export", source, "-o", tmp_path / "out", "--tile-size", "0.1,0.3", "--json").json
    assert report["format"] == ("ubo2003" if whole else "csv")
    assert (tmp_path / "out/btf.csv").exists() != whole
    assert report["pictures"] == 6
    assert report["bytes"] == sum(file.stat().st_size for file in (tmp_path / "out").iterdir())
    with Btf.load(source) as before, Btf.load(tmp_path / "out") as after:
        assert after.info()["tile_metres"] == pytest.approx([0.1, 0.3])
        assert (before.angles() == after.angles()).all()
        assert (before.read(0, 6).view(np.uint16) == after.read(0, 6).view(np.uint16)).all()


def test_csv_indices(tmp_path):
    images.write(tmp_path / "a.exr", picture(0, 0))
    images.write(tmp_path / "b.exr", picture(1, 0))
    index = tmp_path / "index.csv"
    index.write_text("# mine\nphi_v,theta_v,phi_l,theta_l,file\n0,0,0,60,a.exr\n0,10,0,30,b.exr\n")
    report = velour("info", index, "--json").json
    assert (report["format"], report["pairs"], report["complete"]) == ("csv", 2, False)
    index.write_text("file,theta_l\na.exr,3\n")
    assert "no column 'phi_l'" in refused("info", index)
    index.write_text("file,theta_l,phi_l,theta_v,phi_v\nmissing.exr,1,2,3,4\n")
    assert "missing.exr: cannot read: No such file" in refused("info", index)


def test_damaged_sets_are_one_sentence(named_set):
    images.write(named_set / "00009 tl075 pl000 tv000 pv000.exr", picture(0, 0))
    assert "1 of 8 images are missing, the first is 'tl075 pl000 tv045 pv180'" in refused("info", named_set)
    images.write(named_set / "00010 tl075 pl000 tv045 pv180.exr", picture(0, 0)[:1])
    assert "All images of the set must have the same size" in refused("info", named_set)
    images.write(named_set / "preview.png", picture(0, 0))
    assert "preview.png: the file name does not contain the angles" in refused("info", named_set)


def bonn_file(width=2, height=1) -> bytes:
    """Two views, one light, one component a channel; the layout of docs/reference/btf_formats.md."""
    description = struct.pack("<I80s80s80sf3fI", 2, b"dome", b"camera", b"lamp", 4.0, 1, 1, 1, 0)
    sampling = struct.pack("<I", 2)
    for theta in (0.0, 0.5):
        sampling += struct.pack("<2fI2f", theta, 0, 1, 0.25, 0)
    head = struct.pack("<10sI", b"!DFMF08FCR", len(description) + 4) + description + sampling
    head += struct.pack("<3I", width, height, 0) + struct.pack("<Ii12f", 1, 0, *[0.0] * 12)
    for channel in range(3):
        head += struct.pack("<B3I", 2, 1, 2, width * height) + np.float16(1).tobytes()
        head += np.array([1, 2], np.float16).tobytes()
        head += np.full(width * height, 0.25 + channel, np.float16).tobytes()
    return head


def test_files_of_bonn(tmp_path):
    path = tmp_path / "felt.btf"
    path.write_bytes(bonn_file())
    report = velour("info", path, "--json").json
    assert (report["format"], report["description"], report["pairs"]) == ("ubo2014", "dome", 2)
    assert report["tile_metres"] == pytest.approx([0.0005, 0.00025])
    assert report["details"]["compression_error"].startswith("unknown")
    with Btf.load(path) as btf:
        assert btf.read(1)[0, 0, 0].tolist() == [0.5, 2.5, 4.5]
    path.write_bytes(bonn_file()[:-3])
    assert "is truncated or damaged" in refused("info", path)


def test_misuse(named_set, tmp_path):
    with Btf.load(named_set) as btf:
        with pytest.raises(VelourError, match="out of range"):
            btf.read(6)
        with pytest.raises(VelourError, match="is not empty"):
            export_btf_job(btf, named_set).run()
        job = export_btf_job(btf, tmp_path / "new")
    assert job.run()["pictures"] == 6  # the job keeps what it needs
    with pytest.raises(VelourError, match="values is 'light'"):
        Btf.load(named_set, values="light")
    assert "No such file" in refused("info", tmp_path / "none")
    (tmp_path / "empty").mkdir()
    assert "contains neither images" in refused("export", tmp_path / "empty", "-o", tmp_path / "x")
