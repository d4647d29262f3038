"""A scene beside its own tests: errors, parts of their uncertainty, the joint statement, any number."""

import json
from dataclasses import replace
from math import inf, sqrt

import numpy as np
import pytest
from scipy.stats import chi2

from fem_impact.answers import validate as module
from fem_impact.answers.compare import compare, measured_value
from fem_impact.answers.v_and_v import NOT_APART, Comparison, freedom, joint, joint_or_why
from fem_impact.answers.validate import KEYS, _not_compared, interval_of, validate
from fem_impact.cli.main import main
from fem_impact.errors import ResultError, SceneError, UsageError
from fem_impact.outcome.keys import Unknown
from fem_impact.run import tests as own_tests
from fem_impact.run.simulate import simulate
from fem_impact.scene.own_tests import HEADER
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import to_dict, to_toml

F = (0.2, 0.3)
UNCERTAIN = {"surface.friction": F, "impact.v_n": ("-1.1 m/s", "-0.9 m/s")}


def scene_with(place, means, f=0.25):
    """Return a rod that slides all the time, so that its mu is f by rigid theory, with means of tests."""
    file = place / "my_means.csv"
    file.write_text(means)
    stated = to_dict(load("quick")) | {"measured": str(file), "id": "mine"}
    stated["surface"] = {"state": "custom", "friction": f, "source": "a test"}
    stated["impact"] = {"angle": "45 deg", "v_n": "-1 m/s", "v_t": "-9 m/s"}
    return read_dict(stated)


MU = "quantity,mean,sd,n,systematic\nmu,0.30,0.04,4,0.015\n"


def test_errors_and_parts_of_a_number_with_a_known_answer(tmp_path):
    found = validate(scene_with(tmp_path, MU), UNCERTAIN, "rigid", samples=32)
    (mu,) = found.comparisons
    spread = (F[1] - F[0]) / 12**0.5
    assert (mu.S, mu.E) == pytest.approx((0.25, -0.05))
    assert mu.u_input == pytest.approx(spread, rel=0.03)
    assert mu.u_D == pytest.approx(np.hypot(0.02, 0.015))
    assert found.total[:, 0] == pytest.approx([1.0, 0.0], abs=0.2)  # of 32 points
    whole = spread**2 + 0.02**2 + 0.015**2
    assert found.shares[:, 0] == pytest.approx([spread**2 / whole, 0, 1 - spread**2 / whole, 0], abs=0.02)
    assert found.better[0] == "surface.friction"
    assert found.distance == pytest.approx(0.05**2 / whole, rel=0.05)
    assert found.runs == 32 * 4 + 1


def test_one_number_of_one_input_has_all_of_its_uncertainty(tmp_path):
    found = validate(scene_with(tmp_path, MU), {"surface.friction": F}, "rigid", samples=64)
    assert found.total == pytest.approx(np.ones((1, 1)), abs=0.1)
    assert not found.doubtful


def test_a_model_that_is_known_least_and_inputs_of_another_model_are_told(tmp_path):
    scene = scene_with(tmp_path, "quantity,mean,sd,n,systematic\nOmega_rad_per_s,1,0.1,4,0\n")
    found = validate(scene, {"surface.friction": (0.249, 0.251)}, "modal", samples=2, inputs_by="rigid")
    assert found.better[0] == "model" and found.better[1] == pytest.approx(1, abs=0.01)
    (omega,) = found.comparisons
    off = abs(simulate(scene, "rigid").motion.Omega - omega.S)
    assert found.doubtful == (("Omega",) if off > 2 * omega.u_val else ())


def test_one_uncertain_input_moves_several_numbers():
    found = validate(load("t5b"), fidelity="rigid", samples=2)
    assert found.total.shape == (1, 8) and found.shares.shape == (3, 8)
    assert found.shares.sum(axis=0) == pytest.approx(np.ones(8))


