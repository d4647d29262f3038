"""A number against its limit over intervals: answer, worst place, margin; heat, force and dent."""

import json
import re
from dataclasses import replace
from math import inf, pi, sqrt
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import fem_impact
from fem_impact.answers.friction_spread import friction_spread
from fem_impact.answers.verdict import criteria, levels
from fem_impact.answers.verdict import limit as module
from fem_impact.answers.verdict.criteria import LIMITED, Bound, ForceCriterion, Limited
from fem_impact.answers.verdict.limit import judge
from fem_impact.answers.verdict.limit_verdict import limit_document
from fem_impact.case.case import Case
from fem_impact.case.effects.heating import halves
from fem_impact.cli.main import main
from fem_impact.errors import SceneError, UsageError
from fem_impact.modal.motion import ROW
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.shares import heat_ends
from fem_impact.run.common import part_of_last
from fem_impact.run.heated import MELTS
from fem_impact.run.modal import closed
from fem_impact.run.modal_error import SPLIT

ANGLE = {"impact.angle": ("20 deg", "60 deg")}


@pytest.fixture
def scene():
    return fem_impact.replace(fem_impact.load("t5b"), "surface.friction", 0.57)


def test_the_reduced_model_tells_no_dent_of_a_harder_barrier_that_yields_as_well(scene):
    """A brass nose on S235 had a dent of .0112 mm, sure to stay below .032, and .0497 by finite elements."""

    def told(rod, more=None):
        stated = {"projectile.material.yield_stress": rod, "projectile.material.ultimate_stress": "900 MPa"}
        return LIMITED["dent"].reduced(fem_impact.replace_all(scene, stated | (more or {})))

    near, soft = told("315 MPa"), told("110 MPa", {"projectile.material.ultimate_stress": "150 MPa"})
    assert isinstance(told("110 MPa"), Unknown)  # which hardens up to the barrier's strength
    assert isinstance(near, Unknown) and "projectile yields at a lower stress" in near.reason
    elastic = told(
        "315 MPa", {"impact.v_n": "-0.1 mm/s", "impact.v_t": "0 m/s", "effects": ["auto", "-gravity"]}
    )
    assert elastic.low < elastic.value < 1e-6  # what springs back is known
    assert 0.0 < soft.low < soft.value < 1e-4
    like = told("330 MPa", {"projectile.material.ultimate_stress": "460 MPa"})
    unlike = told("1800 MPa", {"projectile.material.ultimate_stress": "2000 MPa"})
    assert like.value / like.low > 1.5 * unlike.value / unlike.low


class Sloped(ForceCriterion):
    """A force of as many N as the angle has degrees, told within 10 N."""

    def __init__(self, missing=()):
        self.missing = missing

    def reduced(self, scene):
        value = np.degrees(scene.impact.angle)
        if any(abs(value - at) < 0.5 for at in self.missing):
            return Unknown("it slides on")
        return Bound(value, value - 10.0, value + 10.0)


def test_no_yes_stands_beside_a_place_that_is_undecided(scene):
    told = {limit: judge(scene, Sloped(), limit, ANGLE, "modal") for limit in (75.0, 69.0, 49.0)}
    assert [told[limit].answer for limit in (75.0, 69.0, 49.0)] == ["yes", "undecided", "no"]
    assert told[69.0].worst == {"impact.angle": "60 deg"} and told[69.0].margin == pytest.approx(-1.0)
    assert told[75.0].margin == pytest.approx(5.0) and told[49.0].margin == pytest.approx(-1.0)
    assert told[75.0].places == 21 and told[75.0].reduced == pytest.approx((20.0, 60.0))
    assert judge(scene, Sloped(), 69.0, None, "modal").answer == "yes"


def test_a_place_without_an_answer_forbids_yes(scene):
    found = judge(scene, Sloped(missing=(40.0,)), 75.0, ANGLE, "modal")
    assert found.answer == "undecided" and found.not_known == "it slides on"
    assert limit_document(found, "")["box"][2][0] == "Of 20 places of the reduced model"


