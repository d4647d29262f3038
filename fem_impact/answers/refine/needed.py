"""How far half-widths of levels are widened so that 95 in 100 of them hold a run with one level more.

Levels may agree by chance in one number, but not in all that an impact leaves. The widest half-width of a
few numbers says how far a scene is from its limit. Scenes drawn at random ran with one level more
(`fem_impact.evidence.studies.coverage`). A half-width is at least ``times`` what the levels tell by
themselves and ``share`` of the widest. Both were chosen for each number so that half-widths are narrow in the
geometric mean, and so large that they hold the differences with confidence: by a tolerance limit of the
stored ones (`fem_impact.case.measured.tolerance_rank`). No distribution is assumed, only that a scene is of
the kind of those that were drawn.
"""

from collections.abc import Mapping
from dataclasses import replace

from fem_impact.case.measured import needed_half_widths
from fem_impact.outcome.groups import Heat
from fem_impact.outcome.keys import Unknown, or_none
from fem_impact.outcome.record import KEY_TABLE, ROUND_OFF, Outcome
from fem_impact.run.heated import below_melting, beyond_melting, open_melting
from fem_impact.run.modal_error import PLASTIC, VIBRATION, unit_of
from fem_impact.scene.types import Scene

MeshNumbers = Mapping[str, float] | Unknown
"""Numbers by the key of an outcome that they are about, or why there are none."""
HELD = 0.95
"""Share of differences from a run with one level more that a half-width is to hold."""
JUDGED = ("e_edge", "mu", "Omega_rad_per_s", "W_friction_over_E_0", *PLASTIC)
"""Keys of the numbers whose widest half-width tells how far a scene is from its limit."""
RISE, TEMPERATURE = "flash_rise_K", "flash_temperature_K"
"""Keys of the rise at the contact and of that over absolute zero, which differ by a constant."""
TIME_ABOVE = "time_above_ignition_s"
"""Key of the time for which the contact is hotter than what must not be reached."""
OPEN = Unknown("not resolved: the flash temperature is not known to either side of the ignition temperature")
OF_PATCH = ("contact_patch_m2", "friction_flux_W_per_m2", RISE, TEMPERATURE)
"""Keys of what rests on the size of the patch."""
# of nodes across the narrow side of a contact, on levels whose values are extrapolated: a line of contact one
# cell wide is pressed as hard as its cells are large, and two levels of it may agree and be wrong together
ROWS = 4
NARROW_PATCH = (
    f"not resolved: the heat spreads over a patch whose narrow side takes {ROWS} nodes, and has {{rows}}"
)
FLOWS = dict(zip(PLASTIC, ("rod-plasticity", "barrier-elastoplastic"), strict=True))
"""Effects that let a body flow, by the key of its plastic work."""


def widest(halves: Mapping[str, float], run: Outcome) -> float:
    """Return the widest half-width of `JUDGED`, over its `unit_of`."""
    return max((halves[key] / unit_of(key, run) for key in JUDGED if key in halves), default=0.0)


def scale_of(key: str, value: float, run: Outcome) -> float | None:
    """Return the scale by which a share of the widest half-width is one of a number; None: it has none.

    That is `unit_of`, of vibration energy, force and heat the number itself; sizes and times have none. What
    is 0 on every level has none: it is so by physics, unless a body may flow whose work it is.
    """
    unit = KEY_TABLE[key].unit
    is_zero = abs(value) < ROUND_OFF and FLOWS.get(key) not in run.provenance.effects
    if is_zero or unit in ("m", "m2", "m3", "s"):
        return None
    return unit_of(key, run) if unit in ("m/s", "rad/s") or (unit == "-" and key != VIBRATION) else abs(value)


def widened(limits: Mapping[str, float], halves: Mapping[str, float], run: Outcome) -> dict[str, float]:
    """Return half-widths, by key, of limits that levels tell, widened; ``run`` is of the finest level."""
    most, wide, factors = widest(halves, run), dict(halves), needed_half_widths()
    for key, half in halves.items():
        # arms a little apart take nearly the same approach; the paper's are known of its rods alone
        needed = factors.get(key.replace("_paper", "_edge"))
        if needed is not None and (scale := scale_of(key, limits[key], run)) is not None:
            wide[key] = max(half, needed["times"] * half + needed["share"] * most * scale)
    if TEMPERATURE in wide and RISE in wide:
        wide[TEMPERATURE] = wide[RISE]
    return wide


def unresolved_heat(
    limits: MeshNumbers, halves: MeshNumbers, run: Outcome, across: int
) -> dict[str, Unknown]:
    """Return why numbers of the heat at the contact, by key, are not known from levels.

    ``run`` is of the finest, with so many nodes ``across`` the narrow side of its contact, `ROWS` where wide.

    The heat spreads over the patch. A line of contact that is hardly wider than a cell is as wide as its
    cells, so that flux and temperature grow as cells shrink, without an end where nothing yields. A time
    above the ignition temperature needs that to lie beside the half-width of the flash temperature.
    """
    if across < ROWS:
        return dict.fromkeys((*OF_PATCH, TIME_ABOVE), Unknown(NARROW_PATCH.format(rows=across)))
    at, half = ((or_none(of) or {}).get(TEMPERATURE) for of in (limits, halves))
    ignition = or_none(run.heat.ignition)
    if at is None or half is None or ignition is None or abs(at - ignition) > half:
        return {}
    return {TIME_ABOVE: OPEN}


def told_heat(
    told: tuple[MeshNumbers, MeshNumbers], run: Outcome, across: int, scene: Scene
) -> tuple[MeshNumbers, MeshNumbers, dict[str, Unknown]]:
    """Return limits and half-widths, and why some of the heat, by key, are not known (`unresolved_heat`).

    Levels may lead beyond a melting point that each of them stays below.
    """
    limits, bands = told
    lost = unresolved_heat(limits, bands, run, across)
    if isinstance(limits, Unknown) or isinstance(bands, Unknown) or TEMPERATURE not in limits:
        return limits, bands, lost
    if isinstance(beyond := below_melting(scene, limits[TEMPERATURE]), Unknown):
        lost |= {RISE: beyond, TEMPERATURE: beyond}
        limits, bands = ({key: of[key] for key in of if key not in lost} for of in (limits, bands))
    return limits, bands, lost


def known_heat(run: Outcome, lost: Mapping[str, Unknown], before: Outcome | None = None) -> Heat:
    """Return the heat of a run without the numbers, by key, that are lost for a reason.

    What the run did not know keeps its own reason, but for a body that melts under a patch that is lost. It
    is sure to melt only where it does so on the level ``before`` as well.
    """
    heat = run.heat
    if isinstance(heat.power, Unknown):  # not followed
        return heat
    paths = {KEY_TABLE[key].path[1]: why for key, why in lost.items()}
    told = {at: getattr(heat, at) for at in paths}
    told = {at: paths[at] for at, one in told.items() if or_none(one) is not None or beyond_melting(one)}
    sure = before is None or beyond_melting(before.heat.rise)
    return replace(heat if sure else open_melting(heat), **told)
