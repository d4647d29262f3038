"""The scene: what the user states about rod, barrier, surface, impact, effects and accuracy.

SI units inside. Every part checks itself when it is made, so a scene from a file and a scene from Python
are the same object and pass the same checks.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import get_args

from fem_impact.errors import SceneError
from fem_impact.scene import fields
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.checks import check_choice, check_id, check_names, check_numbers, check_text
from fem_impact.scene.fields import Fields
from fem_impact.scene.impact import FIRST, WAYS, Impact
from fem_impact.scene.material import Material, Surface
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.strikes import Following

MEASURED_SETS = (
    *("t2", "t3-machined", "t3-contaminated", "t3-cleaned", "t4"),
    *("t5a", "t5b", "t5c", "t5d", "t6-17", "t6-25", "t6-37", "t6-60"),
)

OWN = ".csv"
"""End of a name in ``measured`` that is a file of the user's own tests, not a published set."""


@dataclass(frozen=True, slots=True)
class Accuracy:
    """What the answer may cost: element size at the tip and margin of the block in m, latest time in s.

    ``step`` is the time step over the largest stable one. ``element`` names the operator of cells that
    cannot yield: with incompatible modes, fully integrated, or with mean dilatation (B-bar).
    ``yielding_element`` names that of cells that may yield; plain full integration locks there, it is meant
    for comparisons with codes that have it.
    ``fine_zone`` says where the finest cells lie: right under the contact, with larger ones around them, or
    all over the zone in which cells may yield, which shows what the grading saves.
    ``unresolved`` says whether coefficients and shares of a contact that the mesh does not resolve are
    withheld (null, with the reason) or reported all the same.
    ``grid_shift`` is the place of a meshed barrier's grid along t, in cells at the contact.
    ``across`` that is not stated follows from the projectile, see `Scene.across`; ``max_time`` from the rod's
    bending and the contact time, see `Plan.max_time`.
    ``levels`` is the number of meshes of a finite-element run, of which the last counts.
    ``offsets`` is the number of places of a meshed barrier's grid at which each level but the first runs.
    ``target`` is the wanted relative error; levels then go on until it is reached, by ``target_of`` alone if
    that is stated, else by e and E_vib.
    """

    tip_size: float | None = None
    barrier_size: float | None = None
    mass_scaling: float = 4.0
    across: int | None = None
    grid_shift: float = 0.0
    block_margin: float = 6e-3
    max_time: float | None = None
    step: float = 0.9
    element: fields.Element = "incompatible"
    yielding_element: fields.YieldingElement = "bbar"
    fine_zone: fields.FineZone = "graded"
    unresolved: fields.Unresolved = "withhold"
    target: float | None = None
    target_of: fields.TargetOf | None = None
    levels: int = fields.LEVELS
    offsets: int | None = None

    def __post_init__(self) -> None:
        check_numbers(self, fields.ACCURACY)
        check_choice(self.element, get_args(fields.Element), "element")
        check_choice(self.yielding_element, get_args(fields.YieldingElement), "yielding_element")
        check_choice(self.fine_zone, get_args(fields.FineZone), "fine_zone")
        check_choice(self.unresolved, get_args(fields.Unresolved), "unresolved")
        if self.target_of is not None:
            check_choice(self.target_of, get_args(fields.TargetOf), "target")
        if self.target is not None and not (isinstance(self.target, float) and 0.0 < self.target <= 1.0):
            raise SceneError("must be a share above 0 and at most 1.", key="target", value=self.target)


@dataclass(frozen=True, slots=True)
class Heating:
    """What contact heating is judged by: K, W/(m K), J/(kg K); None: that of the body's material."""

    ignition: float = 703.15
    ambient: float = 293.15
    rod_conductivity: float | None = None
    rod_heat_capacity: float | None = None
    barrier_conductivity: float | None = None
    barrier_heat_capacity: float | None = None
    rod_melting: float | None = None
    barrier_melting: float | None = None

    def __post_init__(self) -> None:
        check_numbers(self, fields.HEATING)


@dataclass(frozen=True, slots=True)
class Save:
    """What is kept of a run: frames of the fields, rows of the histories, samples of the axial strain.

    ``fields``: ``shown`` holds what films and pages show, displacement, von Mises stress and plastic strain;
    ``all`` velocity and the stress tensor too. ``gauge`` is the distance of a strain gauge from the tip, m,
    None without one, ``gauge_across`` its place in radii from the axis, None for 1: the side that faces the
    barrier.
    """

    frames: int = 120
    history_every: int = 20
    strain_samples: int = 1
    gauge: float | None = None
    gauge_across: float | None = None
    fields: Fields = "shown"

    def __post_init__(self) -> None:
        check_numbers(self, fields.SAVE)
        check_choice(self.fields, get_args(fields.Fields), "fields")


