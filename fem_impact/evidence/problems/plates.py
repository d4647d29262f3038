"""``plate`` and ``thin-plate``: a sphere on infinite elastic plates, whose bending waves take energy (Zener).

``plate`` is a scene, whose plan decides whether the plate is thin beside the contact and meshed through.
``thin-plate`` asks for what no scene can say: a mesh through a plate that is thick beside its contact, and
edges twice as far away.
"""

from dataclasses import dataclass, replace
from math import exp, log, sqrt

from fem_impact.evidence.problems import setups, spheres
from fem_impact.evidence.problems.problem import Check, Solved, Values, within
from fem_impact.evidence.references.hertz import PlateImpact, zener_impact
from fem_impact.physics.plate import plate_impedance, pulse_wave
from fem_impact.scene.barrier import Barrier
from fem_impact.solid.model import Model

RESTITUTION, FORCE, TIME = 0.02, 0.03, 0.03
ENERGY, ENERGY_THROUGH = 1e-3, 1e-4  # that a ledger may miss; a scene's ball has arcs of 0.5 degrees a piece
STRIKES = 3
AFTER, LONG = 1.1, 4.0  # contact times that are followed
FARTHER = 2.0  # distance of the edges in the run that another is compared with
WIDER = 0.002  # of e, by that
LEFT = 0.1  # of the energy of the bending waves, that the plate still holds after `LONG` contact times
LOCAL = "Zener's plate is a half-space under the contact, and gives way as a whole by its impedance"


def unit_of_time(p: Values) -> float:
    """Return T = (m / (k sqrt(v)))^(2/5), s, with k = 4/3 E* sqrt(R)."""
    stiffness = 4 / 3 * spheres.modulus(p) * p["radius"] ** 0.5
    return float((spheres.ball_mass(p) / (stiffness * p["speed"] ** 0.5)) ** 0.4)


def _thickness(p: Values, number: float) -> float:
    """Return the thickness, m, of the plate of a number of Zener's; the impedance grows as its square."""
    impedance = spheres.ball_mass(p) / (number * unit_of_time(p))
    return sqrt(impedance / plate_impedance(p["E"], p["nu"], p["rho"], 1.0))


@dataclass(frozen=True, slots=True)
class PlateStrike:
    """An impact on a plate.

    Attributes
    ----------
    impact : setups.TipImpact; e : restitution
    missed : what the ledger misses over E_0
    held : share of the bending waves' energy that is still in the mesh of the plate
    cells : number of the ball's cells
    """

    impact: setups.TipImpact
    e: float
    missed: float
    held: float
    cells: int

    @classmethod
    def of(cls, p: Values, model: Model, end: float) -> "PlateStrike":
        """Run a model until ``end``, s."""
        E_0 = 0.5 * spheres.ball_mass(p) * p["speed"] ** 2
        impact = setups.run_strike(model, end, spheres.plain_hertz(p, p["speed"]).duration)
        ledger = model.ledger()
        ledger.start = E_0
        spent = ledger.sample(impact.state)
        held = sum(spent.get(name, 0.0) for name in ("kinetic_barrier", "strain_barrier"))
        e, missed = impact.motion.V_n / p["speed"], abs(spent["residual"]) / E_0
        cells = len(model.geometry.rod.mesh.cells)
        return cls(impact, e, missed, held / (held + spent["plate"]), cells)

    def beside_zener(self, p: Values, exact: PlateImpact, at: str, energy: float) -> tuple[Check, ...]:
        """Return restitution, force and contact time beside Zener's equation, and the balance of energy."""
        T = unit_of_time(p)
        force = spheres.ball_mass(p) * p["speed"] / T * exact.peak
        return (
            Check(f"e, {at}", "1", self.e, exact.restitution, RESTITUTION, "absolute"),
            Check(f"largest force, {at}", "N", self.impact.force, force, FORCE),
            Check(f"contact time, {at}", "s", self.impact.duration, exact.duration * T, TIME),
            Check(f"energy ledger / E_0, {at}", "1", self.missed, 0.0, energy, "at most"),
        )


