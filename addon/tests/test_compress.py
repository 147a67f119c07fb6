"""velour compress and what comes after it: info, compare, render, on one small BTF."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from command_line import refused, velour
from inputs import write_octahedron, write_ribs
from kept import captured
from velour.native import Btf, Model, images

LIGHTS = 40
TENSORS = ("tucker", "cta", "kcta")
COUNTS = {
    "srbf": ["lobes", "coefficients"], "svd": ["components"], "svd-view": ["components"],
    **{name: ["coefficients"] for name in TENSORS},
}  # fmt: skip
COMPRESS_KEYS = [
    "bytes", "parameter_bytes", "ratio", "psnr", "psnr_held_out", "ser", "relative_l2", "p99",
    "evaluations_per_second", "seconds", "verdict", "warnings", "warning_codes", "tolerance", "order",
    "search",
]  # fmt: skip
BYTES = {"srbf": 12000, "svd": 60000, "svd-view": 60000, **dict.fromkeys(TENSORS, 20000)}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("btf")


@pytest.fixture(scope="module")
def btf():
    return captured("corduroy", 12, 30, LIGHTS, 16, seed=1)


@pytest.fixture(scope="module")
def held_out():
    return captured("corduroy", 12, 9, LIGHTS, 16, seed=2)


@pytest.fixture(scope="module", params=["srbf", "svd", "svd-view", *TENSORS])
def judged(request, fitted):
    """The method, its model and what compress reports of it."""
    return request.param, *fitted(request.param)


@pytest.fixture(scope="module")
def fitted(folder, btf, held_out):
    """fitted(method): a model and its report, made once."""

    @functools.cache
    def fit(method: str):
        path = folder / f"{method}.velour"
        arguments = ["--held-out", held_out, "--bytes", BYTES[method], "--json"]
        if method != "srbf":  # the default
            arguments += ["--method", method]
        return path, velour("compress", btf, "-o", path, *arguments).json

    return fit


@pytest.fixture
def model(judged):
    return judged[1]


def test_report_and_held_out_pairs(judged, held_out):
    method, path, report = judged
    shapes = ["shapes"] if method in TENSORS else []
    assert list(report) == ["method", *COUNTS[method], *COMPRESS_KEYS, *shapes, "psnr_heldout"]
    assert report["method"] == method
    assert report["parameter_bytes"] <= BYTES[method]
    assert report["bytes"] == path.stat().st_size
    assert report["ratio"] == pytest.approx(30 * LIGHTS * 144 * 6 / report["bytes"])
    assert report["psnr"] > (25 if method.startswith("svd") else 19)
    assert report["psnr_held_out"] > 15
    assert report["psnr_heldout"] == report["psnr_held_out"]
    assert report["evaluations_per_second"] > 1e4
    same = velour("compare", held_out, path, "--json").json
    assert same["psnr"] == pytest.approx(report["psnr_held_out"], abs=1e-9)
    assert same["pairs"] == 9 * LIGHTS


def test_more_bytes_are_closer(folder, btf, judged):
    method, path, report = judged
    small = folder / "coarse.velour"
    bytes = max(BYTES[method] // 5, 15000 if method == "svd-view" else 0)  # a component for each view
    coarse = velour("compress", btf, "-o", small, "--method", method, "--bytes", bytes, "--json").json
    assert coarse["psnr"] < report["psnr"] - 1
    assert coarse["ser"] > report["ser"]
    assert velour("compare", btf, path, "--json").json["psnr"] == pytest.approx(report["psnr"], abs=1e-9)


@pytest.mark.parametrize(("method", "size"), [("srbf", 2500), ("svd", 30000)])
def test_the_same_seed_gives_the_same_file(folder, btf, method, size):
    """Whatever the number of threads; the record holds seconds and rates, which differ."""
    reports = []
    for threads in (1, 2):
        path = folder / f"threads-{threads}.velour"
        arguments = ["--method", method, "--bytes", size, "--seed", 3, "--threads", threads, "--json"]
        reports.append(velour("compress", btf, "-o", path, *arguments).json)
    for key in (*COUNTS[method], "psnr", "ser"):
        assert reports[0][key] == reports[1][key]


def test_a_btf_interpolated_is_itself_at_its_own_pairs(btf, held_out):
    assert velour("compare", btf, btf, "--json").json["ser"] < 1e-9
    assert velour("compare", held_out, btf, "--json").json["psnr"] < 40


def test_info_of_the_model(judged):
    method, path, compressed = judged
    report = velour("info", path, "--json").json
    kind = {"srbf": "srbf-btf", **{name: "tensor-btf" for name in TENSORS}}.get(method, "factored-btf")
    assert (report["kind"], report["model"], report["method"]) == ("model", kind, method)
    assert report["texels"] == [12, 12]
    assert (report["views"], report["lights"], report["companding"]) == (30, LIGHTS, "root")
    assert len(report["tile_metres"]) == 2
    assert report["source"]["format"] == "velour-btf"
    for key in ("psnr", "parameter_bytes", *COUNTS[method]):
        assert report[key] == compressed[key]


def test_info_tells_the_shapes_of_tensors(judged):
    method, path, compressed = judged
    report = velour("info", path, "--json").json
    if method not in TENSORS:
        assert report["shapes"] == []
        return
    (side,) = report["sides"]
    assert report["shapes"] == compressed["shapes"]
    assert report["coefficients"] == side["members"] * side["ranks"]["texel"]
    assert side["clusters"] == 1 or method != "tucker"
    assert side["members"] == 1 or method == "kcta"
    tried = {(s["clusters"], s["members"], s["texel_rank"]) for s in report["shapes"]}
    assert (side["clusters"], side["members"], side["ranks"]["texel"]) in tried


def test_info_counts_the_sides_of_srbfs(judged):
    method, path, _ = judged
    report = velour("info", path, "--json").json
    if method in TENSORS:
        return
    if method != "srbf":
        assert "sides" not in report
        return
    (side,) = report["sides"]
    assert (side["view"], side["light"]) == ("above", "above")
    assert side["lobes"]["tile"] + side["lobes"]["texel"] == report["lobes"]
    assert side["parameter_bytes"] == report["parameter_bytes"]


@pytest.mark.parametrize(
    ("method", "companding", "darker", "lighter"),
    [
        ("svd", "none", 0.03, 0.03),
        ("svd", "root", 0.1, 0.02),
        ("srbf", "none", 0.1, 0.1),
        ("srbf", "root", 0.1, 0.1),
    ],
)
def test_the_model_renders_with_the_light_that_the_btf_reflects(
    folder, btf, fitted, method, companding, darker, lighter
):
    """A plane of many tiles under an even sky of 1: the mean pixel is the BTF's albedo at that view. Between
    texels, levels and directions the square of a mean of roots is below the mean. The SRBFs have few bytes,
    which leave the weakest channel behind and keep one view's mean to some per cent: they are judged by
    luminance."""
    if companding == "root":  # the default
        model, _ = fitted(method)
    else:
        model = folder / f"{method}-{companding}.velour"
        options = ["--method", method, "--bytes", BYTES[method], "--companding", companding, "--quiet"]
        velour("compress", btf, "-o", model, *options)
    plane = folder / "plane.obj"
    plane.write_text(
        "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nvt 0 0\nvt 90 0\nvt 90 90\nvt 0 90\n"
        "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
    )
    sky = folder / "sky.exr"
    images.write(sky, np.ones((16, 32, 3), np.float32))
    picture = folder / "plane.exr"
    camera = "0,0.001,10,0,0,0,10"
    done = velour(
        "render", "--mesh", plane, "--up", "z", "--material", model, "--world", sky, "--size", "32x32",
        "--spp", 64, "--camera", camera, "-o", picture, "--quiet",
    )  # fmt: skip
    assert done.status == 0, done.err
    rendered = images.read(picture)[..., :3].mean(axis=(0, 1))
    with Btf.load(btf) as loaded:
        angles = loaded.angles()
        steepest = angles[:, 2].argmin() // LIGHTS
        f = loaded.read(int(steepest) * LIGHTS, LIGHTS).astype(np.float64).mean(axis=(1, 2))
    cosine = np.cos(np.radians(angles[:LIGHTS, 0]))
    albedo = 2 * np.pi / LIGHTS * (f * cosine[:, None]).sum(axis=0)
    channels = np.array([[0.2126, 0.7152, 0.0722]]) if method == "srbf" else np.eye(3)
    ratio = (channels @ rendered) / (channels @ albedo)
    assert (ratio > 1 - darker).all()
    assert (ratio < 1 + lighter).all()


def test_the_model_evaluates_over_the_whole_tile(model):
    with Model.load(model) as loaded:
        f = loaded.eval((0, 0, 1), np.array([[0, 0, 1], [0.6, 0, 0.8], [0, 0, -1]], np.float32))[0]
    assert (f[:2] > 0).all()
    assert (f[2] == 0).all()


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--bytes", 100], "Raise the maximum size"),
        (["--method", "svd-view", "--ratio", 500], "30 views that are not black takes 13800 bytes"),
        (["--clusters", 3], "kcta"),
        (["--method", "svd", "--no-relief"], "kcta"),
        (["--method", "tucker", "--clusters", 2], "one cluster"),
        (["--method", "cta", "--members", 2], "too many"),
        (["--method", "kcta", "--clusters", 2, "--members", 3], "too many"),
    ],
)
def test_what_cannot_be_is_refused_with_a_sentence(folder, btf, arguments, word):
    assert word in refused("compress", btf, "-o", folder / "refused.velour", *arguments)
    assert not (folder / "refused.velour").exists()


@pytest.fixture(scope="module")
def other(folder):
    path = folder / "other"
    options = ["--texels", 8, "--views", 4, "--lights", 4, "--samples", 1, "--quiet"]
    assert velour("capture", write_ribs(folder / "ribs.obj"), *options, "-o", path).status == 0
    return path


def test_what_has_other_texels_is_refused(folder, btf, model, other):
    assert "texels" in refused("compare", other, model)
    assert "texels" in refused("compress", btf, "-o", folder / "refused.velour", "--held-out", other)


def test_a_brdf_is_no_btf(folder):
    mesh = write_octahedron(folder / "mesh.obj")
    assert "mesh.obj" in refused("compress", mesh, "-o", folder / "refused.velour")
