"""What settings meant in earlier releases.

The identifier of a property, its type and the numbers of its choices never change meaning: a test holds them
to the table that each release has in blend-tests/releases. What has to change all the same is a Step.
"""

from collections.abc import Callable
from typing import NamedTuple


class Step(NamedTuple):
    version: tuple  # the first release that has the new meaning
    owner: type  # of the settings: bpy.types.Scene, ShaderNodeTexImage, ...
    apply: Callable  # changes the settings of an owner that an earlier release has saved


STEPS = []  # in the order of releases
