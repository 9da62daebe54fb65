"""Checks the name of a new robot: it becomes a key on the bus, a Python package and the name of a distribution."""

from __future__ import annotations

import keyword
import sys
from collections.abc import Iterator
from importlib.util import find_spec

from tailor.schemas.errors import UsageError
from tailor.schemas.packages.discovery import packages
from tailor.schemas.packages.spec import NAME, RESERVED

TAKEN = ("data", "tests")  # folders beside the package


def package_of(name: str) -> str:
    """Name of the Python package of a robot, e.g. `my_cart` of `my-cart`."""
    return name.replace("-", "_")


def check_name(name: str) -> None:
    """Check that a new robot can have this name.

    Raises:
      UsageError: It cannot; the message gives the reason.
    """
    for reason in _objections(name):
        raise UsageError(f"NAME is '{name}', {reason}")


def _objections(name: str) -> Iterator[str]:
    if not NAME.fullmatch(name):
        yield "expected lower-case letters, digits, - and _, first a letter"
        return
    if name[-1] in "-_":
        yield "expected a letter or digit at its end: pip takes no other name of a distribution"
    package = package_of(name)
    if name in RESERVED:
        yield "expected another name: keys of Tailor's own begin with it"
    if keyword.iskeyword(package):
        yield "expected another name: this is a word of Python"
    if package in TAKEN:
        yield f"expected another name: {package}/ lies beside the package"
    for other in packages():
        if name == other.name or (other.spec and name in (other.spec.robot, other.spec.package)):
            yield f"expected another name: {other.declared_in} has it already"
    if package in sys.stdlib_module_names or find_spec(package) is not None:
        yield f"expected another name: there is a Python module '{package}' already"
