"""Every verb end to end: keys, files, forms of the report."""

from __future__ import annotations

import json

import numpy as np
import pytest
from command_line import program, velour
from velour.native import Model, VelourError, images, library, table

FIT_KEYS = [
    "lobes",
    "bytes",
    "parameter_bytes",
    "seconds",
    "relative_l2",
    "by_view_angle",
    "albedo_max",
    "reciprocity",
    "measured_reciprocity",
    "verdict",
    "warnings",
    "warning_codes",
    "order",
    "view_range",
]
ORDER_KEYS = ["lobes", "parameter_bytes", "worst", "relative_l2", "chosen"]
COMPARE_KEYS = [
    "relative_l2",
    "by_view_angle",
    "standard_error",
    "standard_error_by_view_angle",
    "log_rms",
    "noise_by_view_angle",
    "samples",
]
RENDER_KEYS = [
    "seconds",
    "rays",
    "samples_per_second",
    "ray_share",
    "stages",
    "rmse",
    "relmse",
    "nan_samples",
    "noise",
    "spp_mean",
    "block_noise",
    "blocks_unfinished",
    "biased_by",
    "denoised",
    "sky",
    "pilot",
    "out_of_domain",
    "samples",
    "memory",
]
OBSERVE_KEYS = [
    "seconds",
    "frames",
    "camera_rays",
    "hits",
    "weight",
    "share",
    "views",
    "light_density",
    "hash",
]
ANGLES = ["5", "30", "60", "75", "85"]


@pytest.fixture
def render_arguments(mesh_file, world_file, model_file, tmp_path):
    return [
        "render", "--mesh", mesh_file, "--material", model_file, "--world", world_file, "--size", "32x24",
        "--spp", "8", "--threads", "2", "-o", tmp_path / "out.exr", "--json",
        "--cache", tmp_path / "cache",
    ]  # fmt: skip


@pytest.fixture
def observe_arguments(mesh_file, world_file, model_file, tmp_path):
    return [
        "observe", "--mesh", mesh_file, "--material", model_file, "--world", world_file, "--size", "32x24",
        "--threads", "2", "-o", tmp_path / "scene.json", "--json",
    ]  # fmt: skip


def test_info_of_a_measurement(measurement_file):
    report = velour("info", measurement_file, "--json").json
    assert report["kind"] == "measurement"
    assert report["format"] == "merl"
    assert report["isotropic"] is True
    entries = report["entries"]
    parts = {"valid", "negative", "not_finite", "below_horizon", "spikes"}
    assert set(entries) == {"total", "out_of_gamut", *parts}
    assert entries["total"] == sum(entries[part] for part in parts)


def test_info_of_a_model(model_file):
    result = program("info", model_file, "--json")
    assert result == velour("info", model_file, "--json")
    report = result.json
    assert report["kind"] == "model"
    assert report["bytes"] == model_file.stat().st_size
    assert report["source"]["name"] == "paint"


def test_info_for_people(model_file):
    status, out, err = velour("info", model_file)
    assert (status, err) == (0, "")
    assert "warning: The model exceeds " in out or "fitted views exceed " in out
    assert "by_view_angle:\n  5: 0." in out


def test_fit_and_compare(measurement_file, tmp_path):
    path = tmp_path / "paint.velour"
    result = program("fit", measurement_file, "-o", path, "--max-lobes", 3, "--seed", 7, "--json", "--quiet")
    assert (result.status, result.err) == (0, "")
    assert list(result.json) == FIT_KEYS
    assert list(result.json["by_view_angle"]) == ANGLES
    assert result.json["bytes"] == path.stat().st_size
    report = velour("compare", measurement_file, path, "--json").json
    assert list(report) == [*COMPARE_KEYS, "verdict"]
    assert list(report["by_view_angle"]) == list(report["noise_by_view_angle"]) == ANGLES
    assert report["relative_l2"] == pytest.approx(result.json["relative_l2"], rel=0.05)


