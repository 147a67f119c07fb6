"""velour export MODEL --to TARGET: files that other programs read, and the errors beside them."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree

import inputs
import pytest
from command_line import refused, velour
from velour.core.analytic.materialx import document
from velour.core.analytic.open_pbr import OpenPbr

ANGLES = ["5", "30", "60", "75", "85"]


@pytest.fixture(scope="module")
def exported(model_file, tmp_path_factory):
    """Path and report by target."""
    folder, results = tmp_path_factory.mktemp("export"), {}
    for target, suffix in (("openpbr", ".mtlx"), ("principled", ".json"), ("gltf", ".gltf")):
        path = folder / f"2 paint{suffix}"
        results[target] = path, velour("export", model_file, "--to", target, "-o", path, "--json").json
    return results


def test_reports_state_errors(exported):
    for path, report in exported.values():
        assert list(report["by_view_angle"]) == ANGLES
        assert 0 < report["relative_l2"] < 0.6
        assert report["bytes"] == path.stat().st_size


def test_open_pbr_is_at_least_as_close_as_principled(exported):
    assert exported["openpbr"][1]["relative_l2"] < exported["principled"][1]["relative_l2"] + 0.005


def test_the_document_holds_the_parameters_and_the_error(exported):
    path, report = exported["openpbr"]
    shader = ElementTree.parse(path).getroot().find("open_pbr_surface")
    values = {each.get("name"): each.get("value") for each in shader}
    assert set(values) == set(report["parameters"])
    assert float(values["specular_roughness"]) == pytest.approx(
        report["parameters"]["specular_roughness"], rel=1e-4
    )
    assert f"{report['relative_l2']:.3f}" in shader.get("doc")


def test_materialx_accepts_the_document(exported):
    materialx = pytest.importorskip("MaterialX", reason="no MaterialX: pip install materialx")
    library, document = materialx.createDocument(), materialx.createDocument()
    materialx.loadLibraries(
        materialx.getDefaultDataLibraryFolders(), materialx.getDefaultDataSearchPath(), library
    )
    materialx.readFromXmlFile(document, str(exported["openpbr"][0]))
    document.importLibrary(library)
    valid, message = document.validate()
    assert valid, message
    (material,) = document.getMaterialNodes()
    (shader,) = materialx.getShaderNodes(material)
    definition = shader.getNodeDef()
    assert definition is not None
    for given in shader.getInputs():
        assert definition.getActiveInput(given.getName()).getType() == given.getType()
    shader.getInput("coat_ior").setType("color3")
    assert not document.validate()[0]


def test_a_brushed_model_lies_along_its_rougher_direction(tmp_path):
    path = tmp_path / "brushed.mtlx"
    report = velour("export", inputs.BRUSHED_MODEL, "--to", "openpbr", "-o", path, "--json").json
    assert report["parameters"]["specular_roughness_anisotropy"] > 0.2
    principled = tmp_path / "brushed.json"
    velour("export", inputs.BRUSHED_MODEL, "--to", "principled", "-o", principled, "--quiet")
    is_turned = json.loads(principled.read_text())["parameters"]["anisotropic_rotation"] > 0
    assert (ElementTree.parse(path).getroot().find("bitangent") is not None) == is_turned


def test_a_turned_tangent_is_in_the_space_of_the_surface():
    text = document("brushed", OpenPbr(), along_bitangent=True, note="")
    assert ElementTree.fromstring(text).find("bitangent/input[@name='space']").get("value") == "world"


def test_gltf_declares_what_it_uses(exported):
    document = json.loads(exported["gltf"][0].read_text())
    (material,) = document["materials"]
    assert set(material["extensions"]) == set(document["extensionsUsed"])
    assert len(material["pbrMetallicRoughness"]["baseColorFactor"]) == 4
    assert material["extras"]["velour"]["relative_l2"] == exported["gltf"][1]["relative_l2"]


def test_wrong_requests_are_refused(model_file, tmp_path):
    to_file = "export", model_file, "--to", "openpbr", "-o"
    assert "writes a .mtlx file" in refused(*to_file, tmp_path / "paint.json")
    assert "does not exist" in refused(*to_file, tmp_path / "none/paint.mtlx")
    btf = refused("export", inputs.BTF_MODEL, "--to", "gltf", "-o", tmp_path / "weave.gltf")
    assert "takes models of BRDFs" in btf
    assert list(tmp_path.iterdir()) == []
