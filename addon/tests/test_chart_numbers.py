"""The small pieces of scripts/figures and scripts/chart: each against what is known."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from bench import scenes
from bench.pages import chart
from bench.pages.chart import Result
from bench.progress import Progress
from bench.reference import Curve, fit_error, ratio
from bench.run import Run, key
from bench.scenes import Scene


def test_the_fits_error_is_found_under_noise():
    rng = np.random.default_rng(3)
    reference = rng.uniform(0.5, 2.0, (60, 80, 3)).astype(np.float32)
    bias = rng.normal(0, 0.01, reference.shape)
    rmse, relmse = fit_error(bias + rng.normal(0, 0.02, (4, *reference.shape)), reference)
    assert rmse == pytest.approx(0.01, rel=0.1)
    assert relmse == pytest.approx((bias**2 / (reference**2 + 0.01 * reference.mean() ** 2)).mean(), rel=0.2)


def test_a_curve_is_read_between_its_points():
    curve = Curve([(1.0, 1.0), (4.0, 0.25), (16.0, 0.0625)])
    assert curve.seconds_at(0.5).value == pytest.approx(2)
    assert curve.error_at(8.0).value == pytest.approx(0.125)
    assert curve.seconds_at(0.5).measured


@pytest.mark.parametrize(("error", "seconds"), [(2.0, 0.5), (0.01, 100.0)])
def test_a_curve_is_continued_and_says_so(error, seconds):
    found = Curve([(1.0, 1.0), (4.0, 0.25), (16.0, 0.0625)]).seconds_at(error)
    assert found.value == pytest.approx(seconds)
    assert not found.measured
    assert str(found).startswith("~")
    assert not ratio(found, found).measured


def test_a_curve_that_does_not_fall_reaches_nothing():
    assert Curve([(1.0, 1.0), (2.0, 1.5)]).seconds_at(0.5) is None
    assert Curve([]).error_at(1.0) is None


def test_the_last_crossing_counts():
    assert Curve([(1.0, 1.0), (2.0, 0.1), (4.0, 1.0), (8.0, 0.1)]).seconds_at(
        0.1**0.5
    ).value == pytest.approx(32**0.5)


def _points(spp: int, seconds: float, mse: float, *errors: float) -> list[dict]:
    return [
        {"spp": spp, "seed": s, "seconds": seconds, "mse": mse, "relmse": e} for s, e in enumerate(errors)
    ]


def test_gains_and_levels():
    points = {
        "mis": _points(1, 1.0, 0.04, 0.2, 0.4) + _points(2, 2.0, 0.01, 0.1),
        "product": _points(1, 1.5, 0.01, 0.1, 0.2) + _points(2, 3.0, 0.0, 0.05),
    }
    result = Result({}, points, 2)
    value, error = result.gain("product", "mis", 1)
    assert value == pytest.approx(0.5)
    assert error == pytest.approx(0.5 * (2 * (1 / 3) ** 2) ** 0.5)
    assert result.level == 0.1
    assert result.means("mis")[1] == pytest.approx((1.0, 0.3, 0.2))
    assert result.to_best("product").value == result.error_ratio("product", "mis").value
    assert result.seconds_to_level("product").value == pytest.approx(1.5 * 2 ** (np.log(1.5) / np.log(3)))


def test_share_of_the_bound():
    bound = {"mis": 1.0, "product": 0.4, "exact": 0.2}
    assert Result({"bound": bound}, {}, 2).share_of_bound == pytest.approx(0.75)


@pytest.fixture
def run(tmp_path):
    settings = SimpleNamespace(size=(8, 6), bound_hits=200)
    return Run("it", tmp_path / "work", tmp_path / "out", settings, threads=1)


def test_the_bound_is_read_from_its_program(run, tmp_path, monkeypatch):
    scene = Scene("bunny", tmp_path / "mesh", "y", tmp_path / "world", tmp_path / "model")
    program = tmp_path / "bench/product_bound"
    program.parent.mkdir()
    for path in (scene.mesh, scene.world, scene.material):
        path.write_text("")
    said = '{"hits": 200, "variance": {"mis": 3, "product": 2, "exact": 1}}'
    program.write_text(f"#!/bin/sh\necho '{said}'\n")
    monkeypatch.setattr(chart, "BUILT", tmp_path)
    program.chmod(0o755)
    expected = {"mis": 3, "product": 2, "exact": 1}
    assert chart._bound(run, scene) == expected
    program.chmod(0o644)  # kept: it is not run again
    assert chart._bound(run, scene) == expected
    monkeypatch.setattr(chart, "BUILT", tmp_path / "none")
    assert chart._bound(run, scene) is None


def test_work_that_fails_is_not_kept(run):
    def fail():
        raise RuntimeError

    for _ in range(2):
        with pytest.raises(RuntimeError):
            run.keep("it", "it", {}, fail)


def test_progress_counts_what_was_kept_but_not_its_time(capsys):
    progress = Progress()
    progress.expect(1.0, 3)
    progress.skip("a", 1.0)
    with progress.work("b", 1.0):
        pass
    first, second = capsys.readouterr().out.splitlines()
    assert first == "[  1/3] a: kept"
    assert second.startswith("[  2/3] b: 0.0 s, about 0 s left")


def test_a_key_depends_on_contents_and_not_on_names(tmp_path):
    a, b, c = (tmp_path / name for name in "abc")
    for path, text in ((a, "same"), (b, "same"), (c, "other")):
        path.write_text(text)
    assert key({"mesh": a}) == key({"mesh": b}) != key({"mesh": c})
    assert key({"mesh": a, "spp": 1}) != key({"mesh": a, "spp": 2})


def test_reference_mode_is_the_same_scene_with_the_measurement(tmp_path):
    scene = Scene("bunny", tmp_path / "m", "y", tmp_path / "w", tmp_path / "model")
    measured = scene.measured(tmp_path / "data")
    assert measured.options == scene.options | {"material": tmp_path / "data", "proposal": tmp_path / "model"}


def test_the_synthetic_sun_is_small_and_has_its_share(tmp_path):
    from velour.native import images

    pixels = images.read(scenes.write_sunny_sky(tmp_path / "sky.exr")).astype(np.float64) @ [
        0.2126,
        0.7152,
        0.0722,
    ]
    height = len(pixels)
    elevation = np.pi * ((np.arange(height) + 0.5) / height - 0.5)
    energy = pixels * np.cos(elevation)[:, None]
    sun = pixels > 100
    assert energy[sun].sum() / energy.sum() == pytest.approx(0.9, abs=1e-3)
    # The disc's solid angle, partly covered texels by their share.
    area = (np.cos(elevation)[:, None] * pixels / pixels.max())[sun].sum() * (np.pi / height) ** 2
    assert area == pytest.approx(np.pi * np.radians(0.25) ** 2, rel=0.02)
    row, column = (np.average(np.nonzero(sun)[axis], weights=energy[sun]) + 0.5 for axis in (0, 1))
    assert np.degrees(np.pi * (row / height - 0.5)) == pytest.approx(40, abs=0.05)
    assert np.degrees(np.pi * (1 - column / height)) == pytest.approx(-60, abs=0.05)


def _obj(path) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Arrays by kind, and the numbers of the faces' points."""
    lines = [line.split() for line in path.read_text().splitlines()]
    faces = [[part.split("/")[0] for part in line[1:]] for line in lines if line[0] == "f"]
    arrays = {
        kind: np.array([line[1:] for line in lines if line[0] == kind], float) for kind in ("v", "vn", "vt")
    }
    return arrays, np.array(faces, int) - 1