@dataclass(frozen=True, slots=True)
class Scene:
    """One impact, completely stated.

    ``measured`` names the published set it repeats, or the CSV file of a user's own tests, if any;
    ``restitution`` (energetic, 0 to 1) is what the rigid fidelity takes instead of Thornton's law.
    ``effects`` is what was stated, with or without ``"auto"``; the plan tells what the model has.
    """

    id: str
    title: str
    projectile: ProjectileSpec
    barrier: Barrier
    surface: Surface
    impact: Impact
    effects: tuple[str, ...] = ("auto",)
    accuracy: Accuracy = Accuracy()
    save: Save = Save()
    heating: Heating = Heating()
    strikes: Following = Following()  # noqa: RUF009
    measured: str | None = None
    restitution: float | None = None

    def __post_init__(self) -> None:
        check_id(self.id, "id")
        check_text(self.title, "title")
        object.__setattr__(self, "effects", check_names(self.effects, "effects"))
        own_tests = isinstance(self.measured, str) and self.measured.endswith(OWN)
        if self.measured is not None and not own_tests:
            other = f"the path of a CSV file of your own tests (*{OWN})"
            check_choice(self.measured, MEASURED_SETS, "measured", other)
        if self.restitution is not None:
            check_numbers(self, fields.TOP)
        _check_approach(self)
        largest = self.projectile.diameter / 4
        size = self.accuracy.tip_size
        if size is not None and size > largest:
            raise SceneError(
                f"is too coarse for a rod of {self.projectile.diameter * 1e3:g} mm diameter.",
                key="accuracy.tip_size",
                value=f"{size * 1e3:.3g} mm",
                remedy=f"Give at most {largest * 1e3:g} mm.",
            )

    @property
    def across(self) -> int:
        """Cells over the diameter of the projectile: those that are stated, or as many as its wall needs."""
        return self.accuracy.across or self.projectile.across

    @property
    def materials(self) -> dict[str, Material]:
        """The materials of both bodies by the section that states them."""
        return {"projectile": self.projectile.material, "barrier": self.barrier.material}

    @property
    def first_impact(self) -> Scene:
        """The scene without what follows its first impact."""
        return replace(self, impact=replace(self.impact, until=FIRST), strikes=Following())

    @property
    def relative(self) -> Impact:
        """The impact as seen from the barrier before it, which a moving barrier changes."""
        impact, barrier = self.impact, self.barrier
        if barrier.v_n == barrier.v_t == 0.0:
            return impact
        v_n, v_t = impact.v_n - barrier.v_n, impact.v_t - barrier.v_t
        return Impact(impact.angle, v_n, v_t, impact.omega, slope=impact.slope, until=impact.until)


def _check_approach(scene: Scene) -> None:
    """Refuse a rod that does not come down on the barrier, as seen from it."""
    seen, moving = scene.impact, scene.barrier.v_n or scene.barrier.v_t
    if seen.stated != WAYS[2] and not moving and not fields.V_N.allows(seen.v_n):
        raise SceneError(
            "lays the axis along the barrier: a rod that moves along it never strikes.",
            key="impact.angle",
            value=fields.ANGLE.write(seen.angle),
            remedy=f"Give v_n and v_t in place of {seen.stated[0]}, or another angle.",
        )
    for parameter in (fields.V_N, fields.V_T):
        key = parameter.key
        seen_speed = getattr(seen, key) - getattr(scene.barrier, key)
        if moving and not parameter.allows(seen_speed):
            problem = f"is {seen_speed:.4g} m/s as seen from the barrier, which moves too."
            value, own = f"{getattr(seen, key):.4g} m/s", getattr(scene.barrier, key)
            limits = f"above {own + parameter.low:.6g} m/s and below {own + parameter.high:.6g} m/s"
            remedy = f"Give a velocity {limits}: the barrier moves at {own:.4g} m/s."
            raise SceneError(problem, key=f"impact.{key}", value=value, remedy=remedy)
        try:
            parameter.checked(seen_speed)
        except SceneError as error:
            raise error.under("impact") from None