def test_numbers_that_one_input_moves_together_count_once():
    together = np.array([[1.0, 0.99], [0.99, 1.0]])
    assert joint(np.array([2.0, 2.0]), together)[0] == pytest.approx(8 / 1.99)
    assert joint(np.array([2.0, -2.0]), together)[0] == pytest.approx(8 / 0.01)
    assert joint(np.array([1.96]), np.eye(1))[1] == pytest.approx(0.05, abs=1e-3)


@pytest.mark.parametrize(("tests", "others"), [(4, 0.0), (8, 0.0), (5, 0.5)])
def test_a_model_without_error_is_rejected_as_seldom_by_few_tests_as_is_said(tests, others):
    """With a chi-square distribution 63 % of perfect models were rejected at 5 % by four tests."""
    rng = np.random.default_rng(5)
    true = np.array([[1.0, 0.5, -0.4], [0.5, 2.0, 0.3], [-0.4, 0.3, 0.5]])
    known, rejected, errors = others * true, 0, []
    for _ in range(2000):
        sample = rng.multivariate_normal(np.zeros(3), true, tests)
        S = np.cov(sample.T) / tests
        E = sample.mean(axis=0) + rng.multivariate_normal(np.zeros(3), known)
        _, p = joint_or_why(E, S + known, S, tests - 1)
        rejected += not isinstance(p, Unknown) and p < 0.05
        C = S[:1, :1] + known[:1, :1]
        dof = freedom(C, S[:1, :1], tests - 1)
        one = Comparison("s", "V_n", E[0], 0.0, 0.0, sqrt(known[0, 0]), sqrt(S[0, 0]), dof=dof)
        errors.append(one.in_error)
    assert 0.02 < rejected / 2000 < 0.07 and 0.03 < np.mean(errors) < 0.065


def test_as_many_numbers_as_tests_are_not_told_apart():
    assert isinstance(joint_or_why(np.ones(3), np.eye(3), 0.5 * np.eye(3), 2)[1], Unknown)
    assert joint_or_why(np.ones(3), np.eye(3), 0.0 * np.eye(3), inf)[1] == pytest.approx(chi2.sf(3, 3))


def test_what_nothing_makes_uncertain_is_not_judged():
    assert Comparison("s", "e", 0.4, 0.3, 0.0, 0.0, 0.0).verdict == "not judged: nothing is uncertain"
    assert isinstance(joint_or_why(np.ones(1), np.zeros((1, 1)), np.zeros((1, 1)), inf)[1], Unknown)


def test_published_means_count_the_error_of_tracking_as_the_study_does():
    """u_D of e of t2 was 0.0059 where the study of validation has 0.0137."""
    found = {one.quantity: one.u_D for one in validate(load("t2"), fidelity="rigid", samples=2).comparisons}
    assert (found["e"], found["mu"], found["Omega"]) == pytest.approx((0.0137, 0.0217, 0.42), rel=0.01)


def test_the_friction_of_the_scene_counts_beside_other_uncertain_inputs():
    """Another input given made u_input of V_n smaller, and the model wrong."""
    alone, both = (
        {one.quantity: one.u_input for one in validate(load("t5b"), more, "rigid", samples=8).comparisons}
        for more in (None, {"impact.angle": "+-0.5 deg"})
    )
    assert both["V_n"] > 0.8 * alone["V_n"]


def test_an_interval_without_the_scenes_own_value_is_refused():
    with pytest.raises(UsageError, match=r"does not hold the scene's own value, 0\.57"):
        validate(load("t5b"), {"surface.friction": (0.1, 0.2)}, "rigid", samples=2)


def test_half_a_width_in_degrees_celsius_is_a_difference():
    _, low, high, _ = interval_of(load("t5b"), "heating.ambient", "+-5 degC")
    assert high - low == pytest.approx(10.0)


