"""Findings, pictures and tables of the criterion study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from operator import attrgetter

import numpy as np

from fem_impact.answers.report import Sheet, StudyReport
from fem_impact.arrays import Array
from fem_impact.evidence.studies.criterion_measure import (
    LEVELS,
    Measure,
    Rods,
    blind_ratio,
    error_high,
    error_low,
    error_of,
    exponent,
    gamma_at,
    gamma_of,
    group_of,
    of_body,
    place_at,
    spread_of,
)
from fem_impact.evidence.studies.rods import BODY, DROP_NOTES, MODAL_NOTE, PAPER_RODS, Drop
from fem_impact.evidence.studies.static_give import give_picture, give_sentences, give_sheet, gives_of
from fem_impact.figures.panels import Mark, Panel, Picture, Series
from fem_impact.jobs.run import JobResults
from fem_impact.outcome.keys import known
from fem_impact.outcome.record import Outcome
from fem_impact.tables.table import Cell, Table
from rigid import LIMIT
from rigid.slenderness import EXPONENT

KNOWN = ((0.67, 0.75, 0.83, 0.90, 0.98), (0.98, 0.95, 0.89, 0.84, 0.79))
"""T1/tau and worst e of elastic frictionless drops, derived independently (benchmark problem 8)."""

JUDGED = 0.05  # error of e that the verdict on the limit of Eq 29 allows
HERTZ = ("Hertz, one tip radius", "Hertz, tip in proportion")
YIELDING = "yielding, frictionless, modes"
GROUP, WHOLE = attrgetter("group"), attrgetter("whole")  # T1/tau in both meanings of tau
Families = Mapping[str, Rods]
"""Rods by the name of their family."""
Ends = Sequence[tuple[Drop, float | None, float | None]]
"""Elastic drops with the change of e by vibration, by finite elements and by modes."""
ASSUMPTIONS = (
    *DROP_NOTES,
    MODAL_NOTE,
    "Yielding, contaminated and machined: finite elements on two meshes at two places; the band is that of "
    "the difference of e with and without vibration. All other families: modes, without a band.",
    "Error of rigid theory: change of e, at the worst of the angles from 1 to 80 degrees, against a "
    "rod that cannot vibrate on the same contact. At 0 degrees a flat face has no one contact point.",
    "Linear spring: bending and stretching modes of the slender rod, one stiffness for all rods, as "
    "long a contact as Hertz' for 19 mm, gamma 26.45, 45 degrees, 2.1 m/s; solved exactly.",
    "T1: first bending period. tau: contact time of the rod that cannot vibrate, at the angle of its "
    "largest error; or of its whole mass, falling at full speed onto the contact of 45 degrees.",
)


def study_report(
    families: Families, solid: Sequence[str], ends: Ends, blind: Sequence[Drop], results: JobResults
) -> StudyReport:
    """Return the study from the rods of each family and the drops over friction.

    ``solid`` names the families by finite elements, also those without a finished rod; ``ends`` are elastic
    drops by finite elements.
    """
    gives = gives_of(families[YIELDING])
    sentences = {
        "onset": [
            *_answer(families),
            *_onsets(families, solid),
            *_origin(families, solid),
            *_verdicts(families),
            *_confirmed(ends),
        ],
        "angles": _invariance(families),
        "static-give": give_sentences(gives),
        "master": [*_group(families), *_known(families)],
        "blind-direction": _blind_sentences(blind, results),
    }
    return StudyReport(
        "criterion",
        "When a rod may be called rigid",
        [sentence for group in sentences.values() for sentence in group],
        [_onset(families), _angles(families), give_picture(gives), _master(families), _blind(blind, results)],
        [_levels(families), _rods(families), give_sheet(gives), _curves(families)],
        ASSUMPTIONS,
        ["modal", "thornton", "slenderness"],
        [(name, sentence) for name, group in sentences.items() for sentence in group],
    )


def _angles(families: Families) -> Picture:
    """Return e against inclination, one panel per family with up to six of its 19 mm rods."""
    panels = []
    places: dict[str, int] = {}
    for name, rods in families.items():
        same = of_body(rods)
        chosen = [same[i] for i in np.unique(np.linspace(0, len(same) - 1, 6).astype(int))]
        series = []
        for rod in chosen:
            label = f"gamma {rod.drop.gamma:.0f}"
            colour = places.setdefault(label, len(places))  # one for each slenderness in all panels
            bands = rod.bands if rod.bands.any() else None
            series.append(Series(label, rod.angles, rod.e, "joined", colour, bands))
        panels.append(Panel(name, "inclination, degrees", "e", tuple(series)))
    caption = "Restitution against inclination, 19 mm rods; bands: of the change of e by vibration."
    return Picture("angles", caption, tuple(panels))


def _onset(families: Families) -> Picture:
    """Return the largest error of e against gamma, 19 mm, one line per family."""
    series = []
    for at, (name, rods) in enumerate(families.items()):
        same = of_body(rods)
        gamma, error = [r.drop.gamma for r in same], [r.error for r in same]
        series.append(Series(name, gamma, error, "joined", at, _bands(same)))
    marks = (Mark(LIMIT, "limit of Eq 29"),)
    label = "largest error of e by rigid theory"
    panel = Panel("19 mm", "gamma, m^-0.3815", label, tuple(series), marks, tuple(map(Mark, LEVELS)))
    return Picture(
        "onset", "Where vibration changes the rebound; horizontal lines: the stated levels.", (panel,), 1
    )


def _bands(rods: Rods) -> list[float] | None:
    """Return the bands of the largest errors, None for rods of the reduced model, which have none."""
    return [r.error_high - r.error for r in rods] if any(r.bands.any() for r in rods) else None


def _master(families: Families) -> Picture:
    """Return 1 - largest error of e against T1/tau in both meanings of tau and against gamma."""
    independent = Series("independent reference", *KNOWN, "rings", 6)
    groups: tuple[tuple[str, str, Measure, tuple[Series, ...], tuple[Mark, ...]], ...] = (
        ("by T1/tau, tau of the inclined rod", "T1/tau", GROUP, (), ()),
        ("by T1/tau, tau of the whole mass", "T1/tau", WHOLE, (independent,), ()),
        ("by gamma", "gamma, m^-0.3815", attrgetter("drop.gamma"), (), (Mark(LIMIT, "limit"),)),
    )
    panels = []
    for title, axis, group, more, marks in groups:
        series = [
            Series(name, [group(r) for r in rods], [1 - r.error for r in rods], "points", at, _bands(rods))
            for at, (name, rods) in enumerate(families.items())
        ]
        panels.append(Panel(title, axis, "1 - largest error of e", (*series, *more), marks))
    caption = "One group or the other: all diameters, contacts and slendernesses."
    return Picture("master", caption, tuple(panels), 3)


def _blind(blind: Sequence[Drop], results: JobResults) -> Picture:
    """Return vibration against friction of the paper's rods, with mu* of each."""
    series, marks = [], []
    for at, (rod, length) in enumerate(PAPER_RODS.items()):
        f, share = _over_friction(blind, results, length)
        series.append(Series(rod, f, 100 * share, "joined", at))
        marks.append(Mark(blind_ratio(Drop(length)), f"mu* of {rod}"))
    panel = Panel("elastic, 45 degrees", "f", "vibration, % of E_0", tuple(series), tuple(marks))
    caption = "A contact force of ratio mu* does not excite the first bending mode."
    return Picture("blind-direction", caption, (panel,), 1)


