"""Detection of threats: steps that may undo a new link, and links that a new step may undo.

Owns the order in which threats are listed, which every count depends on.
"""

from __future__ import annotations

from tailor.executive.planning.ground.ground_action import GroundAction, Span
from tailor.executive.planning.ground.ground_formula import GroundCondition
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground_plans.partial_plan import Link, Threat, new
from tailor.executive.planning.structures.linked_list import cells_of
from tailor.executive.planning.structures.orderings import Orderings, nodes_after

Spanned = tuple[tuple[GroundCondition, Span], ...]
Threats = tuple[Threat | None, int]  # the list and its length
Guarded = list[tuple[int, Link]]
_ALWAYS: tuple[Spanned, ...] = ((),)  # one effect without conditions


def guarded_links(link: Link | None) -> Guarded:
    """Links, newest first, each with the literal that undoes it."""
    return [(each.literal ^ 1, each) for each in cells_of(link)]


class LinksByLiteral:
    """Many links by the literal that undoes them: not all are looked at for each of many new steps."""

    def __init__(self, guarded: Guarded) -> None:
        """Takes the links, newest first."""
        self._guarded = guarded
        self._places: dict[int, list[int]] = {}
        for place, (undoing, _) in enumerate(guarded):
            self._places.setdefault(undoing, []).append(place)

    def undone_by(self, action: GroundAction) -> Guarded:
        """The links that an action may undo, newest first."""
        places = sorted(place for literal in action.bits for place in self._places.get(literal, ()))
        return [self._guarded[place] for place in places]


def threats_to(
    task: GroundTask,
    steps: tuple[GroundAction, ...],
    orderings: Orderings,
    undoing: int,
    link: Link,
    threats: Threat | None,
    count: int,
) -> Threats:
    """Adds the threats to a new link by the nodes in the mask `undoing`; the oldest node ends at the head."""
    if not undoing:
        return threats, count
    producer, literal, first, last, _ = link
    late = orderings.late
    mask = undoing & ~nodes_after(orderings, first, last) & ~(1 << producer)
    if first == last:
        mask &= ~(1 << first)  # the consumer may undo its own condition, except a condition over all at its start
    while mask:
        node = mask.bit_length() - 1
        mask ^= 1 << node
        if not late[node] >> producer & 1:
            for conditions in _ALWAYS if task.simple else _deletions_at(task, steps, node, literal ^ 1):
                threats = new(Threat, (link, node, conditions, threats))
                count += 1
    return threats, count


def _deletions_at(task: GroundTask, steps: tuple[GroundAction, ...], node: int, literal: int) -> tuple[Spanned, ...]:
    """The conditions under which a node, of a step or of a timed literal, makes a literal true."""
    step = task.step_of(node)
    return _deletions(steps[step - 1], literal, (node - task.first_node) % task.moments) if step else _ALWAYS


def threats_by(
    action: GroundAction, node: int, orderings: Orderings, guarded: Guarded, threats: Threat | None, count: int
) -> Threats:
    """Adds the threats by a new step to older links, newest link first."""
    bits, late = action.bits, orderings.late
    for undoing, link in [pair for pair in guarded if pair[0] in bits]:
        mask = bits[undoing] << node & ~nodes_after(orderings, link.first, link.last)
        while mask:
            at = mask.bit_length() - 1
            mask ^= 1 << at
            if not late[at] >> link.producer & 1:
                for conditions in _deletions(action, undoing, at - node):
                    threats = new(Threat, (link, at, conditions, threats))
                    count += 1
    return threats, count


def _deletions(action: GroundAction, literal: int, moment: int) -> tuple[Spanned, ...]:
    """The conditions under which an action makes a literal true at a moment; one empty tuple if unconditional."""
    if action.simple:
        return _ALWAYS
    alternatives = tuple(e.conditions for e in action.effects if e.literal == literal and e.moment == moment)
    return _ALWAYS if () in alternatives else alternatives
