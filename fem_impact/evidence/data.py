"""Data files of the evidence: tables, texts, and scenes stated as changes of a shipped one."""

import csv
import tomllib
from collections.abc import Mapping
from importlib.resources import files
from typing import Any


def read_data(place: str) -> str:
    """Return the text of a file below ``fem_impact/evidence``."""
    return files("fem_impact.evidence").joinpath(place).read_text(encoding="utf-8")


def read_table(place: str) -> list[dict[str, str]]:
    """Return the rows of a CSV file, without its comments."""
    return [*csv.DictReader(line for line in read_data(place).splitlines() if not line.startswith("#"))]


def read_stated(place: str) -> dict[str, dict[str, Any]]:
    """Return the tables of a TOML file by name."""
    return tomllib.loads(read_data(place))


def scene_keys(table: Mapping[str, Any], above: str = "") -> dict[str, Any]:
    """Return what a scene file states by its keys, such as ``impact.angle``."""
    keys: dict[str, Any] = {}
    for name, value in table.items():
        keys |= scene_keys(value, f"{above}{name}.") if isinstance(value, dict) else {above + name: value}
    return keys
