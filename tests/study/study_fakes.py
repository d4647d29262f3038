"""Records of runs that were never computed."""

from fem_impact.outcome.record import KEYS, Outcome


def outcome(**changed):
    """A complete record with plain numbers."""
    kinds = {"text": "text", "texts": [], "flag": True, "count": 3, "number": 0.25}
    values = {key.name: kinds[key.kind] for key in KEYS if key.kind in kinds}
    values |= {"versions": {}, "contacts": [], "schema_version": 2, "finished": True, "fidelity": "solid"}
    values |= {"scene_id": "t5b", "E_vib_below_floor": False, "mu": 0.5, "tip_size_m": 4e-4} | changed
    lacking = {k.name: "not in the test" for k in KEYS if k.nullable and values.get(k.name) is None}
    return Outcome(values, reasons=lacking)
