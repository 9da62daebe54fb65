"""Flaw selection orders in VHPOP notation, `{flaw types}[limit]criterion/...`, and the named ones.

Source: Younes & Simmons, JAIR 20 (2003), section 4, after Pollack, Joslin & Paolucci (1997).
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from tailor.executive.planning.pddl.syntax.errors import shortened
from tailor.schemas.errors import UsageError

# n, s: threat without or with a separation; o: open condition; among these t: static, l: local to the step of the
# newest one, u: unsafe (a step may undo it)
FLAW_TYPES = "nsotlu"
HEURISTICS = ("add", "addr", "makespan")
_PLAIN = ("LIFO", "FIFO", "R", "LR", "MR", "NEW", "REUSE")
_ESTIMATED = ("LC", "MC", "LW", "MW")
_CRITERION = re.compile(r"\{([a-z](?:,[a-z])*)\}([0-9]{0,18})([A-Za-z]+)(?:_([A-Za-z]+))?")

NAMED = {
    "UCPOP": "{n,s}LIFO/{o}LIFO",
    "UCPOP-LC": "{n,s}LIFO/{o}LR",
    "DSep-LIFO": "{n}LIFO/{o}LIFO/{s}LIFO",
    "DSep-FIFO": "{n}LIFO/{o}FIFO/{s}LIFO",
    "DSep-LC": "{n}LIFO/{o}LR/{s}LIFO",
    "DUnf-LIFO": "{n,s}0LIFO/{n,s}1LIFO/{o}LIFO/{n,s}LIFO",
    "DUnf-FIFO": "{n,s}0LIFO/{n,s}1LIFO/{o}FIFO/{n,s}LIFO",
    "DUnf-LC": "{n,s}0LIFO/{n,s}1LIFO/{o}LR/{n,s}LIFO",
    "DUnf-Gen": "{n,s,o}0LIFO/{n,s,o}1LIFO/{n,s,o}LIFO",
    "DRes-LIFO": "{n,s}0LIFO/{o}LIFO/{n,s}LIFO",
    "DRes-FIFO": "{n,s}0LIFO/{o}FIFO/{n,s}LIFO",
    "DRes-LC": "{n,s}0LIFO/{o}LR/{n,s}LIFO",
    "DEnd-LIFO": "{o}LIFO/{n,s}LIFO",
    "DEnd-FIFO": "{o}FIFO/{n,s}LIFO",
    "DEnd-LC": "{o}LR/{n,s}LIFO",
    "LCFR": "{n,s,o}LR",
    "LCFR-DSep": "{n,o}LR/{s}LR",
    "ZLIFO": "{n}LIFO/{o}0LIFO/{o}1NEW/{o}LIFO/{s}LIFO",
    "ZLIFO*": "{o}0LIFO/{n,s}LIFO/{o}1NEW/{o}LIFO",
    "Static": "{t}LIFO/{n,s}LIFO/{o}LIFO",
    "LCFR-Loc": "{n,s,l}LR",
    "LCFR-Conf": "{n,s,u}LR/{o}LR",
    "LCFR-Loc-Conf": "{n,s,u}LR/{l}LR",
    "MC": "{n,s}LR/{o}MC_add",
    "MC-Loc": "{n,s}LR/{l}MC_add",
    "MC-Loc-Conf": "{n,s}LR/{u}MC_add/{l}MC_add",
    "MW": "{n,s}LR/{o}MW_add",
    "MW-Loc": "{n,s}LR/{l}MW_add",
    "MW-Loc-Conf": "{n,s}LR/{u}MW_add/{l}MW_add",
}


@dataclass(frozen=True, slots=True)
class Criterion:
    """One selection criterion: flaw types, maximum number of refinements, and the order among the flaws."""

    types: frozenset[str]
    limit: int | None
    order: str  # LIFO FIFO R LR MR NEW REUSE LC MC LW MW
    heuristic: str = ""  # of LC MC LW MW


def parse_flaw_order(text: str) -> tuple[Criterion, ...]:
    """The criteria of a flaw order.

    Args:
      text: A name from `NAMED` or VHPOP notation; case does not matter.

    Raises:
      UsageError: Unknown name, malformed notation, or flaws that no criterion selects.
    """
    names = {name.lower(): notation for name, notation in NAMED.items()}
    notation = names.get(text.lower(), text)
    criteria = tuple(_criterion(part, text) for part in notation.split("/"))
    unlimited = frozenset[str]().union(*(c.types for c in criteria if c.limit is None))
    if not {"n", "s"} <= unlimited or not {"o", "l"} & unlimited:
        raise UsageError(f"flaw order '{text}': some flaws are never selected; end with criteria for n, s and o (or l)")
    return criteria


def _criterion(part: str, text: str) -> Criterion:
    match = _CRITERION.fullmatch(part)
    if match is None:
        raise UsageError(
            f"flaw order '{shortened(text)}': expected a name ({', '.join(NAMED)}) or criteria such as "
            f"{{n,s}}LR/{{l}}MW_add, found '{shortened(part)}'"
        )
    types, limit, order, heuristic = match.groups()
    order, heuristic = order.upper(), (heuristic or "").lower()
    _check(text, types, order, heuristic)
    return Criterion(frozenset(types.split(",")), int(limit) if limit else None, order, heuristic)


def _check(text: str, types: str, order: str, heuristic: str) -> None:
    unknown = set(types.split(",")) - set(FLAW_TYPES)
    if unknown:
        raise UsageError(f"flaw order '{text}': unknown flaw type '{min(unknown)}'; expected some of {FLAW_TYPES}")
    if order not in _PLAIN + _ESTIMATED:
        raise UsageError(f"flaw order '{text}': unknown criterion '{order}'; expected {', '.join(_PLAIN + _ESTIMATED)}")
    if (order in _ESTIMATED) != (heuristic in HEURISTICS):
        raise UsageError(f"flaw order '{text}': LC, MC, LW and MW (and only they) take _{' or _'.join(HEURISTICS)}")
    if order not in ("LIFO", "FIFO", "R", "LR", "MR") and {"n", "s"} & set(types.split(",")):
        raise UsageError(f"flaw order '{text}': '{order}' orders open conditions, not threats")
