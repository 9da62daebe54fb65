"""The forward engine: search through states, then a partial-order plan with as few orderings as validity allows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tailor.executive.planning.forward.forward_search import ForwardSearch
from tailor.executive.planning.forward.strips_task import NotClassical, StripsAction, StripsTask, strips_task
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground.grounding import GroundActions
from tailor.executive.planning.plans.plan import Result
from tailor.executive.planning.results import goal_unreachable
from tailor.executive.planning.structures.connectives import FALSE


class ForwardEngine:
    """One search; `generated` and `visited` count successors and evaluated states."""

    def __init__(self, task: GroundTask, grounded: GroundActions, state_limit: int, step_limit: int) -> None:
        self._task = task
        self._world = grounded.world
        self._step_limit = step_limit
        self._search: ForwardSearch | None = None
        self._strips: StripsTask | None = None
        self._unsupported = ""
        try:
            self._strips = strips_task(task, grounded.actions)
            self._search = ForwardSearch(self._strips, state_limit)
        except NotClassical as found:
            self._unsupported = f"the forward engine does not plan with {found}"

    @property
    def generated(self) -> int:
        """Number of successors so far."""
        return self._search.generated if self._search else 0

    @property
    def visited(self) -> int:
        """Number of evaluated states so far."""
        return self._search.visited if self._search else 0

    @property
    def applies(self) -> bool:
        """Whether the task has nothing that the engine does not cover."""
        return not self._unsupported

    @property
    def expected_steps(self) -> int:
        """Steps of a relaxed plan from the initial state; 0 without one."""
        return self._search.expected_steps if self._search else 0

    def run(self) -> Iterator[Result | None]:
        """Evaluates one state per iteration; yields None until the result."""
        search, strips = self._search, self._strips
        if FALSE in self._task.goal:
            yield goal_unreachable()
            return
        if search is None or strips is None:
            yield Result("unsupported", None, self._unsupported, 0, 0)
            return
        for sequence in search.run():
            if sequence is None:
                yield None
                continue
            yield from self._finished(sequence, strips)
            return
        if search.limit_reached:
            yield Result("limit", None, search.limit_reached, search.generated, search.visited)
        else:
            reason = "no sequence of actions reaches the goal"
            yield Result("unsolvable", None, reason, search.generated, search.visited)

    def _finished(self, sequence: Sequence[StripsAction], strips: StripsTask) -> Iterator[Result | None]:
        """Makes a plan of a sequence that reaches the goal; yields None between its stages."""
        # loaded here: most plans are found by partial-order search
        from tailor.executive.planning.forward.deordering import deordered
        from tailor.executive.planning.forward.finished_plan import finished_plan
        from tailor.executive.planning.forward.justification import justified

        kept = yield from justified(sequence, strips)
        yield None
        if len(kept) > self._step_limit:
            yield Result("limit", None, f"no plan of up to {self._step_limit} steps", self.generated, self.visited)
            return
        order = deordered(kept, strips)
        yield None
        plan = finished_plan(kept, order, self._task, self._world)
        yield Result("solved", plan, "", self.generated, self.visited)