def test_compare_with_the_best_ggx_lobe(measurement_file):
    report = velour("compare", measurement_file, "--ggx", "--json").json
    assert list(report) == [*COMPARE_KEYS, "seconds", "parameter_bytes", "ggx"]
    assert list(report["ggx"]) == ["alpha", "f0", "f90", "diffuse"]
    assert 0 < report["ggx"]["alpha"][0] == report["ggx"]["alpha"][1] < 2
    assert 0 < report["relative_l2"] < 1


def test_compare_with_the_closest_principled_material(measurement_file):
    report = velour("compare", measurement_file, "--principled", "--json").json
    assert list(report) == [*COMPARE_KEYS, "seconds", "parameter_bytes", "principled"]
    found = report["principled"]
    colors = [*found.pop("base_color"), *found.pop("specular_tint")]
    assert list(found) == ["metallic", "roughness", "specular", "coat", "coat_roughness"]
    assert all(0 <= value <= 1 for value in [*colors, *found.values()])
    assert 0 < report["relative_l2"] < 1


def test_fit_options_reach_the_model(measurement_file, tmp_path):
    path = tmp_path / "m.velour"
    options = ["--model", "scattered", "--kernel", "abel-poisson", "--max-lobes", 1, "--tolerance", 0.5]
    assert velour("fit", measurement_file, "-o", path, *options, "--all-data", "--seed", 9).status == 0
    with Model.load(path) as model:
        info = model.info()
    assert info["kernel"] == "abel-poisson"
    assert info["max_lobes_per_view"] == 1
    assert (info["tolerance"], info["all_data"], info["seed"]) == (0.5, True, 9)


@pytest.mark.parametrize("switch", [(), ("--symmetric",)])
def test_a_symmetric_fit_makes_a_symmetric_model(measurement_file, tmp_path, switch):
    path = tmp_path / "m.velour"
    assert velour("fit", measurement_file, "-o", path, "--max-lobes", 1, *switch).status == 0
    with Model.load(path) as model:
        assert model.info()["symmetric"] == bool(switch)


@pytest.mark.parametrize("kind", table.MODELS)
def test_a_fit_reports_its_error_against_lobes(measurement_file, tmp_path, kind):
    path = tmp_path / "m.velour"
    report = velour("fit", measurement_file, "-o", path, "--model", kind, "--max-lobes", 5, "--json").json
    order = report["order"]
    assert list(order) == ORDER_KEYS
    columns = [order[key] for key in ORDER_KEYS[:-1]]
    assert len(columns[0]) > 1
    assert {len(column) for column in columns} == {len(columns[0])}
    assert order["lobes"] == sorted(order["lobes"])
    assert order["parameter_bytes"][order["chosen"]] == report["parameter_bytes"]
    info = velour("info", path, "--json").json
    expected = "parametric" if kind == "auto" else kind
    assert (info["model"], info["order"]) == (expected, order)


def test_parametric_models_have_gaussian_lobes_only(measurement_file, tmp_path):
    path = tmp_path / "m.velour"
    arguments = ["fit", measurement_file, "-o", path, "--model", "parametric", "--kernel", "abel-poisson"]
    result = velour(*arguments)
    assert result.status == 1
    assert "Gaussian" in result.err
    assert not path.exists()


def test_views_that_miss_the_tolerance_are_warned_of_on_stderr(measurement_file, tmp_path):
    result = velour(
        "fit", measurement_file, "-o", tmp_path / "m.velour", "--max-lobes", 1, "--tolerance", 1e-4, "--json"
    )
    assert result.json["warnings"]
    assert all(warning in result.err for warning in result.json["warnings"])
    first = result.json["warning_codes"][0]
    assert first["code"] == "views_exceed_tolerance"
    assert first["values"]["tolerance"] == 1e-4
    assert "--max-lobes" in result.json["warnings"][0]


