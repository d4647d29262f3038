"""What lies where in a frame of a film, in pixels: one rod with its close-up, or several side by side."""

from dataclasses import dataclass

from fem_impact.errors import UsageError


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A rectangle in pixels."""

    left: int
    top: int
    width: int
    height: int

    @property
    def corner(self) -> tuple[int, int]:
        """The upper left corner."""
        return (self.left, self.top)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height."""
        return (self.width, self.height)


@dataclass(frozen=True, slots=True)
class Frame:
    """A picture of a film.

    Parameters
    ----------
    width, height : int, px
        Multiples of 16, as video encoders want them.
    """

    width: int
    height: int

    def __post_init__(self) -> None:
        if self.width % 16 or self.height % 16 or self.width < 640 or self.height < 480:
            raise UsageError(
                "is no size of a film.",
                key="size=",
                value=f"{self.width}x{self.height}",
                remedy="Use multiples of 16, 640x480 at least.",
            )

    def share(self, left: int, top: int, width: int, height: int) -> tuple[float, float, float, float]:
        """Return a rectangle as matplotlib wants it: shares of the frame from the lower left corner."""
        across, down = self.width, self.height
        return (left / across, 1.0 - (top + height) / down, width / across, height / down)


@dataclass(frozen=True, slots=True)
class FrameLayout(Frame):
    """Two views side by side over a strip with the force curve."""

    @property
    def rod(self) -> Rectangle:
        """The view of the whole rod."""
        return Rectangle(24, 74, self.width // 2 - 36, self.height - 310)

    @property
    def close(self) -> Rectangle:
        """The view of the contact."""
        return Rectangle(self.width // 2 + 12, 74, self.width // 2 - 36, self.height - 310)

    @property
    def beside(self) -> Rectangle:
        """The place of curves instead of the view of the contact: its colour bar is not needed."""
        close = self.close
        return Rectangle(close.left, close.top, close.width, close.height + 36)

    @property
    def strip(self) -> Rectangle:
        """The strip of the force curve."""
        return Rectangle(74, self.height - 176, self.width - 108, 132)


@dataclass(frozen=True, slots=True)
class SideBySideLayout(Frame):
    """Views of several rods side by side, each over its own force curve.

    Parameters
    ----------
    count : int
        Number of rods.
    """

    count: int

    @property
    def views(self) -> tuple[Rectangle, ...]:
        """The views of the rods."""
        return tuple(Rectangle(left, 74, self._across - 16, self.height - 290) for left in self._lefts)

    @property
    def strips(self) -> tuple[Rectangle, ...]:
        """The strips of the force curves."""
        return tuple(Rectangle(left + 46, self.height - 176, self._across - 66, 132) for left in self._lefts)

    @property
    def _across(self) -> int:
        return (self.width - 32) // self.count

    @property
    def _lefts(self) -> tuple[int, ...]:
        return tuple(16 + at * self._across for at in range(self.count))
