"""What scripts/test runs, how it counts, and what it says. Uses Python's own library alone."""
