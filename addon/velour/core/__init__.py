"""Work on plain files and numpy arrays; never imports bpy."""