def test_single_tests_bring_their_own_correlation(tmp_path):
    rows = ["v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s"]
    rows += [f"-1,-9,{0.3 + a},{-8.7 + 0.3 * a + b},{20 * a}" for a, b in ((0, 0), (0.1, 0.02), (0.05, 0.05))]
    tests = own_tests.tests_of(scene_with(tmp_path, "\n".join(rows)))
    C = tests.covariance(["V_n", "Omega"])
    assert C[0, 1] / np.sqrt(C[0, 0] * C[1, 1]) == pytest.approx(1.0)
    assert C[0, 0] == pytest.approx(0.05**2 / 3)


SEEN = {
    "at rest": {},
    "with spin": {"impact.omega": "20 rad/s"},
    "a barrier that comes": {"barrier.v_n": "0.5 m/s", "barrier.v_t": "-0.4 m/s"},
    "a free barrier": {"barrier.v_n": "0.2 m/s", "barrier.mass": "0.3 kg", "impact.omega": "10 rad/s"},
}


@pytest.mark.parametrize("changes", SEEN.values(), ids=SEEN)
@pytest.mark.parametrize("spin_column", [True, False])
def test_single_tests_that_are_the_models_own_answer_have_its_numbers(tmp_path, changes, spin_column):
    """Velocities over the ground, worked out with the spin before and relative to the barrier."""
    scene = replace_all(load("quick"), changes)
    motion, spin = simulate(scene, "rigid").motion, scene.impact.omega
    numbers = (motion.v_n, motion.v_t, motion.V_n, motion.V_t, motion.Omega, spin)
    names = HEADER.split(",") + ["omega_rad_per_s"] * spin_column
    row = ",".join(repr(float(one)) for one in numbers[: len(names)])
    (tmp_path / "own.csv").write_text("\n".join((",".join(names), row, row)))
    scene = replace(scene, measured=str(tmp_path / "own.csv"))
    assert own_tests.doubtful_tests(scene) == []
    outcome, tests = simulate(scene, "rigid"), own_tests.tests_of(scene).statistics()
    for name, key in KEYS.items():
        assert tests[name].mean == pytest.approx(outcome.estimate(key)[0], rel=1e-9, abs=1e-12), name


def test_single_tests_on_a_barrier_that_turns_have_no_restitution(tmp_path):
    turning = {"barrier.mass": "0.3 kg", "barrier.inertia": "1e-4 kg m2", "barrier.centre_depth": "10 mm"}
    (tmp_path / "own.csv").write_text(f"{HEADER}\n-1,-1,0.3,-0.5,5\n-1,-1,0.4,-0.5,5\n")
    scene = replace_all(load("quick"), {"impact.v_n": "-1 m/s", "impact.v_t": "-1 m/s", **turning})
    scene = replace(scene, measured=str(tmp_path / "own.csv"))
    tests = own_tests.tests_of(scene).statistics()
    assert tests["mu"].mean == pytest.approx((0.5 / 1.3 + 0.5 / 1.4) / 2)
    assert not {"e", "e_m", "E_ln_over_E_0", "E_lt_over_E_0"} & set(tests)
    assert any("The barrier turns" in one for one in own_tests.doubtful_tests(scene))


def test_a_test_whose_spin_lifts_its_contact_off_is_refused(tmp_path):
    (tmp_path / "own.csv").write_text(f"{HEADER},omega_rad_per_s\n" + "-1,-1,0.3,-0.5,5,900\n" * 2)
    scene = replace(load("quick"), measured=str(tmp_path / "own.csv"))
    with pytest.raises(ResultError, match="the contact point must approach the barrier"):
        own_tests.tests_of(scene)


def test_means_may_belong_together_and_one_test_has_its_systematic_uncertainty(tmp_path):
    means = "quantity,mean,sd,n,systematic,r_mu\ne,0.3,0.1,4,0,0.8\nmu,0.3,,1,0.02,\n"
    tests = own_tests.tests_of(scene_with(tmp_path, means))
    assert tests.covariance(["mu", "e"]) == pytest.approx(np.array([[4e-4, 8e-4], [8e-4, 25e-4]]))
    mu = tests.statistics()["mu"]
    assert (mu.low, mu.high, mu.n) == pytest.approx((0.26, 0.34, 1))