def _over_friction(blind: Sequence[Drop], results: JobResults, length: float) -> Array:
    """Return f and E_vib/E_0 (2, n) of the drops of a rod length, m, without the failed ones."""
    runs = [(d.friction, results[d.name]) for d in blind if d.length == length]
    pairs = [(f, known(run.energy.vibration)) for f, run in runs if isinstance(run, Outcome)]
    return np.reshape(pairs, (-1, 2)).T


def _answer(families: Families) -> list[str]:
    """Return for how many contacts the limit of Eq 29 keeps the error of e below `JUDGED`, and the onsets."""
    onsets = {name: gamma_at(rods, BODY, JUDGED) for name, rods in families.items()}
    passed = {name: onset for name, onset in onsets.items() if onset is not None}
    if not passed:
        return []
    early, late = min(passed, key=passed.__getitem__), max(passed, key=passed.__getitem__)
    unsafe = sum(onset < LIMIT for onset in passed.values())
    return [
        f"The published limit gamma <= {LIMIT} does not keep the error of e below {JUDGED:.0%} for {unsafe} "
        f"of the {len(passed)} contacts for which an onset was found: vibration changes e by more from gamma "
        f"{passed[early]:.1f} ({early}) to {passed[late]:.1f} ({late}) on."
    ]


def _onsets(families: Families, solid: Sequence[str]) -> list[str]:
    """Return, per family by finite elements, where the error passes each level, with the band of that."""
    sentences = []
    for name in solid:
        rods = families.get(name, [])
        passed = [f"{level:.0%} {where}" for level in LEVELS if (where := _where(rods, level))]
        tops = [
            f"{r.error:.3f} ± {r.error_high - r.error:.3f} at gamma {r.drop.gamma:.0f}"
            for r in rods[:1] + rods[-1:]
        ]
        told = "; ".join(passed) if passed else "less than all stated levels"
        sentences.append(
            f"{name}, by finite elements: vibration changes e by {told}; the change is {' and '.join(tops)}."
            if rods
            else f"{name}, by finite elements: no rod was computed (see what failed)."
        )
    return sentences


