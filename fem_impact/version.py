"""The one place of the version: the package, `fem-impact --version` and every outcome read it here."""

__version__ = "0.1.0"
