"""Physical checks that every scene passes, however it was made: from a file or from Python."""

import re
from typing import Any

from fem_impact.errors import SceneError
from fem_impact.scene.parameter import Parameter

_ID = re.compile(r"[a-z0-9](?:[a-z0-9-]{0,62}[a-z0-9])?")


def check_numbers(part: object, parameters: tuple[Parameter, ...]) -> None:
    """Check every number of a frozen dataclass against its table and store it as int or float."""
    for parameter in parameters:
        value = getattr(part, parameter.key)
        if value is not None or not parameter.derived:
            object.__setattr__(part, parameter.key, parameter.checked(value))


def check_text(value: Any, key: str, longest: int = 300) -> str:
    """Return printable text of a sensible length."""
    if not isinstance(value, str):
        raise SceneError("must be text.", key=key, value=value, remedy='Write it in quotes, "like this".')
    if not value.isprintable() or len(value) > longest:
        raise SceneError(
            f"must be one line of printable text, at most {longest} characters.", key=key, value=value
        )
    return value


def check_id(value: Any, key: str) -> str:
    """Return an identifier that is safe as the name of a directory."""
    if not isinstance(value, str) or not _ID.fullmatch(value):
        raise SceneError(
            "is not an identifier: it names the directory of the results.",
            key=key,
            value=value,
            remedy='Use small letters, digits and hyphens, such as "my-rod-45".',
        )
    return value


def check_names(value: Any, key: str) -> tuple[str, ...]:
    """Return a list of names, or the one word "auto", as a tuple; what they name is the plan's business."""
    names = (value,) if value == "auto" else value
    listed = isinstance(names, (list, tuple)) and all(isinstance(name, str) for name in names)
    if not listed:
        raise SceneError('must be "auto" or a list of names.', key=key, value=value)
    return tuple(check_text(name, key, 60) for name in names)


def check_choice(value: Any, choices: tuple[str, ...], key: str, other: str = "") -> str:
    """Return one of a few words; ``other`` says what else may stand there."""
    if value not in choices:
        quoted = [f'"{choice}"' for choice in choices]
        either = " or ".join([", ".join(quoted[:-1]), quoted[-1], *([other] if other else [])])
        raise SceneError("is not a choice.", key=key, value=value, remedy=f"Use {either}.")
    return str(value)