def _where(rods: Rods, level: float) -> str:
    """Return gamma and T1/tau at which the error passes a level, each with the ends of its band."""
    gamma = place_at(rods, level, gamma_of)
    if gamma is None:
        return "already for the shortest rod" if rods and rods[0].error >= level else ""
    told = [f"beyond gamma {gamma:.1f}{_ends_of(rods, level, gamma_of)}"]
    group = place_at(rods, level, group_of)
    return " ".join([*told, *([f"or T1/tau {group:.2f}{_ends_of(rods, level, group_of)}"] if group else [])])


def _ends_of(rods: Rods, level: float, place: Measure) -> str:
    """Return between which places the bands of the mesh leave the onset; open where they reach no place."""
    early, late = (place_at(rods, level, place, measure) for measure in (error_high, error_low))
    first, last = (
        "the first rod" if early is None else f"{early:.3g}",
        "beyond the last" if late is None else f"{late:.3g}",
    )
    return f" ({first} to {last})"


def _confirmed(ends: Ends) -> list[str]:
    """Return how far modes lie from finite elements on elastic drops, in the change of e by vibration."""
    both = [(d, fem, modal) for d, fem, modal in ends if fem is not None and modal is not None]
    told = ", ".join(f"{fem:+.3f} for {modal:+.3f} at gamma {d.gamma:.0f}" for d, fem, modal in both)
    return (
        [f"Elastic, frictionless, 45 degrees: vibration changes e by finite elements by {told} by modes."]
        if both
        else []
    )


def _origin(families: Families, solid: Sequence[str]) -> list[str]:
    """Return, per family by modes, where the error passes each level and the exponent of l over d."""
    sentences = []
    for name, rods in families.items():
        if name in solid:
            continue
        powers = [(level, exponent(rods, level)) for level in LEVELS]
        exponents = ", ".join(f"{p:.2f} at {level:.0%}" for level, p in powers if p is not None)
        sentences.append(
            f"{name}: the error of e passes {_levels_passed(rods, error_of) or 'none of the stated levels'} "
            "(19 mm); the length at which it does grows with the diameter to the power "
            f"{exponents or 'that these rods do not show'} (published {EXPONENT})."
        )
    return sentences


def _levels_passed(rods: Rods, measure: Measure) -> str:
    """Return from which slenderness a measure of the 19 mm rods exceeds each level."""
    onset = [(level, gamma_at(rods, BODY, level, measure)) for level in LEVELS]
    return ", ".join(f"{level:.0%} beyond gamma {g:.1f}" for level, g in onset if g is not None)


def _verdicts(families: Families) -> list[str]:
    """Return, per family, whether the limit of Eq 29 is safe for an error of `JUDGED`."""
    sentences = []
    for name, rods in families.items():
        onset = gamma_at(rods, BODY, JUDGED)
        if onset is None:
            safe = max((r.error for r in of_body(rods)), default=0.0) < JUDGED
            where = "never reaches" if safe else "is always above"
            sentences.append(f"{name}: the error {where} {JUDGED:.0%} on these rods.")
            continue
        word = "unsafe" if onset < LIMIT else "too strict" if onset > 1.15 * LIMIT else "about right and safe"
        sentences.append(
            f"{name}: with {JUDGED:.0%} allowed, gamma <= {LIMIT} is {word}: e is off by that at "
            f"gamma {onset:.1f}."
        )
    return sentences


def _group(families: Families) -> list[str]:
    """Return the scatter of the error about one curve of each group, over all families."""
    rods = [r for family in families.values() for r in family if r.error > 0.005]
    if len(rods) < 8:
        return []
    error, *groups = np.array([(r.error, r.group, r.whole, r.drop.gamma) for r in rods]).T
    inclined, whole, gamma = (_scatter(group, error) for group in groups)
    return [
        f"Over all contacts and diameters the error of e scatters by {inclined:.3f} about one curve of "
        f"T1/tau, tau of the inclined rod, by {whole:.3f} with tau of the whole mass, and by {gamma:.3f} "
        f"about one curve of gamma ({len(rods)} rods with an error above 0.5 %)."
    ]


