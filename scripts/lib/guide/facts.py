"""Velour's information about a material, for the numbers of the pages."""

import importlib

from support import inputs, scenes


def model_info(image) -> dict:
    """info() of the model that an image datablock holds."""
    files = importlib.import_module(f"{inputs.ADDON}.export.files")
    with files.read_model(image, image.name) as model:
        return model.info()


def fit_facts(material) -> dict:
    info = model_info(scenes.velour_node(material).image)
    return {"lobes": info["lobes"], "bytes": info["bytes"], "error": info["relative_l2"]}
