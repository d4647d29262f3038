"""Records of runs that were never computed."""

import outcome_maker


def outcome(**changed):
    """A complete record with plain numbers."""
    plain = {"scene_id": "t5b", "E_vib_below_floor": False, "mu": 0.5, "tip_size_m": 4e-4}
    return outcome_maker.outcome(**plain | changed)
