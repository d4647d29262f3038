"""What the study of slenderness says: on vibration, on the change of e by it, and what the limit is worth."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from pandas import DataFrame

from fem_impact.evidence.studies import gamma_table as runs
from fem_impact.evidence.studies.gamma_table import VIBRATION, among, crossing
from fem_impact.evidence.studies.rod_theory import blind_ratio
from fem_impact.evidence.studies.rods import BODY, PAPER_RODS, PLAIN, STATES, DroppedRod
from fem_impact.tables.text import rounded_up
from rigid import LIMIT

ONE_PERCENT = 0.01  # of E_0: beyond it vibration counts as large

LEVELS = (0.02, 0.05, 0.10)
"""Errors of e beyond which a rod does not count as rigid."""
INDEPENDENT = ((0.67, 0.75, 0.83, 0.90, 0.98), (0.98, 0.95, 0.89, 0.84, 0.79))
"""T1/tau and worst e of elastic frictionless drops, derived independently (benchmark problem 8)."""
JUDGED = 0.05  # error of e that the verdict on the limit of Eq 29 allows
SHORT = 14.5  # gamma, m^-0.3815: below it vibration takes less than 0.5 % of E_0 at any angle
STEEPEST = 20.0  # degrees: beyond it the tip drags its groove, which the static rod leaves out
SURE = 0.005  # error of e from which on its scatter counts
Families = Mapping[str, DataFrame]
"""Rods of 19 mm by family, in order of slenderness."""


def findings(
    table: DataFrame, angles: DataFrame, rods: DataFrame, upright: DataFrame
) -> list[tuple[str, str]]:
    """Return the sentences of the study, each after the name of the picture that shows it.

    ``table`` is that of `table_of`, ``angles`` its rows of rods at all angles, ``rods`` those of `rods_of`,
    ``upright`` the yielding rods by modes up to `STEEPEST`, with ``e_static_give``.
    """
    points = table[table.way == "solid"]
    body = dict(iter(rods[rods.diameter_m == BODY].groupby("family", sort=False)))
    by_picture = {
        "onset": [
            *answer(body),
            *meshed_onsets(body),
            *confirmed(table[table.family == runs.ENDS], angles[angles.family == runs.HERTZ[1]]),
        ],
        "vibration": [
            *what_the_limit_says(points),
            *(sentence for kind in PLAIN for sentence in where_it_peaks(points, kind)),
            *(sentence for kind in PLAIN for sentence in modes_less_elements(points, kind)),
            how_sure(points),
        ],
        "angles": spread(body),
        "static-give": static_give(upright),
        "master": [*scatter(rods), *independent(rods)],
        "blind-direction": blind_directions(table),
    }
    return [(picture, sentence) for picture, said in by_picture.items() for sentence in said]


def plain_line(points: DataFrame, kind: str) -> DataFrame:
    """Return the points of the curve in the state of `PLAIN`, by slenderness."""
    return among(points, family=runs.CURVE, contact=kind, f=STATES[PLAIN[kind]])


def share(point: Any) -> str:
    """Return vibration of a point with its band, rounded up to 0.01, in per cent."""
    percent, band = 100 * point.E_vib_over_E_0, 100 * point.E_vib_over_E_0_band
    if np.isnan(band):
        return f"{percent:.2g} %"
    if percent < 0.0:
        return f"less than {percent + band:.2f} %"
    return f"{percent:.2f} ± {rounded_up(band, 2)} %"


def what_the_limit_says(points: DataFrame) -> list[str]:
    """Return vibration and e at the limit of Eq 29, and where vibration passes `ONE_PERCENT`."""
    rigid = ", ".join(name for name, length in PAPER_RODS.items() if DroppedRod(length).gamma <= LIMIT)
    sentences = [f"The limit gamma <= {LIMIT} calls the {rigid} rod rigid and the longer ones not."]
    for kind, state in PLAIN.items():
        line = plain_line(points, kind).dropna(subset=[VIBRATION])
        for p in line[(line.gamma - LIMIT).abs() < 1e-6].itertuples():
            change = f" and e is {p.e_edge:.3f} where a rod that cannot vibrate has {p.e_edge_rigid:.3f}"
            sentences.append(
                f"{kind.capitalize()}, {state}: vibration there takes {share(p)} of E_0"
                f"{change if not np.isnan(p.e_edge + p.e_edge_rigid) else ''}; {_passes(line)}."
            )
    return [" ".join(sentences)] if len(sentences) > 1 else []


def _passes(line: DataFrame) -> str:
    """Return from which slenderness on vibration takes more than `ONE_PERCENT`, by linear interpolation."""
    gamma, part = crossing(line, ONE_PERCENT, VIBRATION), f"{ONE_PERCENT:.0%} of E_0"
    if line[VIBRATION].iloc[0] > ONE_PERCENT:
        return f"it takes more than {part} from gamma {line.gamma.iloc[0]:.0f} on, the shortest rod"
    return f"it never reaches {part}" if gamma is None else f"it passes {part} at gamma {gamma:.1f}"


def where_it_peaks(points: DataFrame, kind: str) -> list[str]:
    """Return the slenderness of most vibration, and what makes it fall beyond."""
    line = plain_line(points, kind)
    line = line[line[VIBRATION].notna() & line[f"{VIBRATION}_own_mesh"].notna()].reset_index()
    if len(line) < 2:
        return []
    top = line.loc[line[VIBRATION].idxmax()]
    after = line[top.name + 1 :]
    peak = f"{kind.capitalize()}, {PLAIN[kind]}: vibration is largest at gamma {top.gamma:.0f} with "
    peak += f"{share(top)} of E_0"
    if after.empty:
        return [f"{peak}, the longest rod."]
    low, last = after.loc[after[VIBRATION].idxmin()], after.iloc[-1]
    fall = top[VIBRATION] - low[VIBRATION]
    if fall <= np.nansum([top[f"{VIBRATION}_band"], low[f"{VIBRATION}_band"]]):
        return [f"{peak}; beyond it stays within the bands (least {share(low)} at gamma {low.gamma:.0f})."]
    final, first = low[f"{VIBRATION}_own_mesh"], low[f"{VIBRATION}_first_contact"]
    back = 0.0 if np.isnan(first) else first - final
    mostly = "later contacts give energy back" if back > fall / 2 else "the first contact itself leaves less"
    later = f"later contacts change that by {-100 * back:+.2g} % of E_0" if back else "no later one follows"
    again = f" At gamma {last.gamma:.0f} it is {share(last)}." if last.name != low.name else ""
    return [
        f"{peak}; it falls to {share(low)} at gamma {low.gamma:.0f}, mostly because {mostly}: the first "
        f"contact leaves {100 * (final + back):.2g} % there, {later}.{again}"
    ]


def modes_less_elements(points: DataFrame, kind: str) -> list[str]:
    """Return how far the modal fidelity lies from the points of the curve of a kind of contact."""
    line = among(points, family=runs.CURVE, contact=kind)
    apart = (line.by_modes - line[VIBRATION]).dropna().tolist()
    if not apart:
        return []
    return [
        f"{kind.capitalize()} tips: vibration by modes less by finite elements, of E_0: root "
        f"mean square {100 * np.linalg.norm(apart) / len(apart) ** 0.5:.2g} %, largest "
        f"{100 * max(apart, key=abs):+.2g} %, over {len(apart)} points of the curve."
    ]


def how_sure(points: DataFrame) -> str:
    """Return how many points have a band as narrow as wanted, and how many are gaps."""
    close = points.as_wanted == 1.0
    doubted = points.doubted.astype(bool) & ~close
    return (
        f"Levels give vibration of {close.sum()} of {len(points)} points within {runs.CLOSE:.0%} of "
        f"itself or {runs.LEAST:g} of E_0; in {doubted.sum()} of the others its two counts, by modes and "
        f"without them, differ by more. {(points.reason != '').sum()} points have no value or no band. "
        f"The largest residual of their ledgers is {points.residual_over_E_0.abs().max():.1g} of E_0."
    )


def answer(body: Families) -> list[str]:
    """Return for how many contacts the limit of Eq 29 keeps the error of e below `JUDGED`, and the onsets."""
    onsets = {name: onset for name, rods in body.items() if (onset := crossing(rods, JUDGED)) is not None}
    if not onsets:
        return []
    early, late = (extreme(onsets, key=onsets.__getitem__) for extreme in (min, max))
    unsafe = sum(onset < LIMIT for onset in onsets.values())
    return [
        f"The published limit gamma <= {LIMIT} does not keep the error of e below {JUDGED:.0%} for {unsafe} "
        f"of the {len(onsets)} contacts for which an onset was found: vibration changes e by more from gamma "
        f"{onsets[early]:.1f} ({early}) to {onsets[late]:.1f} ({late}) on."
    ]


def meshed_onsets(body: Families) -> list[str]:
    """Return, per family by finite elements, where the error passes each level, with the band of that."""
    sentences = []
    for name, rods in body.items():
        if name not in runs.BY_MESHES.values():
            continue
        passed = [f"{level:.0%} {where}" for level in LEVELS if (where := _where(rods, level))]
        ends = [
            f"{r.error_of_e:.3f} ± {r.error_of_e_band:.3f} at gamma {r.gamma:.0f}"
            for r in rods.iloc[[0, -1]].itertuples()
        ]
        sentences.append(
            f"{name}, by finite elements: vibration changes e by "
            f"{'; '.join(passed) or 'less than all stated levels'}; the change is {' and '.join(ends)}."
        )
    return sentences


def _where(rods: DataFrame, level: float) -> str:
    """Return gamma and T1/tau at which the error passes a level, each with the ends of its band."""
    gamma, group = crossing(rods, level), crossing(rods, level, x="T1_over_tau")
    if gamma is None:
        return "already for the shortest rod" if rods.error_of_e.iloc[0] >= level else ""
    where = f"beyond gamma {gamma:.1f}{_band(rods, level, 'gamma')}"
    return f"{where} or T1/tau {group:.2f}{_band(rods, level, 'T1_over_tau')}" if group else where


def _band(rods: DataFrame, level: float, x: str) -> str:
    """Return between which places the bands of the mesh leave the onset; open where they reach no place."""
    early, late = (crossing(rods, level, measure, x) for measure in ("error_high", "error_low"))
    first = "the first rod" if early is None else f"{early:.3g}"
    return f" ({first} to {'beyond the last' if late is None else f'{late:.3g}'})"


def confirmed(ends: DataFrame, by_modes: DataFrame) -> list[str]:
    """Return how far modes lie from finite elements on elastic rods, in the change of e by vibration."""
    both = ends.merge(by_modes, on=["diameter_m", "length_m", "angle_deg"], suffixes=("", "_modes"))
    changes = ", ".join(
        f"{r.e_edge - r.e_edge_rigid:+.3f} for {r.e_edge_modes - r.e_edge_rigid_modes:+.3f} "
        f"at gamma {r.gamma:.0f}"
        for r in both[both.e_edge.notna()].itertuples()
    )
    sentence = "Elastic, frictionless, 45 degrees: vibration changes e by finite elements by"
    return [f"{sentence} {changes} by modes."] if changes else []


def spread(body: Families) -> list[str]:
    """Return by how much e of rods that cannot vibrate changes over the angles, the published criterion."""
    most = {name: body[name].spread_rigid.max() for name in (runs.HERTZ[1], runs.YIELDING) if name in body}
    over = ", ".join(f"{change:.2f} ({name})" for name, change in most.items())
    return [f"e of rods that cannot vibrate changes over the angles by up to {over}."]


def nearest(upright: DataFrame, angle: float) -> DataFrame:
    """Return the row of each rod at the inclination nearest an angle, degrees, by slenderness."""
    apart = (upright.angle_deg - angle).abs()
    return upright.loc[apart.groupby(upright.length_m).idxmin()]


def static_give(upright: DataFrame) -> list[str]:
    """Return the change of e of short rods, and e of the paper's rods; nothing without short rods."""
    short, near = upright[upright.gamma < SHORT], nearest(upright, 5.0)
    if short.empty:
        return []
    values = [
        f"{name} rod: rigid {r.e_edge_rigid:.2f}, bending {r.e_static_give:.2f}, vibrating {r.e_edge:.2f}"
        for name, length in PAPER_RODS.items()
        for r in near[near.length_m == length].itertuples()
    ]
    return [
        f"Yielding, frictionless, up to {STEEPEST:g} degrees: below gamma {SHORT:g} e changes by up to "
        f"{(short.e_edge - short.e_edge_rigid).abs().max():.3f} without a loss to vibration. A rod that "
        "deforms elastically stores part of the energy and returns it, so that less is left for plastic flow "
        "and e is larger than that of a rigid rod. This quasi-static bending alone gives e within "
        f"{(short.e_edge - short.e_static_give).abs().max():.3f}. Long rods vibrate instead; e at "
        f"{near.angle_deg.iloc[-1]:g} degrees: {'; '.join(values)}."
    ]


