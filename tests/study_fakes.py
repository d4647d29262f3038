"""Records of runs that were never computed."""

import outcome_maker

from fem_impact.answers.report import publish


def outcome(**changed):
    """A complete record with plain numbers."""
    plain = {"scene_id": "t5b", "E_vib_below_floor": False, "mu": 0.5, "tip_size_m": 4e-4}
    return outcome_maker.outcome(**plain | changed)


def published(conclude, request, results):
    """What a study writes and tells of results."""
    return publish(conclude(request, results), request, results)