def test_render(render_arguments, tmp_path):
    result = program(*render_arguments, "--quiet")
    assert (result.status, result.err) == (0, "")
    assert list(result.json) == RENDER_KEYS
    assert result.json["rmse"] is None
    assert result.json["nan_samples"] == 0
    assert result.json["samples_per_second"] == pytest.approx(32 * 24 * 8 / result.json["seconds"], rel=0.01)
    picture = images.read(tmp_path / "out.exr")
    assert picture.shape == (24, 32, 4)
    assert picture[12, 16, :3].min() > 0


def test_render_against_a_reference(render_arguments, tmp_path):
    assert velour(*render_arguments).status == 0
    (tmp_path / "out.exr").rename(tmp_path / "reference.exr")
    report = velour(*render_arguments, "--reference", tmp_path / "reference.exr").json
    assert report["rmse"] == report["relmse"] == 0  # the same seed, the same bits
    report = velour(*render_arguments, "--reference", tmp_path / "reference.exr", "--seed", 1).json
    assert report["rmse"] > 0


def test_pictures_do_not_depend_on_threads(render_arguments, tmp_path):
    pictures = []
    for threads in (1, 2):
        assert velour(*render_arguments, "--threads", threads).status == 0
        pictures.append(images.read(tmp_path / "out.exr"))
    np.testing.assert_array_equal(*pictures)


def test_product_reports_the_mixture_of_the_world_and_keeps_it(render_arguments, tmp_path):
    arguments = [*render_arguments, "--strategy", "product"]
    first, second = velour(*arguments).json["sky"], velour(*arguments).json["sky"]
    assert first["lobes"] > 0
    assert (first["cached"], second["cached"]) == (False, True)
    assert first["relative_l2"] == second["relative_l2"]
    for kept in (tmp_path / "cache").iterdir():
        kept.write_bytes(b"not a mixture")
    assert not velour(*arguments).json["sky"]["cached"]
    assert not velour(*arguments, "--no-cache").json["sky"]["cached"]


@pytest.mark.parametrize("strategy", table.STRATEGIES)
def test_every_strategy_gives_the_same_picture_within_noise(render_arguments, tmp_path, strategy):
    assert velour(*render_arguments, "--strategy", strategy, "--spp", 64).status == 0
    mean = images.read(tmp_path / "out.exr")[..., :3].mean()
    assert velour(*render_arguments, "--strategy", "mis", "--spp", 256).status == 0
    assert mean == pytest.approx(images.read(tmp_path / "out.exr")[..., :3].mean(), rel=0.1)


@pytest.mark.parametrize(
    "options",
    [("--sequence", "random"), ("--heuristic", "power"), ("--share", 0.2), ("--share", 0.9, "--split", 3)],
)
def test_sequence_share_and_heuristic_change_the_noise_alone(render_arguments, tmp_path, options):
    pictures = []
    for more in ((), options):
        assert velour(*render_arguments, "--spp", 256, *more).status == 0
        pictures.append(images.read(tmp_path / "out.exr")[..., :3])
    assert not np.array_equal(*pictures)
    assert pictures[0].mean() == pytest.approx(pictures[1].mean(), rel=0.02)


def test_clamping_darkens_the_picture_and_says_so(render_arguments, tmp_path):
    assert velour(*render_arguments).json["biased_by"] == []
    mean = images.read(tmp_path / "out.exr")[..., :3].mean()
    options = ("--clamp-direct", 0.05, "--filter-glossy", 1, "--no-reflective-caustics")
    result = velour(*render_arguments, *options, "--log-level", "info")
    assert result.json["biased_by"] == ["clamp_direct", "filter_glossy", "reflective_caustics"]
    assert "biased by clamp_direct, filter_glossy, reflective_caustics" in result.err
    assert images.read(tmp_path / "out.exr")[..., :3].mean() < 0.9 * mean


def test_a_noise_target_ends_the_render(render_arguments):
    at = render_arguments.index("--spp")
    arguments = render_arguments[:at] + render_arguments[at + 2 :]
    report = velour(*arguments, "--noise", 0.05).json
    assert report["blocks_unfinished"] == 0
    assert 0 < report["block_noise"] <= 0.05
    assert 128 <= report["spp_mean"] < 65536
    result = velour(*arguments, "--noise", 0.0001, "--spp", 128)
    assert result.json["blocks_unfinished"] > 0
    assert "miss the noise target" in result.err


