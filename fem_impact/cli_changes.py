"""Read ``--set key=value`` and change a scene by it."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from fem_impact.errors import UsageError

if TYPE_CHECKING:
    from fem_impact.scene import Scene

__all__ = ["changed_scene", "read_changes"]


def changed_scene(id_or_path: str, changes: Sequence[str]) -> Scene:
    """Load a scene and apply the changes of the command line, checked together at the end."""
    from fem_impact.scene import load, replace_all

    scene = load(id_or_path)
    return replace_all(scene, read_changes(changes)) if changes else scene


def read_changes(changes: Sequence[str]) -> dict[str, Any]:
    """Return key and value of each ``key=value``; a value is TOML where it can be, text otherwise."""
    return dict(_one(change) for change in changes)


def _one(change: str) -> tuple[str, Any]:
    key, equals, text = change.partition("=")
    if not equals or not key.strip():
        raise UsageError(
            "is not of the form key=value.",
            key="--set",
            value=change,
            remedy="Write --set accuracy.tip_size='0.5 mm'.",
        )
    return key.strip(), _value(key.strip(), text.strip())


def _value(key: str, text: str) -> Any:
    if key == "effects" and not text.startswith("[") and "," in text:
        return [name.strip() for name in text.split(",")]
    try:
        return tomllib.loads(f"value = {text}")["value"] if "\n" not in text else text
    except (ValueError, RecursionError):
        return text
