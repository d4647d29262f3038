"""What an outcome holds, group by group."""

from collections.abc import Mapping

from fem_impact.outcome.keys import Num, Unknown, group, key, or_none, part, share
from fem_impact.outcome.limitation import Limitation

ARMS = ("paper", "edge", "impulse")
"""The three sets of contact arms that every coefficient is given with."""


@group
class EffectChoice:
    """What was decided about one effect."""

    name: str = key("name", "", "The effect.")
    on: bool = key("on", "", "It is in the model.")
    forced: bool = key("forced", "", "Because the scene says so, or out of it for that reason.")
    needed: bool = key("needed", "", "Its number is above its threshold, and what it needs is there.")
    measure: str = key("measure", "", "The dimensionless number that decides, in words.")
    number: float | None = key("number", "-", "That number; null where it is not finite.")
    threshold: float = key("threshold", "-", "Above it the effect is needed.")
    source: str = key("source", "", "Where the threshold comes from.")
    sentence: str = key("sentence", "", "What the effect is, or what is left out with it.")
    share: float | None = key("share", "-", "Share of the run time; null where it is off.")


@group
class Provenance:
    """Where a record comes from."""

    fidelity: str = key("fidelity", "", "Which model computed it: rigid, modal or solid.")
    scene_id: str = key("scene_id", "", "Identifier of the scene; a measured set carries the set's id.")
    scene_title: str = key("scene_title", "", "The scene in words.")
    scene_digest: str = key("scene_digest", "", "SHA-256 of the canonical scene, hexadecimal.")
    created_utc: str = key("created_utc", "", "When the record was made, ISO 8601, UTC.")
    versions: Mapping[str, str] = key("versions", "", "Version of Python and of each package that took part.")
    effects: tuple[str, ...] = key("effects", "", "Names of the effects that were in the model.")
    effect_choices: tuple[EffectChoice, ...] | Unknown = key(
        "effect_choices",
        "",
        "Each effect: number, threshold, verdict, changes without it, share of the run time.",
    )


@group
class Validity:
    """How far to trust a record: its end, what it leaves out, the error that was asked for and reached."""

    finished: bool = key(
        "finished", "", "True when the stop rule ended the run, false when a limit cut it off."
    )
    stopped_because: str = key("stopped_because", "", "Why the run ended, as a sentence.")
    limitations: tuple[Limitation, ...] = key(
        "limitations", "", "What limits trust in the record: sentences, each with its kind."
    )
    accuracy_target: Num = key("accuracy_target", "-", "Relative error that the scene asked for.")
    achieved_error: Num = key(
        "achieved_error", "-", "Largest relative half-width of the bands of e and E_vib."
    )
    achieved_wall: Num = key("achieved_wall_s", "s", "Wall time of all levels.")
    mesh_limit: Mapping[str, float] | Unknown = key(
        "mesh_limit",
        "as the key",
        "Limit for vanishing elements that two meshes give a key: the middle of what every order of "
        "convergence from 3/4 up gives; of one mesh at several places of the barrier's grid their mean.",
    )
    mesh_band: Mapping[str, float] | Unknown = key(
        "mesh_band",
        "as the key",
        "Half-width about the limit of two meshes that holds those of all orders from 3/4 up, and the "
        "standard error of means over places of the barrier's grid; three times as wide where a mesh ran at "
        "one place.",
    )
    model_band: Mapping[str, float] | Unknown = key(
        "model_band",
        "as the key",
        "Half-width about a number of the reduced model that holds nine in ten results of finite elements, "
        "by stored scenes like this one.",
    )


@group
class RodMotion:
    """The projectile and its motion at first contact and after the last separation, gravity removed."""

    friction: float = key(
        "friction_f", "-", "Coulomb coefficient that went in (not the impulse ratio mu that came out)."
    )
    alpha: float = key("alpha_rad", "rad", "Angle between projectile axis and barrier normal.")
    mass: float = key("mass_kg", "kg", "Mass of the whole projectile as modelled.")
    k_squared: float = key(
        "k_squared_m2", "m2", "Squared radius of gyration about b through the mass centre."
    )
    gamma: float = key(
        "gamma_per_m0_3815", "m^-0.3815", "Slenderness l / d^1.3815, d the largest diameter or width."
    )
    v_n: float = key(
        "v_n_m_per_s", "m/s", "Normal velocity of the mass centre at first contact, negative inwards."
    )
    v_t: float = key(
        "v_t_m_per_s", "m/s", "Tangential velocity of the mass centre at first contact, up the slope."
    )
    V_n: Num = key("V_n_m_per_s", "m/s", "Normal velocity at the last separation, gravity removed.", True)
    V_t: Num = key("V_t_m_per_s", "m/s", "Tangential velocity at the last separation, gravity removed.", True)
    Omega: Num = key(
        "Omega_rad_per_s",
        "rad/s",
        "Rotation rate at the last separation, n turning towards t positive.",
        True,
    )


