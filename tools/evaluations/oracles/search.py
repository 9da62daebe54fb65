"""Oracle that searches: simulates changes of one place's free parameters at a time, from what was chosen by models.

For scenarios with too many free parameters for a grid. It knows from the start what a run finds out on its way, so what
it finds is not quite within reach of any executive; more runs may find more, so it is a lower bound of the ceiling.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from tailor.executive.interfaces.domain import Domain
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.tools.evaluations.dependencies import SEARCH, dependencies
from tailor.tools.evaluations.journal import Journal
from tailor.tools.evaluations.oracles.grid import N_AGAIN, Oracle
from tailor.tools.evaluations.outcome import OTHER_NOISE, Outcome, Task, Variant
from tailor.tools.evaluations.progress import tracked
from tailor.tools.evaluations.task_runs import run_one, run_task
from tailor.tools.lockstep.run import Run
from tailor.tools.parallel.pool import completed

SEARCH_STREAM = 5
FIRST_SHARE = 0.25  # of a range: standard deviation of the first changes
GROWTH, DECAY = 1.5, 0.9  # of it after a change that was faster, and after one that was not: one in five keeps it
P_CHANGED = 0.6  # probability that a parameter of the place is changed
ASSERTED = "subgoal"  # labels of asserted subgoals begin so

Key = tuple[str, str]  # label, quantity
Choice = Mapping[Key, float]
Ranges = Mapping[Key, tuple[float, float]]


def search_choices(
    task: Task, seeds: Sequence[int], settings: RefinementSettings, runs: int, jobs: int, store: Path | None
) -> tuple[list[Oracle], list[Oracle]]:
    """Search at every seed, from the choices of the greedy and the refined run.

    Args:
      task: Scenario to run.
      seeds: Of the starts.
      settings: Of the refined run that the search starts from.
      runs: Changes simulated from each start.
      jobs: Processes.
      store: Folder of finished starts, which are not searched again; None stores nothing.

    Returns:
      What was found from each start after half of the runs, and after all of them.
    """
    refined = Variant(f"oracle-{runs}", settings)
    names = ("half", "all", *(f"again-{k}" for k in range(1, N_AGAIN + 1)))
    known = dependencies(task, refined, SEARCH)
    journals = [Journal(store, task, replace(refined, name=f"{refined.name}-{n}"), known) for n in names]
    found = {seed: [j.known[seed] for j in journals] for seed in seeds if all(seed in j.known for j in journals)}
    wanted = [seed for seed in seeds if seed not in found]
    running = completed(search_start, [(task, refined, seed, runs) for seed in wanted], jobs)
    for number, outcomes in tracked(running, f"{task.scenario}: oracle", len(wanted)):
        found[wanted[number]] = outcomes
        for journal, outcome in zip(journals, outcomes, strict=True):
            journal.note(outcome)
    return [_oracle(seed, found[seed], 0) for seed in seeds], [_oracle(seed, found[seed], 1) for seed in seeds]


def search_start(task: Task, refined: Variant, seed: int, runs: int) -> list[Outcome]:
    """Outcomes at one seed: best after half of the runs, best after all, and that choice with other noise."""
    alone = Variant(refined.name, replace(refined.refinement, horizon=1))  # nothing is left to look ahead for
    chosen = [last_choice(*_run(task, variant, seed)) for variant in (refined, alone)]
    search = Search(chosen[0][1], np.random.default_rng([seed, SEARCH_STREAM]))
    for choice, _ in chosen:
        search.note(choice, _pinned(task, alone, choice, seed))
    half = search.best
    for number in range(runs if search.labels else 0):
        choice = search.propose(number)
        search.note(choice, _pinned(task, alone, choice, seed))
        if number < runs // 2:
            half = search.best
    again = [_pinned(task, replace(alone, noise=k * OTHER_NOISE), search.choice, seed) for k in range(1, N_AGAIN + 1)]
    return [half, search.best, *again]


class Search:
    """A (1+1) evolution strategy, by turns over the parameters of each label.

    Args:
      ranges: Of the free parameters.
      rng: Source of all changes.

    Attributes:
      choice: The fastest one so far.
      best: Its run.
      labels: Whose parameters are changed, in turns; without any there is nothing to propose.
    """

    def __init__(self, ranges: Ranges, rng: np.random.Generator) -> None:
        self.choice: Choice = {}
        self.best: Outcome
        self._ranges, self._rng = ranges, rng
        self.labels = sorted({label for label, _ in ranges})
        self._shares = dict.fromkeys(self.labels, FIRST_SHARE)
        self._label: str | None = None  # of the proposal that is simulated
        self._best_s = float("inf")

    def propose(self, number: int) -> Choice:
        """The fastest choice with other values at one label, within their ranges."""
        self._label = self.labels[number % len(self.labels)]
        here = [key for key in self._ranges if key[0] == self._label]
        changed = self._rng.random(len(here)) < P_CHANGED
        changed[self._rng.integers(len(here))] = True
        steps = self._rng.normal(0.0, self._shares[self._label], len(here))
        choice = dict(self.choice)
        for key, step in zip((k for k, c in zip(here, changed, strict=True) if c), steps[changed], strict=True):
            lower, upper = self._ranges[key]
            before = choice.get(key, (lower + upper) / 2)  # a run that failed early may not have had it
            choice[key] = float(np.clip(before + step * (upper - lower), lower, upper))
        return choice

    def note(self, choice: Choice, outcome: Outcome) -> None:
        """Keep a choice that is no slower; adapt the size of changes at its label.

        Durations are whole ticks: without steps among equal ones the search stays where it is.
        """
        duration_s = outcome.duration_s if outcome.achieved else float("inf")
        faster = duration_s < self._best_s
        if duration_s <= self._best_s:
            self.choice, self.best, self._best_s = choice, outcome, duration_s
        if self._label is not None:
            share = self._shares[self._label] * (GROWTH if faster else DECAY)
            self._shares[self._label] = min(1.0, share)


def last_choice(run: Run, domain: Domain) -> tuple[Choice, Ranges]:
    """Last values of each parameter of a run while it was free, and their ranges then; asserted subgoals left out."""
    choice, ranges = {}, {}
    for instance in (instance for subgoals in run.subgoals for instance in subgoals.actions):
        quantities = {declared.name: declared.quantity for declared in domain.actions[instance.action].parameters}
        for parameter in instance.parameters:
            if not parameter.bound and not parameter.label.startswith(ASSERTED):
                key = (parameter.label, quantities[parameter.name])
                choice[key], ranges[key] = parameter.value, (parameter.lower, parameter.upper)
    return choice, ranges


def _run(task: Task, variant: Variant, seed: int) -> tuple[Run, Domain]:
    run, context = run_task(task, variant, seed)
    return run, context.domain


def _pinned(task: Task, variant: Variant, choice: Choice, seed: int) -> Outcome:
    pins = tuple((label, quantity, value) for (label, quantity), value in choice.items())
    return run_one(task, replace(variant, pins=pins), seed)


def _oracle(seed: int, outcomes: Sequence[Outcome], which: int) -> Oracle:
    """Of the outcomes of `search_start`; greedy and zero are not simulated."""
    best, again = outcomes[which], [outcome.duration_s for outcome in outcomes[2:] if outcome.achieved]
    unknown = float("nan")
    best_s = best.duration_s if best.achieved else unknown
    return Oracle(seed, best_s, unknown, unknown, float(np.mean(again)) if again else unknown)