def test_the_sphere_is_closed_and_its_normals_point_out(tmp_path):
    arrays, faces = _obj(scenes.write_sphere(tmp_path / "s.obj"))
    points, same = np.unique(arrays["v"].round(6), axis=0, return_inverse=True)
    a, b, c = points[same[faces]].transpose(1, 0, 2)
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 == pytest.approx(4 / 3 * np.pi, rel=2e-3)
    edges = np.stack([same[faces], np.roll(same[faces], -1, axis=1)], axis=-1).reshape(-1, 2)
    edges = np.unique(edges, axis=0)
    np.testing.assert_array_equal(np.unique(edges[:, ::-1], axis=0), edges)
    np.testing.assert_allclose(arrays["v"], arrays["vn"])


def test_the_sheet_keeps_lengths(tmp_path):
    arrays, faces = _obj(scenes.write_sheet(tmp_path / "sheet.obj"))
    v, vn, vt = (arrays[kind] for kind in ("v", "vn", "vt"))
    np.testing.assert_allclose((v[:, 1:] * vn[:, 1:]).sum(axis=1), 1, atol=1e-5)
    arc = np.linalg.norm(v[2] - v[0]) / np.abs(vt[2, 1] - vt[0, 1])
    axis = np.ptp(v[:, 0]) / np.ptp(vt[:, 0])
    assert arc == pytest.approx(axis, rel=1e-3)
    a, b, c = v[faces[0]]
    assert np.cross(b - a, c - a) @ vn[faces[0, 0]] > 0
