"""The panels of a tab of the Properties editor, in the order in which Blender draws them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import bpy
from support import inputs

from .headers import Header


class Place(NamedTuple):
    label: str
    header: Header
    end: int | None  # row of the next header; None: the last panel


def places(tab: str, headers: list[Header]) -> list[Place]:
    """Assigns headers to panels; the lowest panels may be out of view. The context must be the editor's."""
    named = list(_named(_shown(tab, ""), tab, iter(headers)))
    if len(named) < len(headers):
        raise ValueError(f"tab {tab}: {len(headers)} headers on the screen, {len(named)} panels known")
    ends = [header.row for _, header in named[1:]] + [None]
    return [Place(label, header, end) for (label, header), end in zip(named, ends, strict=True)]


def _named(classes: list[type], tab: str, headers: Iterator[Header]) -> Iterator[tuple[str, Header]]:
    for panel in classes:
        header = next(headers, None)
        if header is None:
            return
        yield panel.bl_label, header
        if header.is_open:
            yield from _named(_shown(tab, panel.__name__), tab, headers)


def _shown(tab: str, parent: str) -> list[type]:
    return [
        panel
        for panel in sorted(_registered(), key=lambda panel: getattr(panel, "bl_order", 0))
        if getattr(panel, "bl_context", "") == tab.lower()
        and panel.bl_space_type == "PROPERTIES"
        and getattr(panel, "bl_parent_id", "") == parent
        and "HIDE_HEADER" not in getattr(panel, "bl_options", ())
        and (not hasattr(panel, "poll") or panel.poll(bpy.context))
    ]


def _registered() -> list[type]:
    """Blender's own panels in order of definition, then ours in order of registration."""
    ours = [c for c in inputs.module("ui").CLASSES if issubclass(c, bpy.types.Panel)]
    others = [panel for panel in _all(bpy.types.Panel) if panel not in ours and panel.is_registered]
    return others + ours


def _all(base: type) -> Iterator[type]:
    for panel in base.__subclasses__():
        yield panel
        yield from _all(panel)
