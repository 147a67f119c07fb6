"""What a model is reduced to: options of every verb that fits one for a scene."""

from __future__ import annotations

import argparse
import contextlib

from ...native import Model, Observation
from ...native.errors import refuse


def load(args: argparse.Namespace, opened: contextlib.ExitStack) -> dict:
    """--for-scene and --full-model as the jobs take them; `opened` closes them."""
    if args.full_model and not args.for_scene:
        raise refuse("--full-model goes with --for-scene: it is what a fit for a scene starts from.")
    given = {"for_scene": (Observation, args.for_scene), "full_model": (Model, args.full_model)}
    return {name: opened.enter_context(kind.load(path)) for name, (kind, path) in given.items() if path}
