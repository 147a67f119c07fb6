"""Formulas of OpenPBR and glTF, their fits, and the directions at which they are compared with a model."""

from __future__ import annotations

import numpy as np
import pytest
from velour.core.analytic import gltf, open_pbr
from velour.core.analytic.ggx_terms import Geometry, albedo, lobe
from velour.core.analytic.open_pbr_fit import fit_open_pbr
from velour.core.analytic.parameter_fit import Range, fit
from velour.core.analytic.view_samples import errors, fitted_samples

COATED = open_pbr.OpenPbr(
    base_color=(0.1, 0.3, 0.6),
    base_metalness=0.1,
    specular_roughness=0.45,
    specular_color=(1.0, 0.8, 0.6),
    coat_weight=0.7,
    coat_roughness=0.2,
    coat_ior=1.7,
)
METAL = open_pbr.OpenPbr((0.9, 0.6, 0.3), base_metalness=1.0, specular_color=(0.9, 0.7, 0.8))


class Analytic:
    """What fits ask of a model, answered by a formula."""

    def __init__(self, formula, material, is_isotropic=True, gain=1.0):
        self._formula, self._material, self._is_isotropic, self._gain = formula, material, is_isotropic, gain

    def info(self):
        return {"isotropic": self._is_isotropic}

    def eval(self, wv, wl):
        values = self._formula(self._material, Geometry.of(wv[None], wl[None].astype(float)))[0]
        return self._gain * values / np.maximum(wl[:, 2:], 1e-6), None


def geometry(theta, count=300):
    """A view, lights at the middles of cells of the hemisphere, and their solid angles."""
    cosine, phi = np.meshgrid((np.arange(count) + 0.5) / count, (np.arange(count) + 0.5) * 2 * np.pi / count)
    sine = np.sqrt(1 - cosine**2)
    wl = np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=-1).reshape(1, -1, 3)
    wv = np.array([[np.sin(theta), 0, np.cos(theta)]])
    return Geometry.of(wv, wl), 2 * np.pi / count**2


def albedo_of(formula, material, degrees, count=300):
    g, solid_angle = geometry(np.radians(degrees), count)
    return solid_angle * formula(material, g)[0].sum(0)


@pytest.mark.parametrize("degrees", [10, 60, 80])
@pytest.mark.parametrize("roughness", [0.35, 0.6, 1.0])
def test_the_albedo_table_holds_the_albedo_of_the_lobe(degrees, roughness):
    g, solid_angle = geometry(np.radians(degrees))
    shape, rise = lobe(g, roughness**2, roughness**2), (1 - g.vh) ** 5
    expected = solid_angle * (shape * (1 - rise)).sum(), solid_angle * (shape * rise).sum()
    assert albedo(np.cos(np.radians(degrees)), roughness**2) == pytest.approx(expected, abs=0.012)


@pytest.mark.parametrize("degrees", [10, 60, 80])
def test_white_surfaces_reflect_all_light(degrees):
    white = open_pbr.OpenPbr((1.0, 1.0, 1.0), base_metalness=1.0, specular_roughness=0.8)
    assert albedo_of(open_pbr.f_cos, white, degrees) == pytest.approx(1, abs=0.02)
    assert albedo_of(lambda color, g: open_pbr.diffuse(color, 1.0, g), np.ones(3), degrees) == pytest.approx(
        1, abs=0.01
    )
    coated = white._replace(base_metalness=0.0, coat_weight=1.0, coat_roughness=0.5)
    assert albedo_of(open_pbr.f_cos, coated, degrees) == pytest.approx(1, abs=0.03)


def test_a_metal_has_its_color_in_front_and_its_tint_at_82_degrees():
    front, edge = (albedo_of(open_pbr.f_cos, METAL._replace(specular_roughness=0.3), d) for d in (1, 81.8))
    assert front == pytest.approx(METAL.base_color, abs=0.02)
    untinted = albedo_of(
        open_pbr.f_cos, METAL._replace(specular_color=(1, 1, 1), specular_roughness=0.3), 81.8
    )
    assert edge / untinted == pytest.approx(METAL.specular_color, abs=0.05)


def test_errors_are_those_of_a_gain():
    model = Analytic(open_pbr.f_cos, COATED, gain=1 / 1.1)
    report = errors(model, lambda of: open_pbr.f_cos(COATED, Geometry.of(of.wv, of.wl)))
    assert report["relative_l2"] == pytest.approx(0.1, abs=1e-3)
    assert list(report["by_view_angle"].values()) == pytest.approx([0.1] * 5, abs=1e-3)


