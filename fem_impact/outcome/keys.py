"""Every key of an outcome, with its kind, unit and meaning: the table that tests and documents read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["ARMS", "KEYS", "SCHEMA_VERSION", "Key", "Kind"]

SCHEMA_VERSION = 2
"""Raised whenever a key is renamed, removed or changes its meaning; added keys raise it too."""

ARMS = ("paper", "edge", "impulse")
"""The three sets of contact arms that every coefficient is given with."""

Kind = Literal[
    "number",
    "count",
    "flag",
    "text",
    "texts",
    "versions",
    "contacts",
    "choices",
    "bands",
    "values",
    "reasons",
]


@dataclass(frozen=True, slots=True)
class Key:
    """One key of the record.

    Parameters
    ----------
    name : str
        The key in the JSON file.
    kind : str
        What its value is: number, count (whole, >= 0), flag, text, list of texts, or a named structure.
    unit : str
        SI unit; ``-`` for a pure number and the empty string where a unit makes no sense.
    meaning : str
        One sentence for the reader of the file.
    nullable : bool
        Whether ``null`` is allowed; then ``reasons`` says why it is null.
    """

    name: str
    kind: Kind
    unit: str
    meaning: str
    nullable: bool = False


def _text(name: str, meaning: str, kind: Kind = "text") -> Key:
    return Key(name, kind, "", meaning)


def _number(name: str, unit: str, meaning: str) -> Key:
    return Key(name, "number", unit, meaning, nullable=True)


def _count(name: str, meaning: str) -> Key:
    return Key(name, "count", "-", meaning, nullable=True)


def _fraction(name: str, meaning: str) -> Key:
    return _number(f"{name}_over_E_0", "-", f"{meaning}, as a fraction of E_0.")


PROVENANCE = (
    Key("schema_version", "count", "-", "Version of this table of keys."),
    _text("fidelity", "Which model computed it: rigid, modal or solid."),
    _text("scene_id", "Identifier of the scene; a measured set carries the set's id."),
    _text("scene_title", "The scene in words."),
    _text("scene_digest", "SHA-256 of the canonical scene, hexadecimal."),
    _text("created_utc", "When the record was made, ISO 8601, UTC."),
    _text("versions", "Version of Python and of each package that took part.", "versions"),
    Key("finished", "flag", "", "True when the stop rule ended the run, false when a limit cut it off."),
    _text("stopped_because", "Why the run ended, as a sentence."),
    _text("effects", "Names of the effects that were in the model.", "texts"),
    _text("assumptions", "Sentences on what the model leaves out or takes from elsewhere.", "texts"),
    Key("effect_choices", "choices", "", "Each effect: number, threshold, verdict, harm, cost.", True),
    _text("validity", "Sentences on where the scene leaves the measured range.", "texts"),
    _text("warnings", "Sentences on what the reader should distrust.", "texts"),
)

SCENE = (
    _number("friction_f", "-", "Coulomb coefficient that went in (not the impulse ratio mu that came out)."),
    _number("alpha_rad", "rad", "Angle between rod axis and barrier normal."),
    _number("mass_kg", "kg", "Mass of the whole rod as modelled."),
    _number("k_squared_m2", "m2", "Squared radius of gyration about b through the mass centre."),
    _number("gamma_per_m0_3815", "m^-0.3815", "Slenderness l / d^1.3815."),
)

MOTION = (
    _number("v_n_m_per_s", "m/s", "Normal velocity of the mass centre at first contact, negative inwards."),
    _number("v_t_m_per_s", "m/s", "Tangential velocity of the mass centre at first contact, up the slope."),
    _number("V_n_m_per_s", "m/s", "Normal velocity at the last separation, gravity removed."),
    _number("V_t_m_per_s", "m/s", "Tangential velocity at the last separation, gravity removed."),
    _number(
        "Omega_rad_per_s", "rad/s", "Rotation rate at the last separation, n turning towards t positive."
    ),
    _number("mu", "-", "Impulse ratio: tangential over normal impulse (Eq 17)."),
    _number("mu_c", "-", "Critical impulse ratio, at which the tip stops sliding without reversal (Eq 11)."),
)


def _arms(name: str) -> tuple[Key, ...]:
    origin = {
        "paper": "the paper's arms for this set",
        "edge": "the arms of a contact on the edge radius",
        "impulse": "the arms of the centre of the contact impulse, where e_m = -1",
    }[name]
    return (
        _number(f"d_c_{name}_m", "m", f"Arm along t from contact point to mass centre: {origin}."),
        _number(f"d_d_{name}_m", "m", f"Arm along n from contact point to mass centre: {origin}."),
        _number(f"e_{name}", "-", f"Coefficient of restitution (Eq 16) with {origin}."),
        _number(f"e_m_{name}", "-", f"Moment coefficient with {origin}."),
        _fraction(f"E_ln_{name}", f"Energy lost by normal forces (Eq 20) with {origin}"),
        _fraction(f"E_lt_{name}", f"Energy lost by tangential forces (Eq 21) with {origin}"),
    )


ENERGY = (
    _number("E_0_J", "J", "Kinetic energy of the whole rod at first contact."),
    _fraction("E_r", "Kinetic energy of the rigid motion after the last separation (Eq 26)"),
    _fraction("E_vib", "Vibration energy after the last separation, by modal projection"),
    _fraction("E_vib_check", "Vibration energy without modes, of all shapes that the mesh has"),
    _fraction("E_vib_floor", "Numerical floor under which a vibration energy means nothing"),
    Key("E_vib_below_floor", "flag", "", "True when E_vib is below its floor.", nullable=True),
    _fraction("W_friction", "Work turned to heat by friction at the contact"),
    _fraction("W_skin", "Friction work and plastic work of the barrier down to 0.1 mm below its surface"),
    _fraction("E_plastic_rod", "Plastic work in the rod"),
    _fraction("E_plastic_barrier", "Plastic work in the barrier"),
    _fraction("E_locked_rod", "Strain energy locked in by residual stress in the rod"),
    _fraction("E_locked_barrier", "Strain energy locked in by residual stress in the barrier"),
    _fraction("W_radiated", "Energy radiated through the barrier's outer boundary"),
    _fraction("W_closing", "Loss at the closing of lumped contact nodes (vanishes with the mesh)"),
    _fraction("W_damping", "Work of material damping"),
    _fraction("W_gravity", "What gravity added to the other shares, the speed of the fall itself taken out"),
    _fraction("E_hourglass", "Hourglass energy"),
    _fraction("residual", "What the ledger fails to close by"),
)

CONTACT = (
    Key("contacts", "contacts", "s, N s", "Each contact interval with its impulses on the rod.", True),
    _number("peak_force_N", "N", "Largest normal force on the rod, mean over 2 us."),
    _number("marker_V_n_m_per_s", "m/s", "V_n as the camera's two markers would give it."),
    _number("marker_V_t_m_per_s", "m/s", "V_t as the camera's two markers would give it."),
    _number("marker_Omega_rad_per_s", "rad/s", "Omega as the camera's two markers would give it."),
    _number("marker_V_cn_m_per_s", "m/s", "Normal velocity of the lower marker."),
    _number("marker_V_ct_m_per_s", "m/s", "Tangential velocity of the lower marker."),
    Key(
        "extrapolated",
        "values",
        "as the key",
        "Limit of two meshes, or mean of one, of each key that has it.",
        True,
    ),
    Key("bands", "bands", "as the key", "Two-mesh half-width of each key that carries one.", nullable=True),
)

ACCURACY = (
    _number("accuracy_target", "-", "Relative error that the scene asked for."),
    Key("accuracy_setting", "text", "", "Setting that the measured costs chose for it.", nullable=True),
    _number("expected_error", "-", "Largest relative error of e and E_vib where the costs were measured."),
    _number("expected_wall_s", "s", "Wall time to be expected, scaled to this machine."),
    _number("achieved_error", "-", "Largest relative error of e and E_vib that two meshes leave open."),
    _number("achieved_wall_s", "s", "Wall time of all runs of the setting."),
)

HEATING = (
    _number("contact_patch_m2", "m2", "Largest true contact patch, whole contact."),
    _number("friction_power_W", "W", "Highest friction power, whole contact."),
    _number("friction_flux_W_per_m2", "W/m2", "Highest friction power over the true contact patch."),
    _number("flash_rise_K", "K", "Highest mean rise of the patch's temperature by friction."),
    _number("flash_temperature_K", "K", "Highest mean temperature of the patch."),
    _number("ignition_temperature_K", "K", "Temperature that the contact must not reach, from the scene."),
    _number("time_above_ignition_s", "s", "How long the patch is hotter than that."),
    _number("flash_bound_K", "K", "Temperature that no spot of the contact exceeds, under assumptions."),
    _fraction("E_lt_less_vibration", "E_lt with the edge's arms less E_vib: what can heat the contact"),
)

COST = (
    _count("steps", "Time steps taken."),
    _count("element_steps", "Elements times steps, summed."),
    _count("elements_rod", "Elements of the meshed (half) rod."),
    _count("elements_barrier", "Elements of the meshed (half) barrier."),
    _count("elements_yielding", "Elements whose material could yield."),
    _number("wall_s", "s", "Wall time of the time loop, compilation apart."),
    _number("cpu_s", "s", "Processor time of the time loop, all threads, compilation apart."),
    _number("setup_wall_s", "s", "Wall time around it: meshes, assembly, modes, check; compilation apart."),
    _number("setup_cpu_s", "s", "Processor time around the time loop, compilation apart."),
    _number("peak_memory_MB", "MB", "Largest resident memory, in 10^6 bytes."),
    _number("min_step_s", "s", "Smallest time step."),
    _number("tip_size_m", "m", "Element edge asked for at the tip."),
)

REASONS = (_text("reasons", "For every null key, the sentence that says why it is null.", "reasons"),)

KEYS: tuple[Key, ...] = (
    *PROVENANCE,
    *SCENE,
    *MOTION,
    *(key for name in ARMS for key in _arms(name)),
    *ENERGY,
    *CONTACT,
    *ACCURACY,
    *HEATING,
    *COST,
    *REASONS,
)