def scatter(rods: DataFrame) -> list[str]:
    """Return the scatter of the error about one curve of each group, over all families and diameters."""
    rods = rods[rods.error_of_e > SURE]
    if len(rods) < 8:
        return []
    apart = []
    for x in ("T1_over_tau", "T1_over_tau_whole", "gamma"):
        y = rods.sort_values(x).error_of_e.to_numpy()
        around = (y[:-4] + y[1:-3] + y[3:-1] + y[4:]) / 4  # the mean over two neighbours on each side
        apart.append(float(np.sqrt(np.mean((y[2:-2] - around) ** 2))))
    inclined, whole, gamma = apart
    return [
        f"Over all contacts and diameters the error of e scatters by {inclined:.3f} about one curve of "
        f"T1/tau, tau of the inclined rod, by {whole:.3f} with tau of the whole mass, and by {gamma:.3f} "
        f"about one curve of gamma ({len(rods)} rods with an error above 0.5 %)."
    ]


def independent(rods: DataFrame) -> list[str]:
    """Return the distance of Hertz' contacts from the independent points, for each meaning of tau."""
    rods = rods[(rods.diameter_m == BODY) & rods.family.isin(runs.HERTZ)]
    if len(rods) < 8:
        return []
    apart = []
    for group in ("T1_over_tau", "T1_over_tau_whole"):
        in_order = rods.sort_values(group)
        e = np.interp(INDEPENDENT[0], in_order[group], 1 - in_order.error_of_e)
        apart.append(np.abs(e - INDEPENDENT[1]).max())
    return [
        "The independent points (worst e of elastic drops) are those of Hertz' contact with tau of the whole "
        f"mass: e differs by at most {apart[1]:.2f}. With tau of the inclined rod it differs by up to "
        f"{apart[0]:.2f}, since only the mass m/(1 + d_c^2/k^2) stands behind that contact."
    ]


def blind_directions(table: DataFrame) -> list[str]:
    """Return mu* of the paper's rods and the friction at which they vibrate least."""
    sentences = []
    over_friction = table[(table.family == runs.BLIND) & table[VIBRATION].notna()]
    for rod, length in PAPER_RODS.items():
        of_rod = over_friction[over_friction.length_m == length]
        for least in of_rod.nsmallest(1, VIBRATION).itertuples():
            sentences.append(
                f"{rod} rod at 45 degrees: mu* = {blind_ratio(DroppedRod(length)):.2f}; elastic drops "
                f"vibrate least at f = {least.f:.2f} ({100 * least.E_vib_over_E_0:.2g} % of E_0)."
            )
    return sentences
