"""What the effects in force fill, and the refusal of what a fidelity would ignore of another package's."""

from collections.abc import Sequence
from copy import copy
from dataclasses import fields

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.registry import ADDED, EFFECTS
from fem_impact.case.effects.slots import ModelSpec, no_items
from fem_impact.errors import SceneError
from fem_impact.plugins import wrong

READ = {
    "rigid": {"contact_loss", "heat"},
    "modal": {"vibrating", "rod_law", "barrier_law", "gravity", "plate", "contact_loss"},
    "solid": {field.name for field in fields(ModelSpec)},
}
"""The slots that each fidelity reads; friction and what yields follow from names of effects as well."""


def filled(bodies: Bodies, names: Sequence[str], fidelity: str) -> ModelSpec:
    """Return the slots that the named effects fill.

    Raises
    ------
    SceneError
        The fidelity is none of those that an effect of another package names.
    UsageError
        Such an effect names the fidelity, and adds nothing or fills a slot that the fidelity does not read.
    """
    spec = ModelSpec()
    for name in names:
        before = copy(spec)
        EFFECTS[name].fill(bodies, spec)
        if name in ADDED:
            changed = [f.name for f in fields(spec) if getattr(spec, f.name) != getattr(before, f.name)]
            _require_computed(name, fidelity, changed)
    return spec


def _require_computed(name: str, fidelity: str, changed: Sequence[str]) -> None:
    effect = EFFECTS[name]
    if fidelity not in effect.fidelities:
        raise SceneError(
            f"is not computed by the fidelity {fidelity}, which would leave it out.",
            key="effects",
            value=name,
            remedy=f"Use fidelity {' or '.join(effect.fidelities)}, or leave the effect out.",
        )
    items = effect.forces is not no_items or effect.impulses is not no_items
    unread = [slot for slot in changed if slot not in READ[fidelity]]
    if unread or (items and fidelity != "solid"):
        what = f"fills {', '.join(unread)}" if unread else "adds items of the finite elements"
        raise wrong(name, "effects", f"{what}, which the fidelity {fidelity}, that it names, does not read.")
    if not (changed or items):
        raise wrong(name, "effects", "fills no slot and adds no item: it would change nothing.")