def test_of_a_number_beyond_a_melting_point_the_least_and_the_most_are_no_less(scene):
    """Reported: "the least has 855 K, the most 855 K" where aluminium melts at 855 K at all places."""

    class Capped(Sloped):
        def reduced(self, scene):
            bound = super().reduced(scene)
            return replace(bound, value=min(bound.value, 50.0), high=inf, ceiling=50.0, beyond="it melts")

    # of places that all may melt that of the highest least is the worst: the first one was told
    assert judge(scene, Capped(), 90.0, ANGLE, "modal").worst == {"impact.angle": "60 deg"}
    told = limit_document(judge(scene, Capped(), 40.0, ANGLE, "modal"), "")["box"][2][1]
    assert told == "the least has 0.02 kN, the most 0.05 kN or more."


def test_a_body_without_a_reduced_model_is_decided_by_none(monkeypatch, scene):
    """Its told error was found on other bodies: a brass fitting's dent was 2.7 times the most of its band."""
    monkeypatch.setattr(module, "not_reduced", lambda bodies: "a shaft that would yield")
    found = judge(scene, Sloped(), 75.0, ANGLE, "modal")
    assert found.answer == "undecided" and "no reduced model of a shaft" in found.missing
    assert judge(scene, Sloped(), 49.0, ANGLE, "modal").answer == "undecided"


@pytest.mark.parametrize(
    ("high", "limit", "answer", "ran", "told"),
    [
        (60.0, 100.0, "undecided", [40, 20, 60], "between them the number may be higher"),
        (60.0, 102.0, "yes", [40, 20, 60], ""),
        (60.0, 60.0, "undecided", [40, 20, 60], "the limit lies within"),
        (None, 102.0, "undecided", [40, 20, 60], "at all 3 places: finite elements have it at 2"),
        (60.0, 30.0, "no", [40], ""),
    ],
)
def test_without_a_reduced_model_finite_elements_run_at_the_middle_and_all_ends(
    monkeypatch, scene, high, limit, answer, ran, told
):
    """A limit far above the number at all of them left a fork undecided, however long it computed."""
    monkeypatch.setattr(module, "not_reduced", lambda bodies: "a body of several prongs")
    where = solids(monkeypatch, {40: 40.0, 20: 20.0, 60: high})
    found = judge(scene, Sloped(), limit, ANGLE)
    assert (found.answer, where) == (answer, ran) and told in found.missing
    assert (answer == "yes") == any("at the middle of the intervals" in note for note in found.notes)


def test_finite_elements_run_at_all_ends_where_the_reduced_model_tells_no_number_at_some(monkeypatch, scene):
    where = solids(monkeypatch, {58: 58.0, 40: 40.0, 20: 20.0, 60: 60.0})
    found = judge(scene, Sloped(missing=(60.0,)), 110.0, ANGLE)
    assert found.answer == "yes" and where == [58, 40, 20, 60]  # the largest that is known comes first
    assert judge(scene, Sloped(missing=(60.0,)), 100.0, ANGLE).answer == "undecided"


def solids(monkeypatch, values):
    """Let finite elements tell a bound by the angle in degrees; return the angles at which they ran.

    That of the second place says what it may be there.
    """
    ran = []

    def of(pair, estimate, told, limit, means, tell, steps, before_s, needed):
        ran.append(round(np.degrees(pair[0].impact.angle)))
        value = values[ran[-1]]
        steps.append(f"{limit:g}: {value and told(Bound(value, value, value))}")
        return value and Bound(value, value - 1.0, value + 1.0), [], {"budget_s": 90}

    monkeypatch.setattr(module, "by_levels", of)
    return ran


@pytest.mark.parametrize(
    ("values", "limit", "answer", "ran"),
    [
        ({60: 50.0, 20: 10.0}, 65.0, "yes", [60, 20]),
        ({60: 50.0, 20: 30.0}, 65.0, "undecided", [60, 20]),  # 11 too low at the mild end: 71 at the worst
        ({60: 80.0}, 65.0, "no", [60]),
        ({60: 65.5}, 65.0, "undecided", [60]),
        ({60: 50.0, 20: None}, 65.0, "undecided", [60, 20]),
    ],
)
def test_finite_elements_confirm_at_the_worst_place_and_the_mildest(
    monkeypatch, scene, values, limit, answer, ran
):
    seen = solids(monkeypatch, values)
    found = judge(scene, Sloped(), limit, ANGLE)
    assert found.answer == answer and seen == ran and found.by == "finite elements"
    assert found.bound.value == values[60]


