"""Reads velour.h: functions with their argument counts, structs with their fields, the values of enums."""

from __future__ import annotations

import re
from pathlib import Path

HEADER = Path(__file__).resolve().parents[2] / "native/include/velour/velour.h"


def text() -> str:
    """The header without comments."""
    return re.sub(r"/\*.*?\*/", " ", HEADER.read_text(), flags=re.DOTALL)


def functions() -> dict[str, tuple[str, int]]:
    """Name -> (result type, number of arguments)."""
    found = {}
    for result, name, arguments in re.findall(r"VLR_API\s+([\w\s*]+?)\s*(vlr_\w+)\(([^)]*)\)\s*;", text()):
        arguments = arguments.strip()
        found[name] = (result, 0 if arguments in ("", "void") else arguments.count(",") + 1)
    return found


def structs() -> dict[str, list[str]]:
    """Name -> field names in order."""
    found = {}
    for name, body in re.findall(r"typedef struct (vlr_\w+) \{(.*?)\}", text(), flags=re.DOTALL):
        declarations = [part for line in body.split(";") for part in line.split(",") if part.strip()]
        found[name] = [re.search(r"(\w+)(?:\[\d+\])?\s*$", part)[1] for part in declarations]
    return found


def constants(prefix: str) -> dict[str, int]:
    return {name: int(value) for name, value in re.findall(rf"({prefix}\w+)\s*=\s*(\d+)", text())}
