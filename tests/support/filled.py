"""Messages with a distinct value in every field, for tests of the wire format."""

from dataclasses import fields, is_dataclass
from typing import get_args, get_type_hints

STAMP_NS = 1_500_000_007


def filled(kind):
    """A legal message: its field number in every number and text, two elements in every sequence."""
    hints = get_type_hints(kind)
    return kind(*(_value(field.name, hints[field.name], number) for number, field in enumerate(fields(kind), start=1)))


def _value(name, hint, number):
    if name == "stamp_ns":
        return STAMP_NS
    plain = {int: number, float: number / 8, str: f"text {number}", bool: bool(number % 2)}
    if hint in plain:
        return plain[hint]
    item = get_args(hint)[0]
    if is_dataclass(item):
        return (filled(item), filled(item))
    if item is float:
        return (plain[float], -plain[float])
    return (plain[item], plain[item])
