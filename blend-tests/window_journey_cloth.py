"""From a new tile to a rendered cloth with a silhouette, as an artist does it in a window."""

import bpy

from support import inputs, journeys, scenes

LONG = "an artist's clicks, one after the other; test_tile_steps takes the steps without a window"
OWN_PROCESS = "it starts from factory settings and without earlier files"
ALONE = "its seconds are those of a machine that does nothing else"
SCREEN = "1400x900"
CLICKS, SECONDS = 15, 420
_TILE = "Plain Weave"
_ENABLED = 0.45  # contrast of the text of a button; a gray one has about half of 0.65


def start(folder):
    """Called by the harness once the window is there."""
    journeys.start(folder, cloth_on_a_cube)


def cloth_on_a_cube(folder):
    """The cube is selected when the tile is added, so that it is the target."""
    with journeys.artist_at(folder) as artist:
        yield from journeys.choose_engine(artist)
        cube = bpy.data.objects["Cube"]
        for text in ("Add", "Mesh", "Mesostructure", _TILE):
            yield from artist.click(text, "VIEW_3D")
        yield from artist.until(lambda: _TILE in bpy.data.objects, "the tile is there")
        settings = bpy.data.objects[_TILE].velour
        yield from artist.click_tab("OBJECT")
        yield from _waits(artist, "Make Material", "Capture the tile first.")
        yield from artist.click("Capture BTF", "PROPERTIES")
        yield from _ended(artist, lambda: _sees_enabled(artist, "Make Material"), "the capture")
        yield from artist.click("Make Material", "PROPERTIES")
        yield from _ended(artist, lambda: settings.material is not None, "the fit")
        yield from artist.click("Add Silhouette", "PROPERTIES")
        yield from _ended(artist, lambda: _has_silhouette(settings.material), "the silhouette")
        yield from artist.click("Apply Material", "PROPERTIES")
        yield from artist.until(lambda: cube.active_material == settings.material, "the cube wears the cloth")
        pixels = yield from journeys.rendered(artist)
        yield from artist.finish(CLICKS, SECONDS)
        journeys.assert_measured(cube, pixels)


def _waits(artist, button, reason):
    """The button is gray, and says why."""
    for text in (reason, button):
        yield from artist.look_for(text, "PROPERTIES")
    assert not _sees_enabled(artist, button), f"{button} is not gray"


def _sees_enabled(artist, text):
    """Whether a button has the contrast of one that can be pressed."""
    place = artist.sees(text, "PROPERTIES")
    return place is not None and place.contrast > _ENABLED


def _ended(artist, holds, what):
    yield from artist.until(lambda: journeys.no_job() and holds(), f"{what} ends", SECONDS)


def _has_silhouette(material):
    image = scenes.velour_node(material).image
    with inputs.native().Model.from_bytes(image.packed_file.data, image.name) as model:
        return "shell" in model.info()