def test_inputs_are_varied_in_the_fidelity_asked_for_and_a_number_that_it_lacks_is_named(tmp_path):
    scene = scene_with(tmp_path, MU + "E_vib_over_E_0,0.01,0.001,5,0\n")
    found = validate(scene, UNCERTAIN, "modal", samples=2, inputs_by="rigid")
    assert (found.varied, found.runs) == ("rigid", 9)
    assert "varied in the rigid model, which does not know it" in found.unknown["E_vib_over_E_0"]
    with pytest.raises(UsageError, match="is not a fidelity"):
        validate(scene, UNCERTAIN, inputs_by="coarse")


def test_a_number_of_meshes_without_a_band_is_not_compared():
    assert "how far the mesh is off in it is not known" in _not_compared(1.5e-4, None, "solid")
    assert _not_compared(1.5e-4, 1e-6, "solid") == ""


def test_any_number_of_an_outcome_may_be_measured(tmp_path):
    means = "quantity,mean,sd,n\npeak_force_N,9000,400,5\ncontact_time_s,1.5e-4,1e-5,5\ndepth_m,1e-4,1e-5,5\n"
    scene = scene_with(tmp_path, means)
    outcome = simulate(scene, "modal")
    rows = {row["quantity"]: row for row in compare(outcome, own_tests.tests_of(scene))}
    assert rows["peak_force_N"]["model"] == outcome.contact.peak_force
    intervals = outcome.contact.intervals
    assert rows["contact_time_s"]["model"] == pytest.approx(sum(one.end - one.start for one in intervals))
    assert rows["depth_m"]["model"] == max(one.depth for one in outcome.contact.sites)
    assert all(rows[name]["verdict"] for name in ("peak_force_N", "contact_time_s", "depth_m"))


def test_velocities_are_evidence_where_neither_e_nor_mu_is_measured(tmp_path):
    means = "quantity,mean,sd,n\nV_t_m_per_s,-8.5,0.2,4\nOmega_rad_per_s,20,5,4\n"
    assert validate(scene_with(tmp_path, means), UNCERTAIN, "rigid", samples=2).joined == ("V_t", "Omega")
    found = validate(scene_with(tmp_path, means + "mu,0.3,0.04,4\n"), UNCERTAIN, "rigid", samples=2)
    assert found.joined == ("V_t", "Omega", "mu")  # V_n follows, and then e: three are three


def test_a_tangential_ratio_is_that_of_the_velocities_with_their_band(tmp_path):
    scene = scene_with(tmp_path, "quantity,mean,sd,n\ne_t,0.94,0.01,4\nV_t_m_per_s,-8.5,0.2,4\n")
    outcome = simulate(scene, "modal")
    after, half = outcome.estimate("V_t_m_per_s")
    assert measured_value(outcome, "e_t") == pytest.approx((after / -9, half / 9))
    found = validate(scene, UNCERTAIN, "rigid", samples=2)
    ratio, velocity = found.comparisons
    assert (ratio.quantity, ratio.S) == ("e_t", pytest.approx(velocity.S / -9))
    assert found.joined == ("V_t",)
    straight = replace_all(scene, {"impact.v_t": "0 m/s", "measured": scene.measured})
    assert "v_t is 0" in measured_value(simulate(straight, "rigid"), "e_t")[0].reason


@pytest.mark.parametrize(
    ("key", "text", "ends"),
    [
        ("impact.v_n", "+-2 %", (-1.02, -0.98, "m/s")),
        ("impact.v_n_m_per_s", "+-200mm/s", (-1.2, -0.8, "m/s")),
        ("surface.friction", "+- 0.05", (0.2, 0.3, "")),
        ("projectile.material.yield_stress", ["\u00b110%"], (491.4, 600.6, "MPa")),
    ],
)
def test_an_interval_may_lie_about_the_value_of_the_scene(tmp_path, key, text, ends):
    _, low, high, unit = interval_of(scene_with(tmp_path, MU), key, text)
    assert ((low, high), unit) == (pytest.approx(ends[:2]), ends[2])