def test_finite_elements_go_on_at_the_mildest_place_until_their_error_there_decides_everywhere(
    monkeypatch, scene
):
    """Reported: a limit stayed open though finite elements lay below it at both places, and none went on."""
    solids(monkeypatch, {60: 50.0, 20: 10.0})
    steps = judge(scene, Sloped(), 65.0, ANGLE).steps
    assert [step.split(":")[0] for step in steps[1:]] == ["65", "25"]
    assert "above 0.025 kN there" in steps[2] and "at most" not in steps[1]


def test_a_limit_that_is_passed_at_the_mildest_place_is_told_by_the_number_there(monkeypatch, scene):
    """The reduced model had its most where finite elements told ten times less than it had anywhere."""
    solids(monkeypatch, {60: 5.0, 20: 80.0})
    told = limit_document(judge(scene, Sloped(), 65.0, ANGLE), "")
    assert told["answer"] == "no" and told["margin"] == pytest.approx(-14.0)
    assert told["box"][1][0] == "At the worst place that finite elements computed, impact.angle 20 deg:"
    assert told["box"][2] == ["Of 21 places of the reduced model", "the least has 0.02 kN, the most 0.06 kN."]


@pytest.mark.parametrize(
    ("mildest", "missing"),
    [(None, "at all 2 places: finite elements have it at 1 "), (30.0, "upper end lies above")],
)
def test_what_lacks_at_the_mildest_place_is_said(monkeypatch, scene, mildest, missing):
    solids(monkeypatch, {60: 50.0, 20: mildest})
    assert missing in judge(scene, Sloped(), 65.0, ANGLE).missing


@pytest.mark.parametrize(
    ("key", "ends", "own"),
    [
        ("impact.angle", ("40 deg", "50 deg"), None),
        ("impact.angle_rad", (0.7, 0.9), None),
        ("impact.angle", ("10 deg", "20 deg"), "45 deg"),
        ("impact.angle_rad", (0.2, 0.3), "45 deg"),
        ("impact.height", ("5 mm", "15 mm"), "none"),  # it states velocities, in whose place the drop stands
    ],
)
def test_an_interval_without_the_scenes_own_value_is_told(scene, key, ends, own):
    """Reported: a scene of 2 m/s had a YES by a drop of a few millimetres, and nothing said so."""
    notes = judge(scene, Sloped(), 1e3, {key: ends}, "modal").notes
    told = f"{key}: the scene has {own}, the answer holds for its interval alone."
    assert notes == (() if own is None else (told,))


def test_the_force_of_what_lands_flat_is_not_told_by_modes():
    """A thin tube: 10.3 (4.7 to 22.3) kN by modes, 4.19 by finite elements, rho c v A = 4.09."""
    upright = {"impact.angle": "0 deg", "impact.v_t": "0 m/s"}
    flat = fem_impact.replace_all(fem_impact.load("tube"), upright)
    found = fem_impact.judge(flat, "force", "1 N", fidelity="modal")
    assert found.answer == "undecided" and "lands flat" in found.missing


def test_what_reaches_its_limit_does_not_stay_below_it():
    assert Bound(293.0, 293.0, 293.0).answer(293.0) == "undecided"
    assert criteria._about(0.2, 0.3).low == 0.0


@pytest.mark.parametrize(("limit", "most"), [("20 kN", 20e3), (20e3, 20e3)])
def test_a_number_and_its_limit_may_be_words(scene, limit, most):
    found = fem_impact.judge(scene, "force", limit, fidelity="modal")
    assert found.limit == most and found.criterion is LIMITED["force"] and found.answer == "yes"
    assert repr(found).startswith(f"LimitVerdict({scene.id!r}: the peak force below 20 kN: yes, ")
    for half in (0.5, "0.5", "50 %"):
        change = fem_impact.judge(scene, "e", half, fidelity="modal")
        assert change.criterion.called == "the change of e by vibration" and change.limit == 0.5
    for of, wrong in (("force", "-1 N"), ("e", "nan")):
        with pytest.raises(SceneError, match="above 0"):
            fem_impact.judge(scene, of, wrong)
    with pytest.raises(SceneError, match="of="):
        fem_impact.judge(scene, "dents", limit)
    with pytest.raises(SceneError, match="is not a unit of force"):
        fem_impact.judge(scene, "force", "20 mm")