def test_a_black_view_has_no_error():
    report = errors(Analytic(open_pbr.f_cos, COATED, gain=0.0), lambda of: of.f_cos)
    assert set(report["by_view_angle"].values()) == {None}


@pytest.mark.parametrize("material", [COATED, METAL])
def test_sampled_lights_integrate_narrow_and_wide_lobes(material):
    samples = fitted_samples(Analytic(open_pbr.f_cos, material), lights=2000)
    sampled = (samples.solid_angle[..., None] * samples.f_cos).sum(1)
    for degrees, view in ((12.5, 2), (57.5, 11), (82.5, 16)):
        expected = albedo_of(open_pbr.f_cos, material, degrees, count=900)
        assert sampled[view] == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("material", [COATED, METAL])
def test_a_fit_recovers_a_material(material):
    model = Analytic(open_pbr.f_cos, material)
    start = material._replace(
        base_color=(0.5, 0.5, 0.5), specular_roughness=0.6, specular_color=(1.0, 1.0, 1.0)
    )
    found = fit_open_pbr(fitted_samples(model, 150), start, True)

    def error(of):
        return errors(model, lambda s: open_pbr.f_cos(of, Geometry.of(s.wv, s.wl)))["relative_l2"]

    assert error(found) < 0.01
    assert error(start) > 0.1


def test_a_fit_recovers_a_brushed_metal():
    brushed = METAL._replace(specular_roughness=0.5, specular_roughness_anisotropy=0.7)
    model = Analytic(open_pbr.f_cos, brushed, is_isotropic=False)
    start = METAL._replace(specular_roughness=0.5, specular_roughness_anisotropy=0.3)
    samples = fitted_samples(model, 40)
    found = fit_open_pbr(samples, start, False)
    assert found.specular_roughness_anisotropy == pytest.approx(0.7, abs=0.02)
    assert fit_open_pbr(samples, start, True).specular_roughness_anisotropy == 0.3


def test_a_diffuse_surface_is_no_metal():
    """A black metal would darken any brighter base to the same picture."""
    color = (0.4, 0.125, 0.2)
    model = Analytic(lambda color, g: np.array(color) * (g.nl / np.pi)[..., None], color)
    start = open_pbr.OpenPbr(base_color=(0.9, 0.9, 0.9), base_metalness=0.45, specular_roughness=1.0)
    found = fit_open_pbr(fitted_samples(model, 100), start, True)
    assert found.base_metalness == 0
    assert found.base_color == pytest.approx(color, rel=0.01)


def test_a_fit_recovers_a_gltf_material():
    material = gltf.Gltf((0.6, 0.2, 0.1), roughness=0.5, clearcoat=0.6, clearcoat_roughness=0.2)
    model = Analytic(gltf.f_cos, material)
    found = gltf.fit_gltf(fitted_samples(model, 150), material._replace(roughness=0.7, clearcoat=0.2), True)
    report = errors(model, lambda s: gltf.f_cos(found, Geometry.of(s.wv, s.wl)))
    assert report["relative_l2"] < 0.01


def test_parameters_stay_in_their_ranges():
    target = np.array([2.0, 0.3])
    found, cost = fit(lambda p: p - target, np.array([0.5, 0.9]), [Range(0, 1), Range(0, 1)])
    assert found == pytest.approx([1.0, 0.3], abs=0.005)
    assert cost == pytest.approx(1.0, abs=1e-3)


def test_the_principled_material_becomes_its_open_pbr_twin():
    from velour.core.approximation import UNFITTED

    twin = open_pbr.OpenPbr.of_principled(
        {**UNFITTED.principled, "metallic": 0.4, "coat": 0.5}, anisotropic=0.8
    )
    assert (twin.specular_ior, twin.base_metalness, twin.coat_weight) == pytest.approx((1.5, 0.4, 0.5))
    alpha_x = twin.specular_roughness**2 * (2 / ((1 - twin.specular_roughness_anisotropy) ** 2 + 1)) ** 0.5
    alpha_y = alpha_x * (1 - twin.specular_roughness_anisotropy)
    assert (alpha_x * alpha_y) ** 0.5 == pytest.approx(0.5**2)  # Blender's alphas: r^2 / a and r^2 a
    assert alpha_y / alpha_x == pytest.approx(1 - 0.9 * 0.8)
