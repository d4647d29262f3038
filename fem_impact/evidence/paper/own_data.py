"""Coefficients of a user's own tests with their uncertainty."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fem_impact.evidence.paper.audit import estimate_entry, finite, statistic_entry
from fem_impact.run.seen_tests import SeenTests
from fem_impact.scene.own_tests import Camera
from rigid import Arms, Body, bootstrap, critical_ratio, first_order, impulse_centre
from rigid.experiments import statistic
from rigid.inputs import Floats


def own_coefficients(
    camera: Camera,
    seen: SeenTests,
    rod: Body,
    tip: tuple[str, float],
    alpha: float,
    arms: Arms,
    source: str,
) -> dict[str, Any]:
    """Work out e, mu and e_m of a set of tests (Eq 16-18) with their uncertainty.

    Parameters
    ----------
    camera : labels of the tests, and columns that were not used
    seen : the tests as seen from the barrier
    rod : the projectile, for the report
    tip : its tip and the radius of that, m, for the report
    alpha : inclination, rad
    arms : of the contact point, m
    source : of the arms, for the report

    Returns
    -------
    dict
        Plain JSON: rod, arms, coefficients with first-order and bootstrap intervals, scatter, losses as
        fractions of E_0, centre of impulse, one entry a test, notes.
    """
    body: dict[str, Any] = {"d_c": float(arms.d_c), "d_d": float(arms.d_d), "k2": seen.k2}
    tests = seen.columns(arms)
    mean = {name: values.mean() for name, values in seen.motion.items()}
    centre = impulse_centre(**mean, d_d=arms.d_d, k2=seen.k2)
    before = {name: float(mean[name]) for name in ("v_n", "v_t", "omega")}
    sizes = {"length_m": rod.length, "diameter_m": rod.diameter, "tip_radius_m": tip[1], "tip": tip[0]}
    # each coefficient of the mean motion with its first-order and bootstrap intervals
    linear, drawn = first_order(seen.motion, **body), bootstrap(seen.motion, **body)
    estimates = {
        name: {
            "value": finite(linear[name].value),
            "first_order": estimate_entry(linear[name]),
            "bootstrap": estimate_entry(drawn[name]),
        }
        for name in linear
    }
    document = {
        "tests": len(camera.tests),
        "rod": {**sizes, "mass_kg": rod.mass, "k_squared_m2": rod.k2, "alpha_rad": alpha},
        "arms": {"d_c_m": body["d_c"], "d_d_m": body["d_d"], "source": source},
        "coefficients": estimates,
        "scatter": {
            name: statistic_entry(statistic(values))
            for name, values in tests.items()
            if np.isfinite(values).all()
        },
        "mu_c": finite(critical_ratio(**before, e=max(0.0, float(tests["e"].mean())), **body)),
        "impulse_centre": {"d_c_m": float(centre.d_c), "from_contact_m": float(centre.d_c - arms.d_c)},
        "rows": [
            {"test": label, **{name: finite(values[i]) for name, values in tests.items()}}
            for i, label in enumerate(camera.tests)
        ],
    }
    return {**document, "notes": _notes(camera, tests, document)}


def _notes(camera: Camera, tests: Mapping[str, Floats], document: Mapping[str, Any]) -> list[str]:
    """Return warnings about the data and the moment restitution."""
    notes = [f"columns not used: {', '.join(camera.ignored)}"] if camera.ignored else []
    gains = [t for t, remaining in zip(camera.tests, tests["E_r_over_E_0"], strict=True) if remaining > 1]
    if gains:
        notes.append(
            f"more kinetic energy after than before impact in test {', '.join(gains)}: check its row"
        )
    if (camera.motion["v_t"] > 0).any():
        notes.append("v_t > 0 in some tests: t points up the slope, and a falling rod has v_t < 0")
    low, high = (document["coefficients"]["e_m"]["bootstrap"][name] for name in ("low", "high"))
    if low is None or high is None:
        return [*notes, "e_m is not determined: the impulse passes through the mass centre within the errors"]
    inside = (
        "(no moment at the contact) lies within the 95 % interval: e_m then tells nothing about the contact"
    )
    outside = "lies outside the 95 % interval: the impulse did not act at the stated contact point"
    return [*notes, f"e_m = -1 {inside if low <= -1.0 <= high else outside}"]