@group
class BarrierMotion:
    """The barrier as a whole, before and after the impact, in the frame of the projectile's velocities."""

    mass: Num = key("barrier_mass_kg", "kg", "Mass of a barrier that is free to move.")
    v_bn: float = key("v_bn_m_per_s", "m/s", "Normal velocity of the barrier at first contact.")
    v_bt: float = key("v_bt_m_per_s", "m/s", "Tangential velocity of the barrier at first contact.")
    V_bn: Num = key("V_bn_m_per_s", "m/s", "Normal velocity of the barrier after the last separation.", True)
    V_bt: Num = key(
        "V_bt_m_per_s", "m/s", "Tangential velocity of the barrier after the last separation.", True
    )
    Omega_b: Num = key(
        "barrier_Omega_rad_per_s",
        "rad/s",
        "Spin of a free barrier after the last separation, from n to t.",
        True,
    )
    angular_momentum_error: Num = key(
        "angular_momentum_error",
        "-",
        "Change of the angular momentum of projectile and barrier about their common mass centre, less "
        "gravity's part, over the projectile's momentum at first contact times the distance between the mass "
        "centres.",
    )
    momentum_error: Num = key(
        "momentum_error",
        "-",
        "Change of the momentum of projectile and barrier together, less gravity's part, over the "
        "projectile's at first contact as seen from the barrier.",
    )


@group
class ArmCoefficients:
    """Coefficients and losses by rigid impulse-momentum theory with one set of contact arms."""

    d_c: Num = key("d_c_{}_m", "m", "Arm along t from contact point to mass centre: {}.")
    d_d: Num = key("d_d_{}_m", "m", "Arm along n from contact point to mass centre: {}.")
    e: Num = key("e_{}", "-", "Coefficient of restitution (Eq 16) with {}.", True)
    e_m: Num = key("e_m_{}", "-", "Moment coefficient with {}.")
    E_ln: Num = share("E_ln_{}_over_E_0", "Energy lost by normal forces (Eq 20) with {}")
    E_lt: Num = share("E_lt_{}_over_E_0", "Energy lost by tangential forces (Eq 21) with {}")


@group
class Restitution:
    """Impulse ratio, and the coefficients with three sets of contact arms."""

    mu: Num = key("mu", "-", "Impulse ratio: tangential over normal impulse (Eq 17).", True)
    mu_c: Num = key(
        "mu_c", "-", "Critical impulse ratio, at which the tip stops sliding without reversal (Eq 11)."
    )
    paper: ArmCoefficients = part("paper", "the paper's arms for this set")
    edge: ArmCoefficients = part("edge", "the arms of a contact on the edge radius")
    impulse: ArmCoefficients = part(
        "impulse", "the arms of the centre of the contact impulse, where e_m = -1"
    )

    @property
    def tests_state_arms(self) -> bool:
        """Whether there are tests, with arms of their own beside the tip's."""
        return or_none(self.paper.e) not in (None, or_none(self.edge.e))


