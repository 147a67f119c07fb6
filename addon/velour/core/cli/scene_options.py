"""Options of every verb that fits a scene model."""

from __future__ import annotations

import argparse
import contextlib

from ...native import Model, Observation
from ...native.errors import refuse


def load(args: argparse.Namespace, opened: contextlib.ExitStack) -> dict:
    """--for-scene and --full-model as options of the jobs; `opened` closes their files."""
    if args.full_model and not args.for_scene:
        raise refuse("--full-model is only used to fit a scene model; add --for-scene, or leave it out.")
    given = {"for_scene": (Observation, args.for_scene), "full_model": (Model, args.full_model)}
    return {name: opened.enter_context(kind.load(path)) for name, (kind, path) in given.items() if path}
