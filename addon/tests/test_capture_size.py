"""What a capture is said to take before it begins."""

from types import SimpleNamespace

import numpy as np
import pytest
from velour.core.capture_size import (
    Probe,
    Timed,
    capture_memory,
    capture_seconds,
    capture_text,
    duration,
    pairs_bytes,
    probes,
    spread,
)
from velour.native import Scene, capture_job, directions


def _settings(**values):
    return SimpleNamespace(
        **{"texels": 128, "views": 105, "lights": 105, "samples": 16, "held_out": 0, **values}
    )


def _sawtooth(scene):
    corners = [(0, 0, 0), (0.7, 0, 0.3), (1, 0, 0), (0, 1, 0), (0.7, 1, 0.3), (1, 1, 0)]
    triangles = [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4)]
    mesh, _ = scene.add_mesh(np.array(corners, np.float32), np.array(triangles, np.uint32))
    paint = scene.add_principled_material(base_color=(0.8, 0.5, 0.2), roughness=1.0, specular=0.0)
    scene.add_instance(mesh, np.eye(4), [paint])
    scene.commit()


def _rays(path, texels, views, lights, bounces, sides="one", held_out=0):
    options = {"texels": texels, "views": views, "lights": lights, "samples": 4, "bounces": bounces}
    options["reference_height"] = 0.1  # or it is sought, by rays of its own
    with Scene() as scene:
        _sawtooth(scene)
        with capture_job(scene, path, period=(1, 1), sides=sides, held_out=held_out, **options) as job:
            return job.run()["rays"]


@pytest.mark.parametrize("bounces", [0, 2])
def test_rays_of_two_probes_tell_those_of_the_whole(tmp_path, bounces):
    """Rays instead of seconds, which are others on each machine; more texels, views and lights than those."""
    settings = _settings(texels=80, views=16, lights=32, samples=4)
    views, lights = directions("16"), directions("32")
    counted = [
        _rays(tmp_path / f"{n}.btf", p.texels, spread(views, p.views), spread(lights, p.lights), bounces)
        for n, p in enumerate(probes(settings))
    ]
    whole = _rays(tmp_path / "whole.btf", settings.texels, views, lights, bounces)
    told = capture_seconds(settings, [Timed(rays, rays) for rays in counted])
    assert abs(told / whole - 1) < 0.1, (told, whole)
    few = probes(settings)[0]  # a control: in proportion to texels, views and lights alone
    alone = counted[0] * 80**2 * 16 * 32 / (few.texels**2 * few.views * few.lights)
    assert abs(alone / whole - 1) > 1.5 * abs(told / whole - 1)


@pytest.mark.parametrize("sides", ["one", "two"])
def test_pairs_to_judge_by_take_time_and_space(tmp_path, sides):
    settings = _settings(texels=80, views=8, lights=32, samples=4, held_out=64)
    views, lights = directions("8"), directions("32")
    counted = []
    for n, p in enumerate(probes(settings)):
        few = spread(views, p.views), spread(lights, p.lights)
        counted.append(_rays(tmp_path / f"{n}.btf", p.texels, *few, 1, sides=sides))
    whole = _rays(tmp_path / "whole.btf", 80, views, lights, 1, sides=sides)
    pairs = tmp_path / "pairs.btf"
    whole += _rays(pairs, 80, views, lights, 1, sides=sides, held_out=64)
    told = capture_seconds(settings, [Timed(rays, rays) for rays in counted], {"one": 1, "two": 2}[sides])
    assert abs(told / whole - 1) < 0.15, (told, whole)
    written = sum(file.stat().st_size for file in pairs.iterdir())
    assert abs(pairs_bytes(settings) / written - 1) < 0.15, written
    assert pairs_bytes(_settings()) == 0


def test_small_captures_are_their_own_probes():
    settings = _settings(texels=8, views=2, lights=3)
    assert probes(settings) == (Probe(8, 2, 3), Probe(8, 2, 3))
    assert capture_seconds(settings, (Timed(5.0, 7.0), Timed(6.0, 8.0))) == 7.0


def test_noise_makes_nothing_negative():
    assert capture_seconds(_settings(), (Timed(2.0, 3.0), Timed(1.0, 1.0))) > 0
    assert capture_seconds(_settings(), (Timed(0.1, 0.2), Timed(100.0, 99.0))) > 0


def test_what_comes_before_counts_once_and_writing_with_the_lights():
    settings = _settings(texels=64, views=30, lights=100)
    few, many = probes(settings)

    def took(probe):
        per_view = probe.views * probe.texels**2
        traced = per_view * (7e-6 + 3e-6 * probe.lights)
        return Timed(traced, 5.0 + traced + 2e-6 * per_view * probe.lights)

    whole = took(Probe(settings.texels, settings.views, settings.lights)).whole
    assert abs(capture_seconds(settings, (took(few), took(many))) / whole - 1) < 0.01


def test_spread_is_even_and_of_all():
    assert list(spread(np.arange(9), 3)) == [1, 4, 7]
    assert list(spread(np.arange(4), 4)) == [0, 1, 2, 3]


def test_memory_is_a_views_images_and_no_more_than_a_gibibyte():
    assert capture_memory(_settings(texels=16, lights=4), 1) == 16 * 16 * 4 * 4 * 2
    assert capture_memory(_settings(texels=16, lights=4, samples=1), 2) == 2 * 16 * 16 * 4 * 3 * 2
    assert capture_memory(_settings(texels=4096), 1) == 1 << 30


def test_words():
    assert [duration(seconds) for seconds in (0.2, 100, 200, 8000)] == [
        "2 seconds",
        "100 seconds",
        "3 minutes",
        "2 hours",
    ]
    text = capture_text(_settings(), (Timed(1.0, 2.0), Timed(2.0, 3.0)), 2)
    assert text.startswith("About ")
    assert text.endswith(" MB of additional memory")