@group
class Energy:
    """Where the energy at first contact is after the last separation: E_0 in J, the rest as shares of it.

    Of a run that did not finish they are the energies at its stop.
    """

    E_0: float = key(
        "E_0_J",
        "J",
        "Kinetic energy of the whole projectile at first contact. It is that seen from a moving barrier.",
    )
    rigid: Num = share(
        "E_r_over_E_0",
        "Kinetic energy of the rigid motion after the last separation (Eq 26), or at the stop of a run that "
        "did not finish",
    )
    vibration: Num = share(
        "E_vib_over_E_0",
        "Vibration energy after the last separation, or at the stop of a run that did not finish, by modal "
        "projection",
    )
    vibration_check: Num = share(
        "E_vib_check_over_E_0", "Vibration energy without modes, of all shapes that the mesh has"
    )
    vibration_floor: Num = share(
        "E_vib_floor_over_E_0", "Numerical floor under which a vibration energy means nothing", banded=False
    )
    below_floor: bool | Unknown = key("E_vib_below_floor", "", "True when E_vib is below its floor.")
    friction: Num = share("W_friction_over_E_0", "Work turned to heat by friction at the contact")
    skin: Num = share(
        "W_skin_over_E_0",
        "Friction work, and plastic work of projectile and barrier down to 0.1 mm below their surfaces",
    )
    skin_rod: Num = share("W_skin_rod_over_E_0", "Plastic work of the projectile down to 0.1 mm deep")
    skin_barrier: Num = share(
        "W_skin_barrier_over_E_0", "Plastic work of the barrier down to 0.1 mm below its surface"
    )
    plastic_rod: Num = share("E_plastic_rod_over_E_0", "Plastic work in the projectile")
    plastic_barrier: Num = share("E_plastic_barrier_over_E_0", "Plastic work in the barrier")
    locked_rod: Num = share(
        "E_locked_rod_over_E_0", "Elastic energy held by residual stress in the projectile, no vibration"
    )
    locked_barrier: Num = share(
        "E_locked_barrier_over_E_0", "Elastic energy held by residual stress in the barrier, no vibration"
    )
    radiated: Num = share("W_radiated_over_E_0", "Energy radiated through the barrier's outer boundary")
    plate: Num = share("W_plate_over_E_0", "Energy that bending waves carry away in a plate")
    barrier: Num = share(
        "E_barrier_over_E_0", "Kinetic energy of a free barrier as a whole, as seen from where it was before"
    )
    closing: Num = share(
        "W_closing_over_E_0", "Numerical loss when contact starts at a node (vanishes with the mesh)"
    )
    damping: Num = share("W_damping_over_E_0", "Work of material damping")
    contact: Num = share(
        "E_contact_over_E_0", "Elastic energy that a contact still held when the run was cut off"
    )
    gravity: Num = share(
        "W_gravity_over_E_0", "What gravity added to the shares, the speed of the fall itself taken out"
    )
    residual: float = share("residual_over_E_0", "What the energy balance of all steps misses", banded=False)
    added_mass: Num = share(
        "E_added_mass_over_E_0",
        "Largest kinetic energy of the mass added by mass scaling, part of the kinetic energies",
        banded=False,
    )

    @property
    def plastic(self) -> Num:
        """Plastic work of both bodies over E_0; what is not known of one is in the other's."""
        if isinstance(self.plastic_rod, Unknown) and isinstance(self.plastic_barrier, Unknown):
            return self.plastic_rod
        return sum(or_none(work) or 0.0 for work in (self.plastic_rod, self.plastic_barrier))


@group
class ContactInterval:
    """One interval of contact, with its impulses on the whole projectile."""

    start: float = key("start_s", "s", "First touch.")
    end: float = key("end_s", "s", "Separation.")
    impulse_n: float = key("impulse_n_Ns", "N s", "Normal impulse.")
    impulse_t: float = key("impulse_t_Ns", "N s", "Tangential impulse, up the slope.")

    @property
    def duration(self) -> float:
        """Length of the interval, s."""
        return self.end - self.start


@group
class ContactSite:
    """One place of contact: the skin of the projectile that was pressed, as it lay before."""

    start: float = key("start_s", "s", "First touch there.")
    end: float = key("end_s", "s", "Last touch there.")
    impulse_n: float = key("impulse_n_Ns", "N s", "Normal impulse on the projectile.")
    impulse_t: float = key("impulse_t_Ns", "N s", "Tangential impulse on the projectile, up the slope.")
    low_t: float = key("low_t_m", "m", "Lower end along t, from the place that touches first.")
    high_t: float = key("high_t_m", "m", "Upper end along t.")
    width: float = key("width_m", "m", "Width across the plane of motion.")
    depth: float = key("depth_m", "m", "Largest indentation of the barrier; 0 of a rigid one.")


@group
class Markers:
    """Motion after the impact as the camera's two markers would give it."""

    V_n: Num = key("marker_V_n_m_per_s", "m/s", "V_n as the camera's two markers would give it.")
    V_t: Num = key("marker_V_t_m_per_s", "m/s", "V_t as the camera's two markers would give it.")
    Omega: Num = key("marker_Omega_rad_per_s", "rad/s", "Omega as the camera's two markers would give it.")
    V_cn: Num = key("marker_V_cn_m_per_s", "m/s", "Normal velocity of the lower marker.")
    V_ct: Num = key("marker_V_ct_m_per_s", "m/s", "Tangential velocity of the lower marker.")


