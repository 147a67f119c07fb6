"""The groups, counts and messages of scripts/test. Uses only Python's standard library."""
