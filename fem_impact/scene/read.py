"""From a scene file, or the same tables in Python, to a checked `Scene`."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fem_impact.errors import SceneError, UsageError
from fem_impact.scene import library
from fem_impact.scene.sections import read_scene
from fem_impact.scene.types import Scene

__all__ = ["read_dict", "read_toml"]

_LARGEST_FILE = 1_000_000
_TOML = 'A scene is a TOML file: key = value lines under [section] headings, text in "quotes".'


def read_toml(path: str | Path) -> Scene:
    """Read one scene file."""
    return read_dict(_parse(_load(Path(path)), str(path)), str(path))


def read_dict(data: Mapping[str, Any], source: str) -> Scene:
    """Check nested tables and make the scene; ``source`` is named in every message."""
    try:
        return read_scene(data)
    except SceneError as error:
        raise error.under("", source) from None


def _load(path: Path) -> str:
    """Return the text of a file that is small enough to be a scene."""
    try:
        with path.open("rb") as file:
            raw = file.read(_LARGEST_FILE + 1)
        text = raw.decode("utf-8-sig")
    except FileNotFoundError:
        raise UsageError("there is no such file.", source=str(path), remedy=library.proposal(path)) from None
    except IsADirectoryError:
        remedy = f"Name the file, such as {path / 'scene.toml'}."
        raise SceneError("is a directory, not a scene file.", source=str(path), remedy=remedy) from None
    except UnicodeDecodeError:
        raise SceneError("is not UTF-8 text.", source=str(path), remedy=_TOML) from None
    except (OSError, ValueError) as error:
        raise SceneError(f"cannot be read ({error}).", source=str(path)) from None
    if len(raw) > _LARGEST_FILE:
        raise SceneError("is larger than a megabyte.", source=str(path), remedy=_TOML)
    return text


def _parse(text: str, source: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise SceneError(f"is not readable as TOML: {error}.", source=source, remedy=_TOML) from None
