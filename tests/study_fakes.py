"""Records of runs that were never computed."""

import outcome_maker

from fem_impact.answers.report import publish


def outcome(**changed):
    """A complete record with plain numbers."""
    plain = {"scene_id": "t5b", "E_vib_below_floor": False, "mu": 0.5, "tip_size_m": 4e-4}
    plain |= {"v_bn_m_per_s": 0.0, "v_bt_m_per_s": 0.0}  # a barrier at rest
    counts = {"E_vib_floor_over_E_0": 0.0}
    if "E_vib_over_E_0" in changed:
        counts["E_vib_check_over_E_0"] = changed["E_vib_over_E_0"]
    return outcome_maker.outcome(**plain | counts | changed)


def published(conclude, request, results):
    """What a study writes and tells of results."""
    return publish(conclude(request, results), request, results)