@pytest.mark.parametrize(
    ("low", "high", "by"),
    [(40.0, 90.0, "the reduced model"), (61.0, 69.0, "finite elements"), (71.0, 100.0, "finite elements")],
)
def test_a_wider_error_of_meshes_that_agree_does_not_replace_the_reduced_models(
    monkeypatch, scene, low, high, by
):
    """It tells 60 +- 10 N, the limit is 65 N."""
    bound = Bound(0.5 * (low + high), low, high)
    monkeypatch.setattr(module, "by_levels", lambda *_: (bound, [], {}))
    found = judge(scene, Sloped(), 65.0, ANGLE)
    assert found.by == by and found.bound.low == pytest.approx(50.0 if by == "the reduced model" else low)
    assert found.answer == ("no" if low > 65.0 else "undecided")


def test_a_number_that_is_clear_needs_no_finite_elements(monkeypatch, scene):
    seen = solids(monkeypatch, {})
    assert judge(scene, Sloped(), 75.0, ANGLE).by == "the reduced model" and not seen


def test_the_interval_of_friction_that_a_scene_states_counts(scene):
    stated = fem_impact.load("t5b")
    found = judge(stated, Sloped(), 75.0, {}, "modal")
    assert found.answer == "yes" and found.intervals == {"surface.friction": "0.45 to 0.7"}
    assert judge(scene, Sloped(), 75.0, {}, "modal").intervals == {}
    with pytest.raises(UsageError, match="5 intervals"):
        judge(stated, LIMITED["force"], 5e3, {f"a{at}": (0, 1) for at in range(4)})


def test_force_and_dent_are_those_of_the_outcome(scene):
    outcome = fem_impact.simulate(scene, "modal")
    for word, value in (
        ("force", outcome.contact.peak_force),
        ("dent", max(site.depth for site in outcome.contact.sites)),
    ):
        bound = LIMITED[word].reduced(scene)
        assert bound.value == pytest.approx(value) and bound.low < value < bound.high
        least = bound.low / (1.0 - (1.0 + SPLIT) * part_of_last(Case(scene, "modal")) * (word == "dent"))
        assert bound.high / value == pytest.approx(value / least)


def test_an_even_flux_heats_two_half_spaces_as_the_closed_form_says(scene):
    """In a short time heat flows straight into both: T = 2 q sqrt(t / pi) / (b_rod + b_barrier)."""
    case = Case.of(scene, "modal")
    record = np.zeros((200, len(ROW)))
    t, force, power = np.linspace(0.0, 1e-6, 200), 4000.0, 500.0
    record[:, ROW.time], record[:, ROW.force_n], record[:, ROW.friction] = t, force, power * t
    result = replace(closed(case), record=record)
    rods = halves(case.bodies)
    patch = force / (2.8 * case.contact.softer.yield_stress)
    expected = 2 * power / patch * sqrt(t[-1] / pi) / sum(half.effusivity for half in rods)
    assert LIMITED["heat"].of_reduced(case, result) == pytest.approx(expected, rel=1e-6)
    assert LIMITED["heat"].reduced(scene).low > scene.heating.ambient


def test_heat_of_a_metal_that_states_no_conduction_is_refused(scene):
    metal = "projectile.material", {"name": "mine", "E": "200 GPa", "nu": 0.3, "rho": "7800 kg/m3"}
    unknown = fem_impact.replace_all(scene, {metal[0]: metal[1], "surface.friction_high": 0.9})
    begun = list[str]()
    remedy = r"State rod_conductivity, W/\(m K\) and rod_heat_capacity, J/\(kg K\), in \[heating\]\."
    with pytest.raises(SceneError, match=remedy) as refused:
        judge(unknown, LIMITED["heat"], 600.0, tell=begun.append)
    assert begun == []  # no model has run
    assert "leave" not in str(refused.value)  # the question needs the heat, whatever effects say


