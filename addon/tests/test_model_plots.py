"""Plots of models: the same numbers as picture, SVG, table and JSON, and the command that makes them."""

from __future__ import annotations

import csv
import math
import xml.etree.ElementTree

import numpy as np
import pytest
from command_line import refused, velour
from inputs import BTF_MODEL
from velour.native import (
    Measurement,
    Model,
    Plot,
    Scene,
    Tile,
    VelourError,
    images,
    measurement_job,
    plot_job,
    table,
    votf_job,
)
from velour.native.plot import text_coverage

DARK = {"background": (0.19, 0.19, 0.19), "foreground": (0.9, 0.9, 0.9)}


@pytest.fixture(scope="module")
def model(model_file):
    """With an outline, so that it has every plot."""
    with Model.load(model_file) as bare, Tile.create("net", resolution=6) as tile, Scene() as scene:
        mesh, materials = tile.add_to(scene)
        scene.add_instance(mesh, np.eye(4)[:3], materials)
        scene.commit()
        options = {"texels": 16, "reference_height": 0.0, "period": tile.info()["period"], "origin": (0, 0)}
        with votf_job(scene, bare, **options) as job:
            job.run()
            with job.result_model() as model:
                yield model


@pytest.fixture(scope="module")
def measurement(measurement_file):
    with Measurement.load(measurement_file) as measurement:
        yield measurement


def _series(data: dict, name: str) -> np.ndarray:
    """[points x 2]"""
    (series,) = (series for series in data["series"] if series["name"] == name)
    return np.transpose([series["x"], series["y"]])


def _luminance(f: np.ndarray) -> np.ndarray:
    return f @ np.array([0.2126, 0.7152, 0.0722])


def _lights(degrees: np.ndarray) -> np.ndarray:
    """In the plane of incidence of views of azimuth 0, which look from +x."""
    theta = np.radians(degrees)
    return np.stack([-np.sin(theta), 0 * theta, np.cos(theta)], axis=1).astype(np.float32)


def test_lobes_show_what_model_and_measurement_say(model, measurement):
    view = math.radians(40)
    wv = (math.sin(view), 0, math.cos(view))
    with Plot.of(model, "lobes", measurement, view) as plot:
        data = plot.data()
    for name, source in (("model", model), ("measured", measurement)):
        points = _series(data, name)
        wl = _lights(points[:, 0])
        f_cos = _luminance(source.eval(wv, wl)[0]) * wl[:, 2]
        np.testing.assert_allclose(points[:, 1], f_cos, rtol=2e-3, atol=2e-5)
    lobes = sum(_series(data, s["name"])[:, 1] for s in data["series"] if s["name"].startswith("lobe"))
    np.testing.assert_allclose(lobes, _series(data, "model")[:, 1], rtol=1e-3, atol=1e-4)


def test_the_measurement_is_in_a_plot_where_it_is_given(model, measurement):
    for kind, name in (("lobes", "measured"), ("albedo", "measured red")):
        with Plot.of(model, kind) as without, Plot.of(model, kind, measurement) as plot:
            assert name not in [series["name"] for series in without.data()["series"]]
            assert len(_series(plot.data(), name)) > 10


def test_errors_and_albedos_are_those_of_the_fit(model):
    info = model.info()
    with Plot.of(model, "view-error") as plot:
        errors = {f"{angle:g}": error for angle, error in _series(plot.data(), "error")}
    assert errors == {angle: error for angle, error in info["by_view_angle"].items() if error is not None}
    with Plot.of(model, "order") as plot:
        data = plot.data()
    order = info["order"]
    assert _series(data, "error").tolist() == [
        list(p) for p in zip(order["lobes"], order["worst"], strict=True)
    ]
    assert data["series"][-1]["chosen"] == order["chosen"]
    with Plot.of(model, "albedo") as plot:
        data = plot.data()
    channels = [_series(data, f"model {channel}") for channel in ("red", "green", "blue")]
    for angle, albedo in info["albedo_by_view_angle"].items():
        assert max(channel[int(angle), 1] for channel in channels) == pytest.approx(albedo, rel=1e-4)


@pytest.mark.parametrize("kind", table.PLOTS)
def test_a_job_makes_the_same_plot(model, measurement, measurement_file, kind):
    with measurement_job(measurement_file) as reading:
        assert reading.run() == measurement.info()
        with reading.result_measurement() as read, plot_job(model, kind, read, view=0.7, azimuth=0.2) as job:
            report = job.run()
            with job.result_plot() as plot, Plot.of(model, kind, measurement, 0.7, 0.2) as same:
                assert plot.data() == same.data() == report


def test_a_job_gives_nothing_that_it_has_not_made(model, measurement_file, tmp_path):
    with plot_job(model, "order") as job:
        with pytest.raises(VelourError, match="never started"):
            job.result_plot()
        job.run()
        with pytest.raises(VelourError, match="does not read a measurement"):
            job.result_measurement()
        with pytest.raises(VelourError, match="does not produce a model"):
            job.result_model()
    (tmp_path / "broken.binary").write_bytes(b"\0" * 40)
    with measurement_job(tmp_path / "broken.binary") as job:
        with pytest.raises(VelourError, match=r"broken\.binary"):
            job.run()
        with pytest.raises(VelourError, match="broken"):
            job.result_measurement()