@pytest.fixture
def denoiser():
    try:
        library.denoiser()
    except VelourError as error:
        pytest.skip(str(error))


def test_a_denoised_picture_is_closer_to_the_truth_and_says_how_close(render_arguments, tmp_path, denoiser):
    reference, noisy = tmp_path / "reference.exr", tmp_path / "noisy.exr"
    at = render_arguments.index("--spp")
    arguments = [*render_arguments[:at], *render_arguments[at + 2 :], "--split", 1]
    assert velour(*arguments, "--spp", 4096, "--seed", 9, "-o", reference).status == 0
    few = (*arguments, "--spp", 8, "--reference", reference)
    result = velour(*few, "--denoise", "--noisy-image", noisy, "--log-level", "info")
    denoised = result.json["denoised"]
    assert result.json["relmse"] < 0.5 * images.compare(images.read(noisy), images.read(reference))[1]
    assert denoised["relmse"] < denoised["relmse_bound"]
    assert result.json["relmse"] < denoised["relmse_bound"]
    assert "at most" in result.err
    assert result.json["samples"] == []  # such pictures are not merged


def test_a_stopped_render_leaves_the_noisy_image_before(render_arguments, tmp_path, denoiser):
    noisy = tmp_path / "noisy.exr"
    noisy.write_text("of an earlier run")
    limit = ("--time-limit", 0.05, "--spp", 1 << 20, "--denoise", "--noisy-image", noisy)
    at = render_arguments.index("--spp")
    assert velour(*render_arguments[:at], *render_arguments[at + 2 :], *limit).status == 3
    assert noisy.read_text() == "of an earlier run"


def test_a_noise_target_is_that_of_the_denoised_picture(render_arguments, denoiser):
    at = render_arguments.index("--spp")
    arguments = render_arguments[:at] + render_arguments[at + 2 :]
    plain, denoised = (velour(*arguments, "--noise", 0.05, *more).json for more in ((), ("--denoise",)))
    assert denoised["denoised"]["relmse_bound"] <= 0.05**2
    assert denoised["spp_mean"] < plain["spp_mean"]


def test_a_part_of_a_picture_is_not_denoised(render_arguments):
    result = velour(*render_arguments, "--denoise", "--crop", "0:4,0:4")
    assert result.status != 0
    assert "leave out --samples and --crop, or --denoise" in result.err


def test_a_noisy_image_needs_a_denoised_one(render_arguments, tmp_path):
    result = velour(*render_arguments, "--noisy-image", tmp_path / "noisy.exr")
    assert result.status != 0
    assert "--denoise" in result.err


def test_the_fitted_lobe_is_made_when_the_render_starts(render_arguments):
    assert "ggx fit" in velour(*render_arguments, "--strategy", "mis-ggx").json["stages"]
    assert "ggx fit" not in velour(*render_arguments).json["stages"]


def test_a_measurement_renders_by_itself(render_arguments, measurement_file, model_file):
    arguments = [measurement_file if a == model_file else a for a in render_arguments]
    assert velour(*arguments, "--proposal", model_file).status == 0
    assert velour(*arguments, "--strategy", "cosine").status == 0


def test_camera_and_world_rotation(render_arguments, tmp_path):
    assert velour(*render_arguments, "--camera", "0,-9,0,0,0,0,12").status == 0
    before = images.read(tmp_path / "out.exr")
    assert velour(*render_arguments, "--camera", "0,-9,0,0,0,0,12", "--world-rotation", 120).status == 0
    assert not np.array_equal(before, images.read(tmp_path / "out.exr"))


def test_capture(tmp_path):
    path = tmp_path / "rough.binary"
    result = velour("capture", "--microsurface", "--rays", 20000, "--roughness", 0.4, "-o", path, "--json")
    assert result.status == 0, result.err
    assert {"seconds", "rays", "rays_per_second", "bytes"} <= set(result.json)
    assert result.json["bytes"] == path.stat().st_size
    assert velour("info", path, "--json").json["format"] == "merl"