@group
class Readings:
    """What else a test may measure: the dent that stays, and the strain of a gauge on the projectile."""

    dent_depth: Num = key(
        "dent_depth_m", "m", "Depth of the dent that stays in the barrier, under the surface around it.", True
    )
    dent_volume: Num = key(
        "dent_volume_m3", "m3", "Volume of that dent, under the surface around it, without its lip.", True
    )
    gauge_highest: Num = key(
        "gauge_strain_highest", "-", "Largest strain at `save.gauge` in the run, tension above 0.", True
    )
    gauge_lowest: Num = key(
        "gauge_strain_lowest", "-", "Smallest strain at `save.gauge` in the run, compression below 0.", True
    )


@group
class Contact:
    """The contact over time, and what a camera would have seen of the motion that it leaves."""

    intervals: tuple[ContactInterval, ...] | Unknown = key(
        "contacts", "s, N s", "Each contact interval with its impulses on the projectile."
    )
    sites: tuple[ContactSite, ...] | Unknown = key(
        "contact_sites", "s, N s, m", "Each place of contact: when, with which impulses, how wide and deep."
    )
    strikes_again: bool | Unknown = key(
        "strikes_again",
        "",
        "True when, after the last separation, the mass centre still comes down or another part is turned "
        "down: it strikes once more, gravity left out.",
    )
    peak_force: Num = key("peak_force_N", "N", "Largest normal force, mean over 2 us.", True)
    readings: Readings
    markers: Markers


@group
class Heat:
    """What friction heats the contact to."""

    patch: Num = key("contact_patch_m2", "m2", "Largest true contact patch, whole contact.", True)
    power: Num = key("friction_power_W", "W", "Highest friction power, whole contact.", True)
    flux: Num = key(
        "friction_flux_W_per_m2", "W/m2", "Highest friction power over the true contact patch.", True
    )
    rise: Num = key(
        "flash_rise_K",
        "K",
        "Highest mean rise of the patch's temperature by friction; null where it melts.",
        True,
    )
    temperature: Num = key(
        "flash_temperature_K", "K", "Highest mean temperature of the patch; null where a body melts.", True
    )
    ignition: Num = key(
        "ignition_temperature_K", "K", "Temperature that the contact must not reach, from the scene."
    )
    time_above_ignition: Num = key(
        "time_above_ignition_s", "s", "How long the patch is hotter than that.", True
    )
    bound: Num = key(
        "flash_bound_K",
        "K",
        "Temperature that no spot of the contact exceeds, under assumptions; null if a body melts below it.",
    )
    less_vibration: Num = share(
        "E_lt_less_vibration_over_E_0",
        "E_lt with the edge's arms less E_vib; not the heat of friction, as plastic work is in it",
        banded=False,
    )


@group
class RunCost:
    """What the run took."""

    steps: int | Unknown = key("steps", "-", "Time steps taken.")
    element_steps: int | Unknown = key("element_steps", "-", "Elements times steps, summed.")
    elements_rod: int | Unknown = key("elements_rod", "-", "Elements of the meshed (half) projectile.")
    elements_barrier: int | Unknown = key("elements_barrier", "-", "Elements of the meshed (half) barrier.")
    elements_yielding: int | Unknown = key("elements_yielding", "-", "Elements whose material could yield.")
    wall: float = key("wall_s", "s", "Wall time of the time loop, compilation apart.")
    cpu: float = key("cpu_s", "s", "Processor time of the time loop, all threads, compilation apart.")
    setup_wall: Num = key(
        "setup_wall_s", "s", "Wall time around it: meshes, assembly, modes, check; compilation apart."
    )
    setup_cpu: Num = key("setup_cpu_s", "s", "Processor time around the time loop, compilation apart.")
    peak_memory: Num = key("peak_memory_MB", "MB", "Largest resident memory, in 10^6 bytes.")
    min_step: Num = key("min_step_s", "s", "Smallest time step.")
    tip_size: Num = key("tip_size_m", "m", "Smallest element edge of the projectile, at its tip.")
    barrier_size: Num = key("barrier_size_m", "m", "Smallest element edge of the barrier along its surface.")
    mass_scaling: Num = key(
        "mass_scaling", "-", "Square of the step over that with true masses; 1: masses are true."
    )

    @property
    def whole_wall(self) -> float:
        """Wall time of time loop and set-up, s; a set-up that is not known counts nothing."""
        return self.wall + (or_none(self.setup_wall) or 0.0)

    @property
    def whole_cpu(self) -> float:
        """Processor time of time loop and set-up, s; a set-up that is not known counts nothing."""
        return self.cpu + (or_none(self.setup_cpu) or 0.0)
