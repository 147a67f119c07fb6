"""Takes the user guide's pictures and numbers while performing its steps in the real Blender.

`pages` runs outside Blender; `inside` runs the rest in Blender's window. Chapters may do only what the guide
tells the reader to do.
"""

CHAPTERS = ("install", "preset", "first_material", "library", "tolerance", "scene_model", "tile", "cloth")