@pytest.mark.parametrize(
    ("key", "text"), [("impact.omega", "+-2%"), ("barrier.material", "+-2%"), ("impact.height", "+-1 mm")]
)
def test_an_interval_about_no_number_is_refused(tmp_path, key, text):
    with pytest.raises(UsageError, match=f"{key} = .* gives no interval about the scene's value"):
        interval_of(scene_with(tmp_path, MU), key, text)


def test_an_interval_with_impossible_materials_is_refused_before_any_run_and_named(tmp_path):
    rod = "projectile.material"
    uncertain = {f"{rod}.yield_stress": "+-5 %", f"{rod}.ultimate_stress": "+-5 %", **UNCERTAIN}
    with pytest.raises(SceneError) as refused:
        validate(scene_with(tmp_path, MU), uncertain, "solid")
    said = str(refused.value)
    assert f'{rod}.ultimate_stress = "562 MPa": is below the yield stress.' in said
    assert f"{rod}.yield_stress = 518.7 to 573.3 MPa and {rod}.ultimate_stress = 562.4 to 621.6 MPa" in said
    assert "friction" not in said and "v_n" not in said


def test_the_command_says_first_that_the_reduced_model_refutes_little(tmp_path, capsys):
    file = tmp_path / "scene.toml"
    own = simulate(scene_with(tmp_path, MU), "modal").motion.Omega
    scene = scene_with(tmp_path, f"quantity,mean,sd,n,systematic\nOmega_rad_per_s,{own:.4g},0.1,4,0\n")
    file.write_text(to_toml(scene, tmp_path))
    line = ["validate", str(file), "--samples", "2", "--quiet", "--uncertain", "surface.friction=+-1%"]
    assert main(line) == 0
    said = capsys.readouterr().out
    assert said.startswith("Little can be refuted: the error told of the reduced model holds 100 %")
    (tmp_path / "my_means.csv").write_text("quantity,mean,sd,n,systematic\nOmega_rad_per_s,-900,0.1,4,0\n")
    assert main(line) == 0 and capsys.readouterr().out.startswith("The error told of the reduced model")
    assert "s of computing:" in " ".join(said.split())
    assert f"\n  fem-impact validate {file} --uncertain surface.friction=+-1% --fidelity solid\n" in said


@pytest.mark.parametrize(
    ("means", "words"),
    [
        ("quantity,mean,sd,n\npeak_force_kN,9,1,4\n", "not a quantity of tests. Did you mean peak_force_N?"),
        (MU.replace("0.015", "-0.015"), "column systematic"),
        (
            "quantity,mean,sd,n\nmu,0.3,,1\n",
            "standard uncertainty, which is not stated, must be above 0: one test has no other",
        ),
        ("quantity,mean,sd,n,r_e\nmu,0.3,0.1,4,0.5\n", "column r_e: 0.5 is none"),
        ("quantity,mean,sd,n,r_e,r_mu\ne,0.3,0.1,4,,0.5\nmu,0.3,0.1,4,-0.5,\n", "0.5 in the line of e, -0.5"),
        (
            "quantity,mean,sd,n,r_e,r_mu\ne,0.3,0.1,4,,0.9\nmu,0.3,0.1,4,,\nV_n_m_per_s,1,1,4,0.9,-0.9\n",
            "no quantities have these correlations together",
        ),
    ],
)
def test_what_no_outcome_has_is_refused(tmp_path, means, words):
    with pytest.raises(ResultError, match=words):
        own_tests.tests_of(scene_with(tmp_path, means))


