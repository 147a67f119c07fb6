"""What later versions will have: parsed, and refused with a sentence (status 1) instead of misread."""

from __future__ import annotations

import argparse

from ...native.errors import Status, VelourError
from ...native.version import version_text


def refusal(what: str, instead: str) -> VelourError:
    return VelourError(Status.UNSUPPORTED, f"Velour {version_text()} does not have {what} yet; {instead}.")


def add_later(parser: argparse.ArgumentParser, flag: str, instead: str, metavar: str) -> None:
    """An option that no value is taken of yet."""
    action = parser.add_argument(flag, metavar=metavar, help="a later version has it")
    parser.set_defaults(later=[*(parser.get_default("later") or []), (action.dest, flag, instead)])


def refuse_later(args: argparse.Namespace) -> None:
    for name, flag, instead in getattr(args, "later", None) or []:
        if getattr(args, name) is not None:
            raise refusal(flag, instead)


def only(flag: str, value: str, supported: tuple[str, ...]) -> None:
    if value not in supported:
        raise refusal(f"{flag} {value}", f"use {' or '.join(supported)}")