def test_a_temperature_beyond_the_melting_point_is_at_least_that(scene):
    """Both bodies melt from 1700 K on: no larger limit can be judged, by the reduced model or by levels."""
    hot = fem_impact.replace_all(scene, {"impact.v_n": "-20 m/s", "impact.v_t": "-12 m/s"})
    found = judge(hot, LIMITED["heat"], 3000.0, {}, "modal")
    told = limit_document(found, "")
    assert found.answer == "undecided" and found.margin is None and told["next_step"] is None
    assert "plate-steel begins to melt at 1700 K" in told["missing"]
    assert "K = 360 degC or more, at the best estimate 1700 K = 1430 degC or more (" in str(told["box"])
    assert json.loads(json.dumps(told, allow_nan=False))["bound"]["high"] is None
    assert judge(hot, LIMITED["heat"], 300.0, {}, "modal").answer == "no"

    melted = Unknown(f"at least 1700 K; rod-steel begins to {MELTS}")
    for rises, low in (((400.0, melted, melted), 1700.15), ((400.0, 1000.0, melted), 293.15)):
        levels = [
            SimpleNamespace(
                cases=[Case(hot)],
                outcome=SimpleNamespace(heat=SimpleNamespace(rise=rise)),
                runs=SimpleNamespace(wide=True),
            )
            for rise in rises
        ]
        assert LIMITED["heat"].solid(levels).low == pytest.approx(low)
    levels[-1].runs.wide = False  # a contact hardly wider than a cell tells no heat, high or low
    assert LIMITED["heat"].solid(levels) is None


def test_what_can_heat_lies_between_ends_where_its_share_is_not_known():
    """Reported: W_skin of an aluminium bar "not known", though friction and all plastic work were."""
    shares = {"W_friction_over_E_0": "18 +- 4", "W_skin_over_E_0": "not known"}
    told = LIMITED["heat"].counts(shares.__getitem__, "it lies between 14 % and 85 %")
    assert told.endswith("both surfaces, not known: it lies between 14 % and 85 %.")


def test_a_temperature_is_never_below_that_of_the_surroundings(monkeypatch, scene):
    """Levels of a nylon pin told 218 to 550 K in a room of 293 K."""
    monkeypatch.setattr(Limited, "solid", lambda self, levels: Bound(360.0, 218.0, 550.0))
    heat = SimpleNamespace(rise=100.0)
    level = SimpleNamespace(
        cases=[Case(scene)], outcome=SimpleNamespace(heat=heat), runs=SimpleNamespace(wide=True)
    )
    assert LIMITED["heat"].solid([level] * 3) == Bound(360.0, 293.15, 550.0)


def test_heat_by_finite_elements_follows_the_contact(scene):
    meshed, twin = LIMITED["heat"].meshed(
        fem_impact.replace(scene, "effects", ["friction", "barrier-elastic"])
    )
    assert twin is None and set(meshed.effects) == {"friction", "barrier-elastic", "contact-heating"}


def test_heat_says_that_friction_alone_counts_and_what_more_can_heat(scene):
    """Both shares, by the model that the answer rests on, with what is known of their error."""
    found = judge(scene, LIMITED["heat"], 700.0, None, "modal")
    counts = dict(limit_document(found, "fem-impact assess t5b")["box"])["It counts"]
    run = fem_impact.simulate(scene, "modal")
    friction, skin = (run.told(name, 100.0) for name in ("W_friction_over_E_0", "W_skin_over_E_0"))
    assert "+-" in friction and f"Friction takes {friction} % of E_0." in counts
    assert (
        "+-" not in skin
        and f"both surfaces, {skin} % of E_0 (its error is not known: {heat_ends(run)})." in counts
    )
    assert "friction alone, over the mean of the patch, in the first strike" in counts
    smooth = judge(fem_impact.replace(scene, "surface.friction", 0.0), LIMITED["heat"], 700.0, None, "modal")
    flows = re.search(r"both surfaces, 0 % .* between 0 % \(friction\) and (\d+) % \(", smooth.bound.counts)
    assert 20 <= int(flows[1]) <= 100
    force = judge(scene, LIMITED["force"], 5000.0, None, "modal")
    assert "It counts" not in dict(limit_document(force, "fem-impact assess t5b")["box"])