def test_what_cannot_be_validated_is_refused(tmp_path):
    with pytest.raises(UsageError, match="no input of the scene is uncertain"):
        validate(scene_with(tmp_path, MU), None, "rigid")
    with pytest.raises(UsageError, match="two numbers of one unit"):
        validate(scene_with(tmp_path, MU), {"impact.v_n": ("-1 m/s", "-900 mm/s")}, "rigid")
    with pytest.raises(SceneError, match="nothing to compare with"):
        validate(load("elastic-frictionless"), UNCERTAIN, "rigid")


TWO_TESTS = (
    "v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s\n-1,-9,0.3,-8.7,0\n-1,-9,0.4,-8.6,2\n"
)


def test_two_tests_and_one_uncertain_input_tell_no_joint_probability_but_why(tmp_path):
    found = validate(scene_with(tmp_path, TWO_TESTS), {"surface.friction": (0.24, 0.26)}, "rigid", samples=2)
    assert (found.distance, found.p) == (NOT_APART, NOT_APART)
    assert f"jointly ({', '.join(found.joined)}) not known: {NOT_APART.reason}" in repr(found)
    assert all(one.verdict for one in found.comparisons)


def test_a_joint_probability_that_is_not_known_is_null_with_its_reason(tmp_path, capsys):
    file = tmp_path / "scene.toml"
    file.write_text(to_toml(scene_with(tmp_path, TWO_TESTS), tmp_path))
    line = ["validate", str(file), "--samples", "2", "--quiet", "--fidelity", "rigid", "--uncertain"]
    line += ["surface.friction=0.24,0.26"]
    assert main([*line, "--json"]) == 0
    joint = json.loads(capsys.readouterr().out)["joint"]
    assert joint == {"numbers": joint["numbers"], "distance": None, "p": None, "reason": NOT_APART.reason}
    assert main(line) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert f"Jointly ({', '.join(joint['numbers'])}): the distance is not known: {NOT_APART.reason}." in said


def test_a_joint_probability_that_is_known_has_no_reason(tmp_path, capsys):
    file = tmp_path / "scene.toml"
    file.write_text(to_toml(scene_with(tmp_path, MU), tmp_path))
    line = ["validate", str(file), "--samples", "2", "--quiet", "--fidelity", "rigid", "--uncertain"]
    assert main([*line, "surface.friction=0.2,0.3", "--json"]) == 0
    joint = json.loads(capsys.readouterr().out)["joint"]
    assert joint["reason"] is None and joint["distance"] > 0.0 and 0.0 < joint["p"] < 1.0


def test_an_error_that_a_scene_wants_of_meshes_refuses_no_model_without_them(tmp_path, monkeypatch):
    plain = scene_with(tmp_path, MU)
    wanting = replace_all(plain, {"accuracy": "90 %", "measured": plain.measured})
    assert wanting.accuracy.target == 0.9
    there = validate(wanting, UNCERTAIN, "rigid", samples=2)
    assert there.p == validate(plain, UNCERTAIN, "rigid", samples=2).p

    wanted = []

    def rigidly(scene, fidelity, options):
        wanted.append((fidelity, scene.accuracy.target))
        return simulate(plain, "rigid")

    monkeypatch.setattr(module, "simulate", rigidly)
    monkeypatch.setattr(module, "_not_compared", lambda value, band, fidelity: "")
    for fidelity, quick in (("solid", "rigid"), ("solid", "modal"), ("modal", "rigid")):
        wanted.clear()
        validate(wanting, UNCERTAIN, fidelity, samples=2, inputs_by=quick)
        assert {*wanted} == {(fidelity, 0.9 if fidelity == "solid" else None), (quick, None)}


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"uncertain": {}}, "no input of the scene is uncertain"),
        *(({"uncertain": UNCERTAIN, "samples": samples}, "no power of two") for samples in (3, 1, 0)),
    ],
)
def test_a_call_without_an_interval_or_with_another_number_of_samples_is_refused(tmp_path, asked, words):
    with pytest.raises(UsageError, match=words):
        validate(scene_with(tmp_path, MU), fidelity="rigid", **asked)