def _scene_strike(p: Values, number: float, exact: PlateImpact) -> PlateStrike:
    """Return the impact of a scene's ball on its plate of a number of Zener's."""
    metal, touch = setups.steel(p), spheres.plain_hertz(p, p["speed"]).radius
    model = setups.falling(
        setups.ball(p, metal),
        Barrier(metal, thickness=_thickness(p, number), support="infinite"),
        ("barrier-elastic" if p["block"] else "barrier-rigid", "plate-bending"),
        p["speed"],
        tip_size=setups.fine_tip(touch, p["cells"]),
        across=int(p["across"]),
        block_margin=max(spheres.MARGIN * touch, 4 * p["radius"] / p["across"]),
    )
    return PlateStrike.of(p, model, AFTER * exact.duration * unit_of_time(p))


def solve_plate(p: Values) -> Solved:
    """Compare restitution, force and contact time with Zener's equation, on plates of several thicknesses.

    Raises
    ------
    SceneError
        If the contact is no spot on the sphere, or the numbers are in no order.
    """
    spheres.small_contact(p)
    within(p, "most", 1.01 * p["least"], 2.0, "", "above the least, and the sphere leaves the plate soon.")
    low, high = log(p["least"]), log(p["most"])
    numbers = [exp(low + (high - low) * i / (STRIKES - 1)) for i in range(STRIKES)]
    exact = [zener_impact(number) for number in numbers]
    runs = [_scene_strike(p, number, answer) for number, answer in zip(numbers, exact, strict=True)]
    checks = (
        check
        for number, answer, run in zip(numbers, exact, runs, strict=True)
        for check in run.beside_zener(p, answer, f"lambda {number:.3g}", ENERGY)
    )
    return Solved(tuple(checks), max(run.impact.state.step for run in runs), runs[0].cells)


def _through(p: Values, plate: spheres.StruckPlate, end: float) -> PlateStrike:
    """Return an impact on a plate that is meshed through its thickness, until ``end``, s."""
    model = spheres.sphere_model(p, spheres.plain_hertz(p, p["speed"]), p["speed"], plate=plate)
    return PlateStrike.of(p, model, end)


def _plate(p: Values, time: float) -> tuple[spheres.StruckPlate, str]:
    """Return the plate for a contact of ``time``, s, and how wide the contact is."""
    thickness = _thickness(p, p["number"])
    speed, edges = pulse_wave(p["E"], p["nu"], p["rho"], thickness, time)
    width = 2 * spheres.plain_hertz(p, p["speed"]).radius / thickness
    return spheres.StruckPlate(thickness, edges, speed), f"contact {width:.2g} of the thickness wide"


def _wide(p: Values, exact: PlateImpact) -> tuple[Check, ...]:
    """Compare a plate that is thin beside its contact with a wider one, and with Zener's half-space."""
    time = exact.duration * unit_of_time(p)
    plate, at = _plate(p, time)
    near = _through(p, plate, LONG * time)
    wider = _through(p, replace(plate, edges=FARTHER * plate.edges), AFTER * time)
    held = f"held after {LONG:g} contact times / bending waves, {at}"
    return (
        Check(f"e, its edges {FARTHER:g} times as far, {at}", "1", near.e, wider.e, WIDER, "absolute"),
        Check.shown(f"e by Zener's equation, {at}", "1", near.e, exact.restitution, LOCAL),
        Check(held, "1", near.held, 0.0, LEFT, "at most"),
        Check(f"energy ledger / E_0, {at}", "1", near.missed, 0.0, ENERGY_THROUGH, "at most"),
    )


def solve_thin_plate(p: Values) -> Solved:
    """Strike a plate that is thick beside the contact, and faster one that is thin beside it.

    Raises
    ------
    SceneError
        If the slow contact is no spot on the sphere, or the speeds are in no order.
    """
    spheres.small_contact(p)
    within(p, "fast", 1.01 * p["speed"], 1e3, "m/s", "above the slow speed.")
    exact = zener_impact(p["number"])
    time = exact.duration * unit_of_time(p)
    plate, at = _plate(p, time)
    slow = _through(p, plate, AFTER * time)
    checks = slow.beside_zener(p, exact, at, ENERGY_THROUGH)
    return Solved((*checks, *_wide({**p, "speed": p["fast"]}, exact)), slow.impact.state.step, slow.cells)