@pytest.mark.long
def test_the_command_says_question_place_and_margin(capsys):
    line = ["assess", "t5b", "--fidelity", "modal", "--for", "force", "--limit"]
    assert main([*line, "3.2 kN", "--uncertain", "impact.angle=44,46deg"]) == 0
    told = capsys.readouterr().out
    assert "stay below 3.2 kN" in told and "UNDECIDED" in told and "impact.angle 44 deg" in told
    assert main([*line, "1 kN", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["answer"] == "no" and answer["margin"] < 0 and answer["limit"] == 1000.0


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--for", "force"], "--limit"),
        (["--for", "heat", "--limit", "5 kN"], "temperature"),
        (["--limit", "5 kN"], "has no question"),
        (["--for", "dent", "--limit", "1 mm", "--within", "e 0.1"], "--within"),
        (["--uncertain", "impact.angle=44,46deg", "--heat"], "--heat"),
    ],
)
def test_what_cannot_be_asked_is_refused(capsys, options, told):
    assert main(["assess", "t5b", *options]) == 2
    assert told in capsys.readouterr().err


def test_an_interval_of_an_unknown_key_is_refused_before_any_run(capsys):
    assert main(["assess", "t5b", "--uncertain", "impact.angel=44,46deg"]) == 3
    assert "Did you mean angle?" in capsys.readouterr().err


def test_rigid_theory_is_judged_over_an_interval_too(capsys):
    line = [
        "assess",
        "t5b",
        "--fidelity",
        "modal",
        "--uncertain",
        "impact.angle=44,46deg",
        "--within",
        "e 0.2",
    ]
    assert main([*line, "--set", "surface.friction=0.57"]) == 0
    assert (
        "the change of e by vibration stay below 0.2 in the first impact, impact.angle from 44 to 46 deg? YES"
        in " ".join(capsys.readouterr().out.split())
    )


def test_a_next_step_repeats_the_question(monkeypatch, scene):
    solids(monkeypatch, {60: 65.5})
    found = judge(scene, Sloped(), 65.0, ANGLE)
    assert (
        limit_document(found, "fem-impact assess t5b")["next_step"] == "fem-impact assess t5b --budget '90 s'"
    )


def test_an_undecided_limit_says_what_is_missing_and_what_comes_next(scene):
    found = judge(scene, Sloped(), 69.0, ANGLE, "modal")
    assert "or a limit above 0.07 kN" in found.missing
    assert limit_document(found, "fem-impact assess t5b")["next_step"].endswith(
        "--fidelity solid --budget '60 s'"
    )
    assert "above 0.0700004 kN" in replace(found, limit=70.0, bound=Bound(60.0, 50.0, 70.0004)).missing
    places = judge(scene, Sloped(missing=(40.0,)), 75.0, ANGLE, "modal")
    assert places.missing == "an answer: it slides on"
    assert judge(scene, Sloped(), 75.0, ANGLE, "modal").missing == ""


def test_finite_elements_that_tell_nothing_leave_undecided_who_asked_for_them(monkeypatch, scene):
    solids(monkeypatch, {45: None})
    found = judge(scene, Sloped(), 75.0, None, "solid")
    assert found.answer == "undecided" and found.bound is None and "notes say" in found.missing
    assert found.more == {"fidelity": "solid", "budget_s": 90}
    assert judge(scene, Sloped(), 75.0, None, "auto").answer == "yes"


def test_the_next_step_of_finite_elements_asks_for_them_again(monkeypatch, scene):
    """Without them it gave the reduced model's answer."""
    solids(monkeypatch, {60: 65.5})
    told = limit_document(judge(scene, Sloped(), 65.0, ANGLE, "solid"), "fem-impact assess t5b")
    assert told["next_step"] == "fem-impact assess t5b --fidelity solid --budget '90 s'"


class Unsure(Sloped):
    """The same, told within 40 N where it is small."""

    def reduced(self, scene):
        bound = super().reduced(scene)
        return replace(bound, high=bound.value + 40.0) if bound.value < 45.0 else bound


