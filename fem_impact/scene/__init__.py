"""The scene: a typed, checked statement of one impact, from a TOML file or from Python."""

from fem_impact.errors import SceneError
from fem_impact.scene.effect_names import BARRIERS, NAMES
from fem_impact.scene.fields import DEFAULTS, Default
from fem_impact.scene.library import load, material, materials, shipped, source_of, surface, surfaces
from fem_impact.scene.replace import replace_all
from fem_impact.scene.types import (
    MEASURED_SETS,
    Accuracy,
    Barrier,
    Heating,
    Impact,
    Material,
    Projectile,
    Save,
    Scene,
    Surface,
)
from fem_impact.scene.units import format_quantity, parse_quantity
from fem_impact.scene.validity import validity

__all__ = [
    "BARRIERS",
    "DEFAULTS",
    "MEASURED_SETS",
    "NAMES",
    "Accuracy",
    "Barrier",
    "Default",
    "Heating",
    "Impact",
    "Material",
    "Projectile",
    "Save",
    "Scene",
    "SceneError",
    "Surface",
    "format_quantity",
    "load",
    "material",
    "materials",
    "parse_quantity",
    "replace_all",
    "shipped",
    "source_of",
    "surface",
    "surfaces",
    "validity",
]