def _known(families: Families) -> list[str]:
    """Return the distance of Hertz' contacts from the independent points, for each meaning of tau."""
    rods = [r for name in HERTZ for r in of_body(families[name])]
    if len(rods) < 8:
        return []
    apart = []
    for group in (GROUP, WHOLE):
        x, e = np.array(sorted((group(r), 1 - r.error) for r in rods)).T
        apart.append(np.abs(np.interp(KNOWN[0], x, e) - KNOWN[1]).max())
    inclined, whole = apart
    return [
        "The independent points (worst e of elastic drops) are those of Hertz' contact with tau of the whole "
        f"mass: e differs by at most {whole:.2f}. With tau of the inclined rod it differs by up to "
        f"{inclined:.2f}, since only the mass m/(1 + d_c^2/k^2) stands behind that contact."
    ]


def _invariance(families: Families) -> list[str]:
    """Return, per family, where the spread of e over the angles (published criterion) passes a level."""
    sentences = []
    for name in (HERTZ[1], YIELDING):
        rods = of_body(families[name])
        passed = _levels_passed(rods, spread_of) or "every level from the first rod on"
        sentences.append(
            f"{name}: the spread of e over the angles passes {passed}; it is up to "
            f"{max(np.ptp(r.e_rigid) for r in rods):.2f} for rods that cannot vibrate."
        )
    return sentences


def _scatter(x: np.ndarray, y: np.ndarray) -> float:
    """Return the root mean square of y about its mean over the four neighbours in x, two on each side."""
    order = np.argsort(x)
    y = y[order]
    around = (y[:-4] + y[1:-3] + y[3:-1] + y[4:]) / 4
    return float(np.sqrt(np.mean((y[2:-2] - around) ** 2)))


def _blind_sentences(blind: Sequence[Drop], results: JobResults) -> list[str]:
    """Return mu* of the paper's rods and the friction at which they vibrate least."""
    sentences = []
    for rod, length in PAPER_RODS.items():
        f, share = _over_friction(blind, results, length)
        if not share.size:
            continue
        sentences.append(
            f"{rod} rod at 45 degrees: mu* = {blind_ratio(Drop(length)):.2f}; elastic drops vibrate least "
            f"at f = {f[share.argmin()]:.2f} ({100 * share.min():.2g} % of E_0)."
        )
    return sentences


def _levels(families: Families) -> Sheet:
    """Return gamma at which each measure passes each level, for three diameters, and the exponent."""
    measures: dict[str, Measure] = {"error of e": error_of, "spread of e": spread_of}
    rows: list[list[Cell]] = []
    for name, rods in families.items():
        diameters = sorted({r.drop.diameter for r in rods})
        thin, thick = (diameters[0], diameters[-1]) if len(diameters) > 1 else (None, None)
        for title, measure in measures.items():
            for level in LEVELS:
                onset = [gamma_at(rods, d, level, measure) if d else None for d in (thin, BODY, thick)]
                rows.append([name, title, level, *onset, exponent(rods, level, measure)])
    head = ("contact", "measure", "level", "gamma_thinnest", "gamma_19_mm", "gamma_thickest", "exponent")
    caption = "Slenderness at which error or spread of e over the angles passes a level, and the exponent"
    return Sheet("levels", caption, Table.of(head, rows))


def _rods(families: Families) -> Sheet:
    """Return group, error and spread of every 19 mm rod."""
    rows: list[list[Cell]] = [
        [name, r.drop.gamma, r.drop.diameter, r.drop.length, r.group, r.whole, r.error, r.spread]
        for name, rods in families.items()
        for r in of_body(rods)
    ]
    head = ("contact", "gamma", "diameter_m", "length_m", "T1_over_tau", "T1_over_tau_whole")
    return Sheet("rods", "Rods of 19 mm", Table.of((*head, "error_of_e", "spread_of_e"), rows))


def _curves(families: Families) -> Sheet:
    """Return e at every angle of every rod."""
    rows: list[list[Cell]] = [
        [name, r.drop.gamma, r.drop.diameter, float(a), float(e), float(stiff), float(band), float(group)]
        for name, rods in families.items()
        for r in rods
        for a, e, stiff, band, group in zip(r.angles, r.e, r.e_rigid, r.bands, r.groups, strict=True)
    ]
    head = ("contact", "gamma", "diameter_m", "angle_deg", "e", "e_rigid", "band_of_change", "T1_over_tau")
    return Sheet("curves", "Every rod and angle", Table.of(head, rows), shown=False)
