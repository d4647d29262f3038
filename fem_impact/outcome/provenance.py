"""Where a record comes from: date and versions."""

from __future__ import annotations

import platform
from datetime import UTC, datetime
from importlib import metadata

__all__ = ["PACKAGES", "installed_versions", "utc_now"]

PACKAGES = ("numpy", "scipy", "scikit-fem", "numba", "fem-impact")


def utc_now() -> str:
    """Return the present time as ISO 8601 in UTC, to the second."""
    return datetime.now(UTC).replace(microsecond=0).isoformat()


def installed_versions() -> dict[str, str]:
    """Return the versions of Python and of the packages that shape a result.

    Returns
    -------
    dict of str to str
        Name to version; "not installed" where a package is absent.
    """
    return {"python": platform.python_version(), **{name: _version(name) for name in PACKAGES}}


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "not installed"