_SMALL = ("--texels", 8, "--views", 81, "--lights", 3, "--samples", 4, "--json")


def test_capture_of_a_tile(tmp_path):
    folder = tmp_path / "net"
    result = velour("capture", "net", *_SMALL, "-o", folder)
    assert result.status == 0, result.err
    report = result.json
    assert (report["sides"], report["views"], report["lights"], report["open"]) == (2, 162, 6, True)
    assert report["bytes"] == sum(path.stat().st_size for path in folder.iterdir())
    assert 0 <= report["reference_height"] <= report["thickness"]
    assert (folder / "btf.json").exists()


@pytest.mark.parametrize("name", ["mesh.obj", "mesh.ply"])
def test_capture_of_a_mesh(name, tmp_path):
    """A white square of 2 x 2: its f is the base color over pi from everywhere."""
    path = tmp_path / name
    obj = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"
    ply = (
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n4 0 1 2 3\n"
    )
    path.write_text(obj if name.endswith("obj") else ply)
    result = velour("capture", path, *_SMALL, "--ray-share", "-o", tmp_path / "btf")
    assert result.status == 0, result.err
    assert (result.json["sides"], result.json["thickness"], result.json["warnings"]) == (1, 0, [])
    assert 0 < result.json["ray_share"] < 1.5
    assert "resume" in velour("capture", path, *_SMALL, "-o", tmp_path / "btf").err
    assert velour("capture", path, *_SMALL, "--resume", "-o", tmp_path / "btf").json["views_resumed"] == 81


def test_reports_in_a_file(model_file, tmp_path):
    path = tmp_path / "report.json"
    result = velour("info", model_file, "--json", "--json-file", path)
    assert json.loads(path.read_text()) == result.json


def test_quiet_says_nothing(model_file):
    assert velour("info", model_file, "--quiet") == (0, "", "")


def test_log_levels(render_arguments):
    assert "light directions per pixel" not in velour(*render_arguments).err
    assert "light directions per pixel" in velour(*render_arguments, "--log-level", "info").err
    assert "light directions per pixel" in velour(*render_arguments, VELOUR_LOG="info").err


def test_simd_can_be_pinned(render_arguments):
    assert velour(*render_arguments, "--simd", "auto").status == 0


def test_observe_tells_what_the_scene_asks_of_its_material(observe_arguments, tmp_path):
    report = program(*observe_arguments).json
    assert list(report) == OBSERVE_KEYS
    assert (report["frames"], report["hits"]) == (1, 1024)
    assert report["weight"] == pytest.approx(report["share"] * report["camera_rays"])
    assert 0 < report["share"] < 1
    low, high = report["views"]
    assert 0 <= low < high <= 90
    assert report["light_density"] > 0
    info = velour("info", tmp_path / "scene.json", "--json").json
    assert info == {"kind": "observation", **{key: report[key] for key in OBSERVE_KEYS[1:]}}


def test_observations_merge_in_any_order(observe_arguments, tmp_path):
    first, second = tmp_path / "first.json", tmp_path / "second.json"
    for path, camera in ((first, "0,-6,3,0,0,0,30"), (second, "4,-4,1,0,0,0,30")):
        assert velour(*observe_arguments, "--camera", camera, "-o", path).status == 0
    forwards = velour(*observe_arguments, "--merge", first, "--merge", second).json
    backwards = velour(*observe_arguments, "--merge", second, "--merge", first).json
    assert forwards["frames"] == 3
    assert forwards["hash"] == backwards["hash"]
    assert forwards["weight"] == pytest.approx(backwards["weight"])


def test_a_picture_without_the_material_is_observed_with_a_warning(observe_arguments):
    status, out, err = velour(*observe_arguments, "--camera", "0,-6,3,0,-12,3,30")
    assert status == 0
    assert "does not show the material" in err
    assert (json.loads(out)["hits"], json.loads(out)["views"]) == (0, None)
