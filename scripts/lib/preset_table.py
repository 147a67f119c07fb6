"""The materials of the preset library, described by physical quantities that a laboratory could measure.

Each is built by the virtual goniometer (docs/engine/capture.md#micro-surface-goniometer,
docs/engine/mesostructures.md) and a fit; nothing here is a parameter of a model. Colors are albedos, linear
Rec. 709. Refractive indices: acrylic and alkyd binders 1.49 to 1.52, polypropylene 1.49, ABS 1.54, cellulose
1.47, cotton 1.53 to 1.56, silk 1.54 to 1.59, wool 1.55, polyamide 1.53.
"""

from __future__ import annotations

from dataclasses import dataclass, field

METALS, PAINTS, PLAIN, CLOTHS = "Metals", "Paints", "Plastics and Papers", "Cloths"
MATT, HIDES = "Matt Whites and Clays", "Leathers"

# Catalogs of Blender's asset browser. Users' files contain these ids: never change one.
CATALOGS = {
    METALS: "6f3f5b36-31cf-4d4e-9a8b-6a1c0f5ad101",
    PAINTS: "0c6f1b0e-6a35-4a4e-8a3c-3f0c1f6c7b02",
    PLAIN: "b1a9b6c8-4c83-4d9d-8a0e-5d2e8a3b9c03",
    CLOTHS: "e7c2d9f4-90b1-4f53-9b1d-0a4d7c6f2e04",
    MATT: "3b8d2c5e-71f6-4c0a-9a57-d2c4e6f80a05",
    HIDES: "94a0f7d1-2e6b-4d38-8c19-7b5e3f1d6c06",
}


@dataclass(frozen=True)
class Surface:
    """Arguments of velour.native.microsurface_job."""

    roughness: float
    metal: str = "copper"
    anisotropy: float = 1.0
    base_albedo: tuple[float, float, float] = (0.0, 0.0, 0.0)
    base_share: float = 0.0
    ior: float = 0.0
    flake_roughness: float = 0.2


def coat(albedo, roughness, ior=1.5) -> Surface:
    """Pigment below a clear coat."""
    return Surface(roughness, base_albedo=albedo, base_share=1.0, ior=ior)


def flakes(metal, share, flake_roughness, albedo) -> Surface:
    """Car paint: metal flakes over a share of the pigment, below a sprayed clear coat."""
    return Surface(0.04, metal, 1.0, albedo, 1.0 - share, 1.5, flake_roughness)


@dataclass(frozen=True)
class Weave:
    """A tile of velour.native.Tile and the surfaces of its yarns, one per material slot."""

    kind: str
    yarns: tuple[Surface, ...]
    shape: dict = field(default_factory=dict)  # further arguments of Tile.create
    repeats: int = 24  # tiles around the preview's ball, and per unit of texture coordinates


@dataclass(frozen=True, eq=False)
class Preset:
    name: str
    catalog: str
    made_of: Surface | Weave
    description: str
    tags: tuple[str, ...]

    @property
    def file_name(self) -> str:
        return self.name.lower().replace(" ", "_")


def matt(albedo, roughness) -> Surface:
    """A rough surface without a clear interface."""
    return Surface(roughness, base_albedo=albedo, base_share=1.0)


def _metal(name, surface, description, *tags) -> Preset:
    return Preset(name, METALS, surface, description, (surface.metal, *tags))


