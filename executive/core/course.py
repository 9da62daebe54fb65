"""The running course: whether it still serves, how likely it fails among the objects believed now, and what changes it
without a new search.
"""

from __future__ import annotations

from dataclasses import replace

from tailor.executive import planning
from tailor.executive.core.action_cycle import after_action
from tailor.executive.core.effects import begun, facts_now, served_action
from tailor.executive.core.execution import Running, first_action
from tailor.executive.core.modes import Mode
from tailor.executive.core.perception import slow_inputs
from tailor.executive.core.state import Halt, State, Task
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.deliberation import Decision
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.executive.interfaces.values import Belief
from tailor.executive.refinement.course_check import risen_failure
from tailor.executive.refinement.course_shortcut import shortcut

# In which a robot brakes and stops turning before it decides anew: AGILO from 0.5 m/s at 0.8 m/s², and from 1 rad/s at
# 1.3 rad/s². Models know no turning: of 300 training starts, 4 were lost to decisions of turning robots.
HALT_NS = 800_000_000
HALT_COST_S = 3.0  # expected price of the failures that a halt must save: it takes half of that, and loses speed
AT_RISK = Cause(Reason.COURSE_AT_RISK)
LOST_TICKS = 3  # in a row for which a fact is not observed: a percept that is wrong once changes no plan
SEARCH_TICKS = 10  # for which a robot drives on while another plan than the lost one is searched for; then it brakes
# Each time that a plan was given up for a fact it must be missing for twice as long, at most 4.8 s: a percept that
# comes and goes would otherwise turn the robot around again and again.
MAX_DOUBLINGS = 4


def risk_of_course(context: Context, belief: Belief, decision: Decision) -> tuple[float, bool]:
    """See `risen_failure`; (0, False) unless objects have changed."""
    now, choice = decision.watch.among_changed_objects(belief), decision.choice
    if now is None:
        return 0.0, False
    models, settings = context.models, context.settings.refinement
    return risen_failure(decision.sequence, choice.values, choice.failure, now, models, settings)


def with_supports_checked(context: Context, state: State) -> State:
    """The state with this tick's check of the facts that the plan still needs noted with the running action.

    An action before which a subgoal can be put starts well from anywhere on its way, so it may also end there. Others,
    such as a grip, end first: half of one is no state to plan from.
    """
    running = state.task.running
    if running is None or state.mode is not Mode.EXECUTING or not (running.asserted or running.action.subgoal_action):
        return state
    task, missing = state.task, _lost_support(context, state, running)
    if missing is None:
        return replace(state, task=replace(task, running=replace(running, unsupported=0, is_lost=False)))
    running = replace(running, unsupported=running.unsupported + 1)
    if not running.is_lost and running.unsupported >= LOST_TICKS << min(task.lost.count(missing), MAX_DOUBLINGS):
        running = replace(running, is_lost=True, lost=Cause(Reason.SUPPORT_LOST, str(missing)))
        task = replace(task, lost=(*task.lost, missing))
    return replace(state, task=replace(task, running=running))


def _lost_support(context: Context, state: State, running: Running) -> planning.Literal | None:
    """A literal that the plan takes from its start, and that does not hold now.

    Either a later step needs it, or the running action all along, as it does not change it (a prevail condition of
    SAS+, Bäckström and Nebel 1995). Predicates that the running action changes are in flux until it ends.
    """
    task = state.task
    action = served_action(task.plan, running)
    if task.plan is None or action is None:
        return None
    facts = facts_now(context, state)
    in_flux = {effect.atom.predicate for effect in context.pddl_domain.bound(action)[0].effects}
    for link in task.plan.links:
        literal, taken = link.literal, link.producer == 0 and link.literal.fact[0] not in in_flux
        if taken and not literal.holds_in(facts):
            return literal
    return None


def halted(context: Context, state: State, cause: Cause = AT_RISK) -> State:
    """End an action that objects have made likely to fail, that is too fast for a new way, or that serves no plan.

    The robot brakes first, and decides at rest.
    """
    halt = Halt(state.now_ns + HALT_NS, cause)
    task, coasted = after_action(state.task), context.settings.coast_ticks
    return replace(state, task=task, deliberation=None, coasted=coasted, halt=halt)


def halted_if_lost(context: Context, state: State) -> State:
    """End an action whose plan has lost what it needs, since no other course follows it; any other one goes on."""
    running = state.task.running
    lost = running.lost if running is not None and running.is_lost else None
    return state if lost is None else halted(context, state, lost)


def shortened(context: Context, state: State) -> State:
    """Go on without the asserted subgoal that the robot drives to, if the way from here is better without it."""
    task = state.task
    assert task.running is not None
    assert task.decision is not None
    decided = task.decision
    first = decided.sequence.actions[0]
    if not (task.running.asserted and first.asserted and first.context):
        return state
    now = decided.watch.sequence(state.belief) if slow_inputs(context, state) is None else None
    if now is None:
        return state
    found = shortcut(decided.sequence, decided.choice, now, context.models, context.settings.refinement)
    if found is None:
        return state
    sequence, choice = found
    decision = replace(
        decided, sequence=sequence, choice=choice, made_ns=state.now_ns, watch=decided.watch.of(sequence)
    )
    task = redirected(context, replace(task, decision=decision), task.running, state.now_ns)
    return replace(state, task=task, deliberation=None)  # its search was for the way with the subgoal


def redirected(context: Context, task: Task, running: Running, now_ns: int) -> Task:
    """The running action with new parameters if the decision begins with it, otherwise the decision's first action."""
    assert task.decision is not None
    following = first_action(task.decision, context.models, now_ns)
    if starts_another(task.decision, running):
        return begun(context, replace(task, finished=task.finished + 1), task.decision.plan, following)
    return replace(task, running=running.redirected(following, task.decision.made_ns))


def starts_another(decision: Decision, running: Running) -> bool:
    """Whether a decision begins with another action than the running one."""
    first = decision.sequence.actions[0]
    same = (running.action.name, running.step, running.asserted)  # an action may be its own subgoal action
    return (first.action.name, first.step, first.asserted) != same
