"""Batch rendering of a .blend with existing render managers: docs/reference/farm.md."""
