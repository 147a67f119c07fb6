"""Measures the pages of docs/results: scripts/bench NAME."""