PRESETS = (
    _metal("Polished Gold", Surface(0.1, "gold"), "Jeweller's gold, polished", "shiny", "warm"),
    _metal("Satin Copper", Surface(0.25, "copper"), "Freshly scoured copper", "satin", "warm"),
    _metal("Brushed Aluminium", Surface(0.3, "aluminium", 3.0), "Brushed along v", "brushed", "anisotropic"),
    _metal(
        "Tarnished Silver",
        Surface(0.18, "silver", 1.0, (0.05, 0.04, 0.03), 0.12),
        "Silver with dull spots",
        "aged",
    ),
    _metal(
        "Cast Iron",
        Surface(0.45, "iron", 1.0, (0.06, 0.05, 0.045), 0.25),
        "As it left the mould",
        "rough",
        "dark",
    ),
    _metal("Polished Chromium", Surface(0.06, "chromium"), "Chrome plating", "shiny"),
    _metal("Blasted Titanium", Surface(0.4, "titanium"), "Bead-blasted titanium", "matt"),
    _metal(
        "Brushed Nickel",
        Surface(0.24, "nickel", 2.5),
        "Door hardware, brushed along v",
        "brushed",
        "anisotropic",
    ),
    _metal(
        "Brushed Brass",
        Surface(0.22, "brass", 2.5),
        "Yellow brass, brushed along v",
        "brushed",
        "anisotropic",
    ),
    Preset("Red Enamel", PAINTS, coat((0.55, 0.015, 0.01), 0.06), "Gloss enamel", ("gloss", "red")),
    Preset(
        "White Lacquer", PAINTS, coat((0.86, 0.85, 0.82), 0.12), "Satin gloss lacquer", ("satin", "white")
    ),
    Preset(
        "Matt Wall Paint", PAINTS, coat((0.42, 0.5, 0.4), 0.55), "Emulsion paint, sage", ("matt", "green")
    ),
    Preset(
        "Silver Car Paint",
        PAINTS,
        flakes("aluminium", 0.75, 0.2, (0.2, 0.2, 0.21)),
        "Aluminium flakes below a clear coat",
        ("flakes", "car"),
    ),
    Preset(
        "Midnight Car Paint",
        PAINTS,
        flakes("aluminium", 0.04, 0.22, (0.005, 0.02, 0.14)),
        "Deep blue with few flakes, below a clear coat",
        ("flakes", "car", "blue"),
    ),
    Preset(
        "Copper Car Paint",
        PAINTS,
        flakes("copper", 0.5, 0.22, (0.3, 0.06, 0.015)),
        "Copper flakes in orange below a clear coat",
        ("flakes", "car", "warm"),
    ),
    Preset(
        "Black Piano Plastic",
        PLAIN,
        coat((0.006, 0.006, 0.007), 0.05, 1.54),
        "Injection-moulded ABS, polished",
        ("gloss", "black"),
    ),
    Preset(
        "Orange Polypropylene",
        PLAIN,
        coat((0.75, 0.2, 0.02), 0.28, 1.49),
        "Moulded, finely eroded",
        ("satin", "orange"),
    ),
    Preset(
        "Black Rubber", PLAIN, coat((0.018, 0.018, 0.019), 0.42, 1.52), "Moulded rubber", ("matt", "black")
    ),
    Preset(
        "Office Paper", PLAIN, coat((0.86, 0.87, 0.88), 0.7, 1.47), "Uncoated white paper", ("matt", "white")
    ),
    Preset(
        "Kraft Paper",
        PLAIN,
        coat((0.47, 0.3, 0.16), 0.6, 1.47),
        "Unbleached wrapping paper",
        ("matt", "brown"),
    ),
)

PRESETS += (
    Preset(
        "Diffuse White", MATT, matt((0.92, 0.92, 0.92), 0.2), "Sintered white standard", ("matt", "white")
    ),
    Preset("Plaster", MATT, matt((0.78, 0.75, 0.7), 0.5), "Dry plaster of Paris", ("matt", "white")),
    Preset("Terracotta", MATT, matt((0.5, 0.19, 0.09), 0.45), "Unglazed fired clay", ("matt", "clay")),
    Preset(
        "Glazed Porcelain", MATT, coat((0.8, 0.79, 0.76), 0.05, 1.5), "White clay below a glaze", ("gloss",)
    ),
)


def _yarn(albedo, roughness=0.5, ior=1.54) -> Surface:
    return coat(albedo, roughness, ior)


_SILK = 0.25  # roughness of silk filaments

