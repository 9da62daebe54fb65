"""The engine: plans once, ever better ones, and validation of plans."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any
from warnings import warn

from unified_planning.engines import Engine
from unified_planning.engines.mixins import AnytimePlannerMixin, OneshotPlannerMixin, PlanValidatorMixin
from unified_planning.engines.mixins.anytime_planner import AnytimeGuarantee
from unified_planning.engines.results import (
    LogLevel,
    LogMessage,
    PlanGenerationResult,
    PlanGenerationResultStatus,
    ValidationResult,
    ValidationResultStatus,
)
from unified_planning.exceptions import UPException
from unified_planning.model import ProblemKind
from unified_planning.plans import PlanKind

from tailor.executive.planning import (
    Result,
    Settings,
    UndecidedError,
    Unsupported,
    validate,
    validate_every_order,
)
from tailor.executive.planning.settings import MAX_TICK_S, MIN_TICK_S
from tailor.schemas.errors import UsageError
from tailor.tools.plan_search.limits import Limits
from tailor.tools.up_engine import NAME
from tailor.tools.up_engine.parameters import checked
from tailor.tools.up_engine.searches import Improvement, once
from tailor.tools.up_engine.supported import supported_kind
from tailor.tools.up_engine.time_rules import broken_rule
from tailor.tools.up_engine.translation import Translation

Status = PlanGenerationResultStatus
PLANS = (PlanKind.PARTIAL_ORDER_PLAN, PlanKind.SEQUENTIAL_PLAN, PlanKind.TIME_TRIGGERED_PLAN)


class TailorEngine(Engine, OneshotPlannerMixin, AnytimePlannerMixin, PlanValidatorMixin):  # type: ignore[misc]
    """Partial-order plans, or time-triggered ones for problems with time.

    Args:
      memory_mb: Limit of the memory that a search takes.
      **settings: Fields of `Settings`, e.g. engine="pocl", node_limit=10_000, flaw_orders=["LCFR"].

    Raises:
      UsageError: A parameter has no such name, or a value of another type or range.
    """

    def __init__(self, memory_mb: float = 512.0, **settings: Any) -> None:
        Engine.__init__(self)
        OneshotPlannerMixin.__init__(self)
        AnytimePlannerMixin.__init__(self)
        if isinstance(memory_mb, bool) or not isinstance(memory_mb, (int, float)) or not memory_mb > 0.0:
            raise UsageError(f"engine {NAME}: expected memory_mb to be a number of MB, found {memory_mb!r}")
        self._memory_mb = memory_mb
        self._settings = checked(settings)

    @property
    def name(self) -> str:
        """See `Engine`."""
        return NAME

    @staticmethod
    def supported_kind() -> ProblemKind:
        """See `Engine`."""
        return supported_kind()

    @staticmethod
    def supports(problem_kind: ProblemKind) -> bool:
        """See `Engine`."""
        return bool(problem_kind <= supported_kind())

    @staticmethod
    def ensures(anytime_guarantee: AnytimeGuarantee) -> bool:
        """Each plan is better than the one before."""
        return bool(anytime_guarantee is AnytimeGuarantee.INCREASING_QUALITY)

    @staticmethod
    def supports_plan(plan_kind: PlanKind) -> bool:
        """See `PlanValidatorMixin`."""
        return plan_kind in PLANS

    # --- planning --------------------------------------------------------------------------------
    def _solve(
        self,
        problem: Any,
        heuristic: Callable[[Any], float | None] | None = None,
        timeout: float | None = None,
        output_stream: Any = None,
    ) -> PlanGenerationResult:
        _warn_of_unused(heuristic=heuristic, output_stream=output_stream)
        try:
            task = self._task(problem)
        except UsageError as reason:
            return self._refused(reason)
        limits = self._limits(timeout)
        result = once(task, self._settings_of(task), limits)
        return self._result(task, result, _status(result, task, limits))

    def _get_solutions(
        self, problem: Any, timeout: float | None = None, output_stream: Any = None
    ) -> Iterator[PlanGenerationResult]:
        _warn_of_unused(output_stream=output_stream)
        try:
            task = self._task(problem)
        except UsageError as reason:
            yield self._refused(reason)
            return
        limits = self._limits(timeout)
        search = Improvement(task, self._settings_of(task), limits)
        for better in search.run():
            yield self._result(task, better, Status.INTERMEDIATE)
        last = search.last
        optimal = last.plan is not None and search.is_proven and problem.quality_metrics and not task.timed
        yield self._result(task, last, Status.SOLVED_OPTIMALLY if optimal else _status(last, task, limits))

    def _task(self, problem: Any) -> Translation:
        """The translation of a problem whose epsilon can be a tick.

        Raises:
          UsageError: As `Translation.of`.
          Unsupported: The epsilon is too small or too large.
        """
        task = Translation.of(problem)
        if "tolerance_s" not in self._settings and not MIN_TICK_S <= task.tick_s <= MAX_TICK_S:
            expected = f"expected {MIN_TICK_S:g} to {MAX_TICK_S:g} s"
            raise Unsupported(f"an epsilon of {task.tick_s:g} s is not supported; {expected}")
        return task

    def _settings_of(self, task: Translation) -> Settings:
        return Settings(**{"tolerance_s": task.tick_s, **self._settings})

    def _limits(self, timeout: float | None) -> Limits:
        return Limits(math.inf if timeout is None else timeout, self._memory_mb)

    def _result(self, task: Translation, result: Result, status: PlanGenerationResultStatus) -> PlanGenerationResult:
        plan = None if result.plan is None else task.to_unified(result.plan)
        metrics = {"plans_generated": str(result.generated), "plans_visited": str(result.visited)}
        return PlanGenerationResult(status, plan, self.name, metrics, _log(result.reason))

    def _refused(self, reason: UsageError) -> PlanGenerationResult:
        """What cannot be translated: a feature that we lack, or a problem beyond the limits of the parser."""
        status = Status.UNSUPPORTED_PROBLEM if isinstance(reason, Unsupported) else Status.UNSOLVABLE_INCOMPLETELY
        return PlanGenerationResult(status, None, self.name, None, _log(str(reason)))

    # --- validation ------------------------------------------------------------------------------
    def _validate(self, problem: Any, plan: Any) -> ValidationResult:
        try:
            task = Translation.of(problem)
            ours = task.from_unified(plan)
            if task.timed and plan.kind is not PlanKind.TIME_TRIGGERED_PLAN:
                raise UndecidedError("a problem with time is validated by its schedule: a time-triggered plan")
            check = validate if task.timed else validate_every_order
            fault = broken_rule(problem, plan) if task.timed else ""
            fault = fault or check(ours, task.domain, task.problem)
        except (UndecidedError, UsageError) as reason:
            return ValidationResult(ValidationResultStatus.UNKNOWN, self.name, _log(str(reason)))
        except UPException as reason:
            fault = str(reason)
        status = ValidationResultStatus.INVALID if fault else ValidationResultStatus.VALID
        return ValidationResult(status, self.name, _log(fault))


def _status(result: Result, task: Translation, limits: Limits) -> PlanGenerationResultStatus:
    """unified-planning's status of a search that has ended.

    Times are whole ticks, so with an unspecified epsilon the absence of a plan is no proof.
    """
    if result.plan is not None:
        return Status.SOLVED_SATISFICING
    if result.status == "unsolvable":
        return Status.UNSOLVABLE_INCOMPLETELY if task.timed else Status.UNSOLVABLE_PROVEN
    if result.status == "unsupported":
        return Status.UNSUPPORTED_PROBLEM
    if "memory" in limits.reason:
        return Status.MEMOUT
    return Status.TIMEOUT if limits.reason else Status.UNSOLVABLE_INCOMPLETELY


def _log(reason: str) -> list[LogMessage]:
    return [LogMessage(LogLevel.INFO, reason)] if reason else []


def _warn_of_unused(**arguments: Any) -> None:
    for name, value in arguments.items():
        if value is not None:
            warn(f"{NAME} ignores {name}", stacklevel=4)
