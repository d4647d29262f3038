"""The published JSON Schema of an outcome, and what it refuses."""

import json
from pathlib import Path

import fastjsonschema
import pytest
from result_maker import values

from fem_impact.errors import ResultError
from fem_impact.outcome.check import json_schema
from fem_impact.outcome.record import KEYS, Outcome

PUBLISHED = Path(__file__).parents[2] / "docs" / "outcome.schema.json"


def test_the_published_schema_is_that_of_the_keys():
    assert json.loads(PUBLISHED.read_text(encoding="utf-8")) == json_schema(KEYS)


def test_a_written_outcome_meets_the_published_schema():
    validate = fastjsonschema.compile(json.loads(PUBLISHED.read_text(encoding="utf-8")))
    whole = json.loads(Outcome.from_dict(values()).to_json())
    validate(whole)
    with pytest.raises(fastjsonschema.JsonSchemaValueException):
        validate({**whole, "mu": "0.5"})


@pytest.mark.parametrize("wrong", [{}, [{}], "text", [1, None], 1.5, True])
def test_a_value_of_another_type_is_refused_by_name(wrong):
    """Or it is of the right type: never a traceback."""
    refused = 0
    for key in {key.name for key in KEYS} - {"schema_version", "reasons"}:
        try:
            Outcome.from_dict({**values(), key: wrong})
        except ResultError as error:
            refused += 1
            assert f'"{key}"' in str(error) or '"reasons"' in str(error) or "mesh_" in str(error), key
    assert refused > len(KEYS) / 5  # a number is right for most keys