PRESETS += (
    Preset(
        "Linen",
        CLOTHS,
        Weave(
            "weave",
            (_yarn((0.58, 0.49, 0.36)), _yarn((0.62, 0.54, 0.41))),
            {"size": 0.003, "gap": 0.18, "irregularity": 0.35},
        ),
        "Loose plain weave of flax",
        ("natural", "plain weave"),
    ),
    Preset(
        "Shot Silk",
        CLOTHS,
        Weave(
            "weave",
            (_yarn((0.05, 0.12, 0.5), _SILK, 1.57), _yarn((0.7, 0.16, 0.06), _SILK, 1.57)),
            {"size": 0.0012, "gap": 0.04, "thickness": 0.2, "irregularity": 0.05},
        ),
        "Blue warp, orange weft: turns its color with the view",
        ("shiny", "plain weave"),
    ),
    Preset(
        "Denim",
        CLOTHS,
        Weave(
            "twill",
            (_yarn((0.03, 0.05, 0.14), 0.6), _yarn((0.7, 0.68, 0.62), 0.6)),
            {"size": 0.003, "irregularity": 0.25},
        ),
        "Indigo warp over undyed weft",
        ("twill", "blue", "cotton"),
    ),
    Preset(
        "Wool Twill",
        CLOTHS,
        Weave(
            "twill",
            (_yarn((0.16, 0.03, 0.045), 0.7, 1.55), _yarn((0.1, 0.02, 0.04), 0.7, 1.55)),
            {"size": 0.004, "thickness": 0.45, "irregularity": 0.4},
        ),
        "Burgundy suiting",
        ("twill", "red", "wool"),
    ),
    Preset(
        "Tulle",
        CLOTHS,
        Weave("net", (_yarn((0.82, 0.82, 0.84), 0.2, 1.53),), {"size": 0.008}),
        "Open net of polyamide",
        ("open", "white", "net"),
    ),
    Preset(
        "Corduroy",
        CLOTHS,
        Weave("corduroy", (_yarn((0.27, 0.13, 0.05), 0.7),)),
        "Cotton, some seven wales a centimetre",
        ("ribs", "brown", "cotton"),
    ),
)

PRESETS += (
    Preset(
        "Ivory Satin",
        CLOTHS,
        Weave(
            "satin",
            (_yarn((0.78, 0.7, 0.55), _SILK, 1.56), _yarn((0.74, 0.66, 0.52), 0.35, 1.56)),
            {"size": 0.0015, "thickness": 0.15, "irregularity": 0.08},
        ),
        "Warp-faced satin of silk",
        ("shiny", "silk", "white"),
    ),
    Preset(
        "Crimson Velvet",
        CLOTHS,
        Weave(
            "velvet",
            (_yarn((0.09, 0.004, 0.01), 0.6), _yarn((0.42, 0.012, 0.04), 0.3)),
            {"irregularity": 0.6},
        ),
        "Cut pile on a woven ground",
        ("pile", "red"),
    ),
    Preset(
        "Knitted Wool",
        CLOTHS,
        Weave("knit", (_yarn((0.55, 0.5, 0.42), 0.7, 1.55),), {"irregularity": 0.25}, repeats=16),
        "Plain knit of three-ply wool, undyed",
        ("knit", "wool", "natural"),
    ),
    Preset(
        "Steel Mail",
        METALS,
        Weave("chainmail", (Surface(0.22, "iron"),), {"size": 0.02}, repeats=16),
        "European four-in-one chain mail",
        ("open", "iron"),
    ),
    Preset(
        "Brown Leather",
        HIDES,
        Weave("leather", (coat((0.2, 0.075, 0.03), 0.3, 1.5),), {"size": 0.008}, repeats=16),
        "Full-grain leather, waxed",
        ("leather", "brown", "satin"),
    ),
    Preset(
        "Black Leather",
        HIDES,
        Weave(
            "leather",
            (coat((0.012, 0.012, 0.013), 0.22, 1.5),),
            {"size": 0.006, "thickness": 0.16},
            repeats=16,
        ),
        "Finely grained leather, polished",
        ("leather", "black", "shiny"),
    ),
)
