"""Limits of the probability of failure where no choice keeps those of all actions.

Assertion checks each action by itself. A heading with which a robot arrives safely may not be one with which it starts
safely, so some choice keeps the limit of each action, and none keeps all of them.
"""

from __future__ import annotations

from dataclasses import replace

from tailor.executive.refinement.assertion.assertion import HOPELESS
from tailor.executive.refinement.assertion.subgoal_comparison import has_limit, with_any_risk
from tailor.executive.refinement.objective.sequence import ActionSequence, InstantiatedAction
from tailor.executive.refinement.objective.settings import RefinementSettings


def relaxed(sequence: ActionSequence, settings: RefinementSettings) -> ActionSequence | None:
    """The sequence with wider limits, so that the least expected cost wins; None if it has the widest already.

    With asserted subgoals there is none any more. Without, among objects, whose price is known, only what is hopeless
    is refused, and elsewhere what is likelier to fail than `p_fail_settle`.
    """
    if has_limit(sequence):
        return with_any_risk(sequence)
    actions = tuple(_relaxed(instance, settings) for instance in sequence.actions)
    if all(new is old for new, old in zip(actions, sequence.actions, strict=True)):
        return None
    return replace(sequence, actions=actions)


def _relaxed(instance: InstantiatedAction, settings: RefinementSettings) -> InstantiatedAction:
    limit = settings.p_fail_max if instance.risk is None else instance.risk
    widest = HOPELESS if instance.context else settings.p_fail_settle
    return replace(instance, risk=widest) if instance.may_fail and limit < widest else instance
