"""The error of the package."""


class Error(Exception):
    """The failure of a call: place, failure and how to mend it, as one line.

    >>> import pillarfield as pf
    >>> raise pf.Error("press.h5", "it has no frames", "record some")
    Traceback (most recent call last):
    pillarfield.Error: press.h5: it has no frames; record some
    """

    __module__ = "pillarfield"

    def __init__(self, place: str, failure: str, mend: str = "") -> None:
        super().__init__(place, failure, mend)
        self.place = place  #: file, argument or function; may be empty
        self.failure = failure  #: what failed
        self.mend = mend  #: how to mend it; may be empty

    def __str__(self) -> str:
        start = f"{self.place}: " if self.place else ""
        return start + self.failure + (f"; {self.mend}" if self.mend else "")


class ArgumentError(Error, TypeError):
    """An argument of a wrong type."""


class MissingError(Error, AttributeError):
    """A part that the object does not have, so that hasattr() is False."""


class FrameError(Error, IndexError):
    """A frame beyond the last one."""
