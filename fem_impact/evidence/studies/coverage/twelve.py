"""Twelve bodies unlike the rods of the paper, each at five angles; speed and friction are drawn."""

from collections.abc import Mapping

from fem_impact.evidence.studies.coverage.families import Projectile, metres


def _points(*points: tuple[float, float]) -> list[list[str]]:
    """Return points (z, r), mm, as in a scene's file."""
    return [[metres(1e-3 * z), metres(1e-3 * r)] for z, r in points]


def _profile(
    length: float, diameter: float, filled: float, *points: tuple[float, float], hole: float = 0.0
) -> Projectile:
    """Return a turned body with straight lines between points, and a bore of a radius; mm."""
    bore = {"bore": _points((0.0, hole), (length, hole))} if hole else {}
    return Projectile(1e-3 * length, 1e-3 * diameter, filled, {"profile": _points(*points), **bore})


def _mesh(body: str, **sizes: float) -> Projectile:
    """Return a meshed body of sizes in mm."""
    metric = {name: 1e-3 * size for name, size in sizes.items()}
    return Projectile(metric["length"], metric["width"], 0.8, body=body, sizes=metric)


_OGIVE = {
    "shape": "ogive",
    "length": "60 mm",
    "diameter": "16 mm",
    "calibre_radius": 1.5,
    "nose_radius": "2.5 mm",
}
TWELVE: Mapping[str, tuple[Projectile, tuple[float, ...]]] = {
    "chamfered tube": (
        _profile(50.0, 19.0, 0.6, (0.0, 8.5), (1.0, 9.5), (50.0, 9.5), hole=6.0),
        (-50.0, -15.0, 5.0, 30.0, 70.0),
    ),
    "cone": (
        _profile(40.0, 16.0, 0.4, (0.0, 1.5), (30.0, 8.0), (40.0, 8.0)),
        (-60.0, -25.0, 0.0, 15.0, 45.0),
    ),
    "flat pin": (_profile(15.0, 10.0, 1.0, (0.0, 5.0), (15.0, 5.0)), (-40.0, -8.0, 0.0, 20.0, 65.0)),
    "disc on its rim": (_profile(2.0, 24.0, 1.0, (0.0, 12.0), (2.0, 12.0)), (-85.0, -60.0, 45.0, 75.0, 90.0)),
    "plate on its edge": (
        _mesh("plate", length=24.0, width=20.0, thickness=4.0),
        (-30.0, -10.0, 0.0, 5.0, 20.0),
    ),
    "rod on its side": (_profile(40.0, 12.0, 1.0, (0.0, 6.0), (40.0, 6.0)), (-90.0, -86.0, 82.0, 88.0, 90.0)),
    "ogive": (Projectile(60e-3, 16e-3, 0.8, _OGIVE), (-55.0, -20.0, 0.0, 10.0, 40.0)),
    "stepped rod": (
        _profile(60.0, 16.0, 0.8, (0.0, 5.0), (20.0, 5.0), (23.0, 8.0), (60.0, 8.0)),
        (-45.0, -12.0, 4.0, 30.0, 80.0),
    ),
    "corner bar": (_mesh("corner bar", length=40.0, width=14.0), (-50.0, -20.0, 0.0, 12.0, 35.0)),
    "ring": (_profile(6.0, 24.0, 0.6, (0.0, 12.0), (6.0, 12.0), hole=8.0), (-70.0, -30.0, 0.0, 15.0, 85.0)),
    "hexagonal bar": (_mesh("hexagonal bar", length=50.0, width=14.0), (-60.0, -25.0, 0.0, 8.0, 45.0)),
    "bent bar": (_mesh("bent bar", length=50.0, width=10.0, bend=5.0), (-40.0, -15.0, 5.0, 25.0, 55.0)),
}
"""Bodies by name, and the angles, deg, at which each strikes."""
