"""Batch rendering of a .blend on engines that exist: docs/reference/farm.md."""