def test_the_place_that_leaves_an_answer_open_is_shown(scene):
    """A dent was told to stay below its limit at the worst place, beside UNDECIDED."""
    found = judge(scene, Unsure(), 75.0, ANGLE, "modal")
    assert found.answer == "undecided" and found.bound.value == pytest.approx(44.0)
    assert found.missing.startswith("a smaller error")


def test_finite_elements_elsewhere_are_missing_where_the_reduced_model_is_too_low(monkeypatch, scene):
    solids(monkeypatch, {60: 50.0, 20: 30.0})
    assert judge(scene, Sloped(), 65.0, ANGLE).missing.startswith("a smaller error of finite elements")


def test_a_dent_needs_as_many_levels_as_a_default_run(scene, monkeypatch):
    """Two levels agreed at 5.1 +- 0.5 um of a tube whose third has 7.4."""
    monkeypatch.setattr(criteria, "level_limits", lambda used: ({}, {}))
    runs = [SimpleNamespace(size=2.0**-at, wide=True) for at in range(3)]
    outcome = SimpleNamespace(contact=SimpleNamespace(sites=[SimpleNamespace(depth=5e-6)]))
    levels = [SimpleNamespace(outcome=outcome, runs=one, cases=[Case(scene)]) for one in runs]
    assert LIMITED["dent"].solid(levels[:2]) is None
    assert LIMITED["dent"].solid(levels).value == pytest.approx(5e-6)


def test_heat_needs_as_many_levels_as_a_default_run():
    assert LIMITED["heat"].solid([None, None]) is None


def test_a_limit_has_a_page_too(cli):
    line = ("--fidelity", "modal", "--for", "force", "--limit", "9 kN", "--out", "page")
    assert cli("assess", "t5b", *line)[0] == 0
    page = Path("page/verdict.html").read_text(encoding="utf-8")
    assert "Does the peak force stay below 9 kN" in page and "Signatures" in page
    assert json.loads(Path("page/verdict.json").read_text(encoding="utf-8"))["answer"] == "yes"


def test_heat_asks_for_the_budget_of_all_levels_that_it_needs():
    """It named that of level 2, with which there was no answer either."""
    asked, ended = [], SimpleNamespace(validity=SimpleNamespace(finished=True))
    chain = SimpleNamespace(
        done=[SimpleNamespace(outcomes=[ended])],
        advice=lambda before_s, halvings: (asked.append(halvings) or "", 90),
    )
    notes, more = levels._open(chain, None, 0.0, LIMITED["heat"].needed)
    assert (asked, more) == ([2], {"budget_s": 90}) and "number from 3 levels on" in notes[1]
    levels._open(chain, None, 0.0, LIMITED["force"].needed)
    assert asked == [2, 1]


NYLON = {
    "projectile.material": "pa66",
    "barrier.material": "s235",
    "surface": {"state": "custom", "friction": 0.35, "source": "assumed"},
}


def test_a_barrier_that_auto_takes_as_rigid_has_a_dent_all_the_same(scene):
    """Hertz: the barrier's share of the depth is that of the compliances, which is .014 under nylon."""
    soft = fem_impact.replace_all(scene, NYLON)
    assert "barrier-rigid" in Case.of(soft, "modal").active
    bound = LIMITED["dent"].reduced(soft)
    deforms = fem_impact.replace(soft, "effects", ["auto", "barrier-elastic"])
    case = Case.of(deforms, "modal")
    deepest = max(site.depth for site in closed(case, recorded=True).sites)
    assert bound.value == pytest.approx(deepest) and 0.0 < bound.low < bound.value < bound.high
    assert bound.value < 0.05 * case.contact.estimate.depth
    meshed, _ = LIMITED["dent"].meshed(soft)
    assert meshed.effects == ("auto", "barrier-elastic")
    stated = fem_impact.replace(soft, "effects", ["auto", "barrier-rigid"])
    with pytest.raises(SceneError, match="leaves the barrier no dent"):
        judge(stated, LIMITED["dent"], 1e-6, None, "modal")


