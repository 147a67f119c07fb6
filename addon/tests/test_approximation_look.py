"""What tint, exposure and roughness offset make of an approximation's values."""

import inputs
import pytest
from velour.core.approximation import UNFITTED
from velour.core.approximation_look import Look, with_look
from velour.native import Model, model_peer_job


def values(**principled):
    return {
        "principled": {**UNFITTED.principled, **principled},
        "anisotropic": 0.0,
        "diffuse": (0.5, 0.5, 0.5),
    }


def test_a_neutral_look_changes_nothing():
    given = {**values(coat=0.4, specular_tint=(0.9, 0.8, 0.7)), "anisotropic": 0.3}
    shown = with_look(given, Look())
    assert shown["principled"] == pytest.approx(given["principled"])
    assert shown["anisotropic"] == pytest.approx(0.3)
    assert shown["diffuse"] == given["diffuse"]


def test_all_that_a_dielectric_reflects_is_tinted():
    shown = with_look(values(coat=0.6), Look((1.2, 0.6, 0.3)))
    principled = shown["principled"]
    assert shown["diffuse"] == pytest.approx((0.6, 0.3, 0.15))
    assert principled["base_color"] == pytest.approx((0.96, 0.48, 0.24))
    reflected = [principled["specular"] * tint for tint in principled["specular_tint"]]
    assert reflected == pytest.approx([0.6, 0.3, 0.15])
    assert principled["coat"] == pytest.approx(0.6 * 0.7)


def test_the_edge_of_a_metal_keeps_its_tint():
    shown = with_look(values(metallic=1.0, specular_tint=(0.9, 0.8, 0.7)), Look((0.2, 0.5, 0.9)))
    assert shown["principled"]["specular_tint"] == pytest.approx((0.9, 0.8, 0.7))


def test_nothing_is_brighter_than_white():
    shown = with_look(values(coat=1.0), Look((8.0, 8.0, 8.0)))
    assert shown["principled"]["base_color"] == shown["diffuse"] == (1.0, 1.0, 1.0)
    assert shown["principled"]["specular"] == shown["principled"]["coat"] == 1.0


def test_black_stays_without_a_division_by_nothing():
    shown = with_look(values(), Look((0.0, 0.0, 0.0)))
    assert shown["principled"]["specular"] == 0.0
    assert shown["diffuse"] == (0.0, 0.0, 0.0)


def test_squares_of_alphas_add():
    """A mirror takes on the offset itself; stretched highlights are widened along both axes."""
    assert with_look(values(roughness=0.0), Look(roughness=0.4))["principled"]["roughness"] == pytest.approx(
        0.4
    )
    given = {**values(roughness=0.5), "anisotropic": 0.6}
    shown = with_look(given, Look(roughness=0.3))
    aspect = (1 - 0.9 * 0.6) ** 0.5
    wide, narrow = (((0.25 * a) ** 2 + 0.09**2) ** 0.5 for a in (1 / aspect, aspect))
    assert shown["principled"]["roughness"] == pytest.approx((wide * narrow) ** 0.25)
    assert 1 - 0.9 * shown["anisotropic"] == pytest.approx(narrow / wide)


def test_brushed_highlights_get_rounder_as_those_of_the_model():
    """Ratios of alphas. Squared alphas add along both axes, so that the narrower one grows more."""
    model = Model.load(inputs.BRUSHED_MODEL)
    fitted = _ggx(model)["alpha"]
    assert min(fitted) / max(fitted) < 0.3
    for offset, most in ((0.2, 0.05), (0.35, 0.1), (0.5, 0.05), (0.7, 0.1)):
        rough = _ggx(model.roughened(offset))["alpha"]
        added = [(alpha**2 + offset**4) ** 0.5 for alpha in fitted]
        assert min(rough) / max(rough) == pytest.approx(min(added) / max(added), abs=most)


def _ggx(model):
    with model_peer_job(model, "ggx") as job:
        job.run()
        return job.report()["ggx"]
