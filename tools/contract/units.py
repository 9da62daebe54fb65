"""Units that a package may declare: SI symbols and compounds of them, such as "m", "rad/s", "m/s²" or "N·m".

A unit has a meaning: "m" marks a place, "rad" is shown in degrees, and pages print it behind its value.
"""

from __future__ import annotations

import re

SYMBOLS = (
    *("1", "m", "g", "s", "A", "K", "mol", "cd", "rad", "sr", "Hz", "N", "Pa", "J", "W", "C", "V", "F", "Ω", "ohm"),
    *("S", "Wb", "T", "H", "lm", "lx", "l", "min", "h", "t", "°", "deg", "°C", "%", "Nm", "Wh", "Ah"),
)
PREFIXES = ("G", "M", "k", "c", "m", "µ", "μ", "u", "n")
EXPECTED = "SI symbols such as m, rad/s, m/s², N·m, or 1"
_FACTOR = re.compile(rf"(?:{'|'.join(PREFIXES)})?(?:{'|'.join(map(re.escape, SYMBOLS))})(?:\^?-?[1-9]|⁻?[¹²³⁴])?")


def is_unit(text: str) -> bool:
    """Whether a text is a unit."""
    return all(_FACTOR.fullmatch(factor) for factor in re.split(r"[/·* ]", text))