def test_a_reduced_model_whose_ledger_is_open_tells_no_number(scene, monkeypatch):
    monkeypatch.setattr("fem_impact.run.common.RESIDUAL_LIMIT", -1.0)
    monkeypatch.setattr("fem_impact.run.assemble.RESIDUAL_LIMIT", -1.0)
    told = LIMITED["force"].reduced(scene)
    assert isinstance(told, Unknown) and "The energy ledger misses" in told.reason
    spread = friction_spread(fem_impact.replace(scene, "surface", {"state": "pair"}), "solid")
    assert spread.said == "" or "rigid theory" in spread.said


class Uneven(Sloped):
    """As many N as the angle has degrees, told well above 45 N upwards and below 50 N downwards."""

    def reduced(self, scene):
        value = np.degrees(scene.impact.angle)
        return Bound(value, value - (5.0 if value < 49.0 else 19.0), value + (50.0 if value < 45.0 else 5.0))


@pytest.mark.parametrize(
    ("limit", "answer", "angle", "margin"),
    [
        (100.0, "yes", "44 deg", 100.0 - 94.0),  # 65 at 60 deg
        (62.0, "undecided", "44 deg", 62.0 - 94.0),
        (40.0, "no", "48 deg", 40.0 - 43.0),  # 41 at 60 deg
    ],
)
def test_the_place_whose_end_decides_is_shown_with_its_margin(scene, limit, answer, angle, margin):
    found = judge(scene, Uneven(), limit, ANGLE, "modal")
    assert (found.answer, found.worst["impact.angle"]) == (answer, angle)
    assert found.margin == pytest.approx(margin)


def least(found):
    """The least limit, SI, that an undecided verdict proposes."""
    return 1e3 * float(re.search(r"a limit above (\S+) kN", found.missing)[1])


@pytest.mark.parametrize("uneven", [Sloped(), Uneven()])
def test_the_limit_that_an_undecided_answer_proposes_decides_over_all_places(scene, uneven):
    angle = {"impact.angle": ("20 deg", "61.237 deg")}  # whose ends are no round numbers
    found = judge(scene, uneven, 62.0, angle, "modal")
    assert found.answer == "undecided"
    assert judge(scene, uneven, least(found), angle, "modal").answer == "yes"


@pytest.mark.parametrize("high", [70.00043, 70.4321, 123.449, 9871.4])
def test_the_limit_that_is_proposed_lies_above_the_upper_end(scene, high):
    found = replace(judge(scene, Sloped(), 69.0, ANGLE, "modal"), bound=Bound(60.0, 50.0, high))
    assert found.bound.answer(least(found)) == "yes"


def test_of_two_places_of_finite_elements_the_one_with_the_larger_upper_end_is_shown(monkeypatch, scene):
    told = {60: Bound(12.0, 11.0, 13.0), 20: Bound(10.0, 5.0, 30.0)}

    def of(pair, *_):
        return told[round(np.degrees(pair[0].impact.angle))], [], {}

    monkeypatch.setattr(module, "by_levels", of)
    found = judge(scene, Sloped(), 65.0, ANGLE)
    assert found.by == "finite elements" and found.worst == {"impact.angle": "20 deg"}
    assert found.margin == pytest.approx(65.0 - 30.0)


def test_bounds_rank_by_their_answer_then_by_the_end_that_decides_it():
    sure, wide, open_, beyond = (
        Bound(9.0, 8.0, 10.0),
        Bound(5.0, 1.0, 12.0),
        Bound(6.0, 3.0, 30.0),
        Bound(25.0, 21.0, 40.0),
    )
    order = [sure, wide, open_, beyond, Bound(24.0, 23.0, 25.0)]
    assert sorted(reversed(order), key=lambda one: one.rank(20.0)) == order


def test_the_budget_of_the_next_step_holds_all_levels_at_all_places(scene):
    """A second was given, so that none of the budgets is the one that was stated."""

    def asked(levels, intervals):
        criterion = Sloped()
        criterion.needed = levels
        return judge(scene, criterion, 69.0 if intervals else 45.5, intervals, "modal", 1.0).more["budget_s"]

    one, two = asked(2, None), asked(2, ANGLE)
    assert 1.0 < one < two < asked(3, ANGLE) and one < asked(3, None)
