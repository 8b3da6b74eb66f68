"""The compiled half of the package: to type checkers its names are Any."""

from typing import Any

def __getattr__(name: str) -> Any: ...