def test_an_albedo_that_is_not_wanted_any_more_ends_soon(model, measurement):
    with plot_job(model, "albedo", measurement) as job:
        job.start()
        fractions = [job.poll().fraction]
        while job.poll().running and fractions[-1] < 0.05:
            fractions.append(job.poll().fraction)
        assert fractions == sorted(fractions)
        job.cancel()
        with pytest.raises(VelourError) as caught:
            job.wait()
        assert caught.value.cancelled
        assert job.run()["plot"] == "albedo"  # may be started again


@pytest.mark.parametrize("kind", table.PLOTS)
def test_all_forms_hold_the_same(model, measurement, kind, tmp_path):
    with Plot.of(model, kind, measurement) as plot:
        data, pixels = plot.data(), plot.draw(side=300, **DARK)
        for extension in ("png", "svg", "csv"):
            plot.save(tmp_path / f"plot.{extension}", side=300, **DARK)
    bytes_drawn = np.rint(255 * pixels)
    stored = images.read(tmp_path / "plot.png")
    linear = np.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
    np.testing.assert_allclose(stored[..., :3], linear[..., :3], atol=0.005)
    assert (stored[..., 3] == 1).all()
    assert len(np.unique(bytes_drawn.reshape(-1, 4), axis=0)) > 20
    rows = list(csv.reader((tmp_path / "plot.csv").read_text().splitlines()))
    assert rows[0] == ["series", data["x"]["column"], data["y"]["column"], "chosen"]
    listed = [(s["name"], x, y) for s in data["series"] for x, y in zip(s["x"], s["y"], strict=True)]
    assert [(name, float(x), float(y)) for name, x, y, _ in rows[1:]] == listed
    svg = xml.etree.ElementTree.parse(tmp_path / "plot.svg").getroot()
    texts = [element.text for element in svg.iter("{http://www.w3.org/2000/svg}text")]
    assert any(text.startswith(data["y"]["label"]) for text in texts)
    assert svg.get("viewBox") == "0 0 300 300"


def test_colors_are_taken_and_kept_readable(model):
    with Plot.of(model, "albedo") as plot:
        dark = plot.draw(side=200, **DARK)
        np.testing.assert_allclose(dark[0, 0, :3], DARK["background"])
        hidden = plot.draw(side=200, background=(1, 1, 1), foreground=(1, 1, 1), red=(1, 1, 0.9))
    assert hidden[..., :3].min() < 0.2, "white text on white stays white"
    assert not np.array_equal(dark, hidden)


def test_a_btf_has_its_error_against_bytes_and_says_so_of_the_rest(tmp_path):
    with Model.load(BTF_MODEL) as model:
        with pytest.raises(VelourError, match="no silhouette"):
            Plot.of(model, "outline")
        for kind in set(table.PLOTS) - {"order", "outline"}:
            with pytest.raises(VelourError, match=r"BTF models have no plot .*Use 'order'"):
                Plot.of(model, kind)
        order = model.info()["order"]
        with Plot.of(model, "order") as plot:
            assert _series(plot.data(), "error")[:, 0].tolist() == order["parameter_bytes"]
    sentence = refused("plot", BTF_MODEL, "-o", tmp_path / "plot.png")
    assert "BTF" in sentence
    assert not (tmp_path / "plot.png").exists()


def test_wrong_styles_are_refused(model, tmp_path):
    with Plot.of(model, "order") as plot:
        with pytest.raises(VelourError, match="size of the plot"):
            plot.draw(side=20)
        with pytest.raises(VelourError, match=r"background.*2\.0"):
            plot.draw(background=(0, 2, 0))
        with pytest.raises(TypeError, match="no style 'color'"):
            plot.draw(color=(0, 0, 0))
        with pytest.raises(VelourError, match=r"\.png, \.svg or \.csv"):
            plot.save(tmp_path / "plot.pdf")


def test_the_command_writes_each_form(model_file, measurement_file, tmp_path):
    for kind, name in (("lobes", "a.png"), ("order", "b.svg"), ("view-error", "c.csv"), ("albedo", "d.csv")):
        given = ("plot", model_file, "--measurement", measurement_file, "--kind", kind, "-o", tmp_path / name)
        report = velour(*given, "--view", 60, "--azimuth", 20, "--side", 256, "--dark", "--json").json
        assert list(report) == ["plot", "polar", "x", "y", "series"]
        assert report["plot"] == kind
        assert (tmp_path / name).stat().st_size > 100
    assert images.read(tmp_path / "a.png").shape == (256, 256, 4)
    assert "measured red" in (tmp_path / "d.csv").read_text()
    shown = velour("plot", model_file, "-o", tmp_path / "e.png")
    assert shown.status == 0
    assert "model (1" in shown.out
    assert images.read(tmp_path / "e.png").shape == (800, 800, 4)
    assert velour("plot", model_file, "-o", tmp_path / "f.png", "--view", 90).status == 2
    assert "does not exist" in refused("plot", model_file, "-o", tmp_path / "no/g.png")


def test_text_is_as_wide_as_its_letters_and_stands_on_its_baseline():
    one, two = text_coverage("Model", 20), text_coverage("Model Model", 20)
    assert one.shape[0] == two.shape[0] == 60
    assert 1.8 < (two.shape[1] - 40) / (one.shape[1] - 40) < 2.2  # margins of an em on both sides
    assert (one.min(), one.max()) == (0, 1)
    rows = np.flatnonzero(one.max(axis=1) > 0.5)
    assert rows[0] == 20  # no letter reaches below the baseline
    assert text_coverage("", 20).max(initial=0) == 0
    for text, em in (("Model", 2), ("Model", float("nan")), ("x" * 2000, 20)):
        with pytest.raises(VelourError, match=r"em is|bytes"):
            text_coverage(text, em)
