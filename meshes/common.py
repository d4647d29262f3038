"""Array types and errors of the mesh package."""

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]


class MeshError(ValueError):
    """A mesh cannot be built or is not usable; the message names the place and the remedy."""


class MissingReaderError(MeshError):
    """A format whose library is not installed."""

    def __init__(self, library: str, ending: str) -> None:
        super().__init__(
            f"a file {ending} is read by the library {library}, which is not installed. Install it, or write "
            "the mesh in another format, such as .vtu."
        )


class ClosedEndError(MeshError):
    """A bore begins too near to an end for the cells between them.

    Attributes
    ----------
    distance : float, m
        From the end to the flat face that closes the bore.
    """

    def __init__(self, distance: float) -> None:
        self.distance = distance
        super().__init__(
            f"the face that closes the bore lies {1e3 * distance:.4g} mm from the end, within the rounding "
            "or slope of the end or too near for cells between them"
        )
