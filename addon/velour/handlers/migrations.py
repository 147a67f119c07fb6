"""Converts settings from earlier releases.

The identifier of a property, its type and the numbers of its choices never change meaning: a test compares
them with each release's table in blend-tests/releases. An inevitable change is a Step.
"""

from collections.abc import Callable
from typing import NamedTuple


class Step(NamedTuple):
    version: tuple  # the first release that has the new meaning
    owner: type  # type that has the settings: bpy.types.Scene, ShaderNodeTexImage, ...
    apply: Callable  # converts the settings of an owner that an earlier release has saved


STEPS = []  # in the order of releases
