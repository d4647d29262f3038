"""Numbers of LS-DYNA that are stated once (*PARAMETER), and nodes that are moved (*DEFINE_TRANSFORMATION)."""

import re
from collections.abc import Iterable, Mapping

import numpy as np

from meshes.common import FloatArray, MeshError
from meshes.reading.text import fixed_fields, number_of, whole_number

STATED = re.compile(r"([+-]?)&([A-Za-z]\w*)")
WIDE = 10  # letters of a field of the keywords read here


def split(line: str, widths: list[int]) -> list[str]:
    """Return the fields of a line: between commas, or of fixed widths."""
    return [part.strip() for part in line.split(",")] if "," in line else fixed_fields(line, widths)


def parameters(lines: Iterable[str]) -> dict[str, str]:
    """Return the numbers that the lines of *PARAMETER state, by their names in capitals.

    A field of a name begins with the letter of its kind: R, I or C.
    """
    found = {}
    for line in filter(None, lines):
        fields = split(line, [WIDE] * 8)
        for name, value in zip(fields[::2], fields[1::2], strict=False):
            if name:
                found[name[1:].strip().upper()] = value
    return found


def filled(line: str, widths: list[int], known: Mapping[str, str]) -> str:
    """Return a line with the numbers in place of the parameters in it, between commas.

    Raises
    ------
    MeshError
        If one is stated by no *PARAMETER.
    """

    def number(match: re.Match[str]) -> str:
        sign, name = match[1], match[2].upper()
        if name not in known:
            raise MeshError(
                f"has the parameter &{match[2]}, which no *PARAMETER of it states as a number. Write the "
                "deck with the number itself."
            )
        value = known[name]
        return value.removeprefix("-") if (sign, value[:1]) == ("-", "-") else f"{sign}{value}"

    return ",".join(STATED.sub(number, field) for field in split(line, widths))


class Moves:
    """Transformations by their numbers, each a matrix (4, 4) of homogeneous coordinates."""

    def __init__(self) -> None:
        self.known: dict[int, FloatArray] = {}

    def define(self, lines: list[str], what: str) -> None:
        """Take the lines of a *DEFINE_TRANSFORMATION, ``what``.

        Programs differ in whether the first or the last line is done first.

        Raises
        ------
        MeshError
            If a line is not read, or what two lines do depends on their order.
        """
        stated = [line for line in lines if line]
        number = whole_number(split(stated[0], [WIDE])[0], what)
        forward = backward = np.eye(4)
        for line in stated[1:]:
            one = _matrix(split(line, [WIDE] * 8), what)
            forward, backward = one @ forward, backward @ one
        if not np.allclose(forward, backward, rtol=1e-12, atol=1e-9):
            raise MeshError(
                f"moves nodes by *{what} {number} in steps whose order matters, and programs read that order "
                "differently. Write the deck with the nodes where they are."
            )
        self.known[number] = forward

    def moved(self, number: int, places: FloatArray) -> FloatArray:
        """Return places (n, 3) moved by a transformation; by none, 0, they stay.

        Raises
        ------
        MeshError
            If it is not defined.
        """
        if number and number not in self.known:
            raise MeshError(f"moves nodes by a *DEFINE_TRANSFORMATION {number} that is not there.")
        matrix = self.known.get(number, np.eye(4))
        return np.asarray(places @ matrix[:3, :3].T + matrix[:3, 3])


def _matrix(fields: list[str], what: str) -> FloatArray:
    """Return the matrix (4, 4) of a line: what it does and up to seven numbers."""
    kind, numbers = fields[0].upper(), [number_of(text, what) for text in (*fields[1:8], *[""] * 7)[:7]]
    first, second, angle = np.array(numbers[:3]), np.array(numbers[3:6]), np.deg2rad(numbers[6])
    matrix = np.eye(4)
    if kind == "TRANSL":
        matrix[:3, 3] = first
    elif kind == "SCALE":
        matrix[:3, :3] = np.diag(np.where(first == 0.0, 1.0, first))
    elif kind == "MIRROR" and (second != first).any():  # in a plane through the first point
        normal = (second - first) / np.linalg.norm(second - first)
        matrix[:3, :3] -= 2.0 * np.outer(normal, normal)
        matrix[:3, 3] = 2.0 * (first @ normal) * normal
    elif kind == "ROTATE" and angle and first.any():  # about an axis through the second
        x, y, z = first / np.linalg.norm(first)
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        matrix[:3, :3] += np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
        matrix[:3, 3] = second - matrix[:3, :3] @ second
    else:
        raise MeshError(
            f"moves nodes by {kind or 'a blank line'} of *{what}, which is not read. Write the deck with the "
            "nodes where they are."
        )
    return matrix
