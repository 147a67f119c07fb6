"""What the tests in Blender share."""
