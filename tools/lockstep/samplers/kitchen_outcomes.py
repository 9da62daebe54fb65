"""What the ground truth of a kitchen run shows: failures, contacts, tipped cups, errors at the end, work."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence

from tailor.executive.actions.planar import PHIG, VG, XG, YG
from tailor.executive.belief.angles import difference
from tailor.executive.domains.kitchen.drive_context import TOUCHED
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.values import Array
from tailor.schemas.kitchen.furniture import kitchen
from tailor.schemas.messages import ActionFinished, Message
from tailor.schemas.messages.kitchen import KitchenTruth

TIPPED = "tipped the cup"
SLOW_MPS, REST_MPS, REST_RADPS = 0.1, 0.005, 0.02
TRUTH_S = 0.1  # between two true states
MASS_KG, ROLLING_N = 120.0, 18.0  # of the B21; 1.5 % of its weight resists its rolling


class KitchenOutcomes:
    """Those methods of a task sampler that read runs; see task_sampler.TaskSampler."""

    def failure(self, action: Action, start: Mapping[str, float], truth: Message) -> str:
        """What the truth shows: base or arm touched furniture, or a cup tipped."""
        if not isinstance(truth, KitchenTruth):
            return ""
        tipped = any(each.tilt > kitchen().cup.tipped_rad for each in truth.objects if each.name != truth.held)
        return TOUCHED if truth.touched else TIPPED if tipped else ""

    def work_j(self, before: Message, after: Message) -> float:
        """Work of the base's drive between two states, joules: it speeds up and rolls; the arm's is not counted."""
        if not isinstance(before, KitchenTruth) or not isinstance(after, KitchenTruth):
            return math.nan
        passed_s = (after.stamp_ns - before.stamp_ns) * 1e-9
        gained_j = 0.5 * MASS_KG * (after.v**2 - before.v**2)
        rolled_m = 0.5 * abs(before.v + after.v) * passed_s
        return max(0.0, gained_j + ROLLING_N * rolled_m)

    def start_names(self, action: Action, parameters: Array) -> Mapping[str, str]:
        """No other names: parameters are named as the belief is."""
        return {}

    def disturbance_m(self, finished: Sequence[ActionFinished], truth: Sequence[Message]) -> float:
        """0: cups are there to be moved."""
        return 0.0

    def motion(self, message: Message, newest: Message | None) -> Message | None:
        """The newest ground truth."""
        return message if isinstance(message, KitchenTruth) else newest

    def observed_start(self, message: Message) -> dict[str, float] | None:
        """Touches and tipped cups need nothing to compare with."""
        return {} if isinstance(message, KitchenTruth) else None

    def contacts(self, finished: Sequence[ActionFinished], truth: Sequence[Message]) -> int:
        """Number of pieces of furniture touched anew."""
        touched = [frozenset[str](), *(frozenset(m.touched) for m in truth if isinstance(m, KitchenTruth))]
        return sum(len(now - before) for before, now in itertools.pairwise(touched))

    def further_costs(self, truth: Sequence[Message]) -> Mapping[str, float]:
        """Cups that tipped while nothing held them, and seconds in which the base moved, but below 0.1 m/s."""
        states = [message for message in truth if isinstance(message, KitchenTruth)]
        cups = ((each, state.held) for state in states for each in state.objects if each.name in kitchen().cups)
        tipped = {cup.name for cup, held in cups if cup.tilt > kitchen().cup.tipped_rad and cup.name != held}
        slow = sum(abs(s.v) < SLOW_MPS and (abs(s.v) > REST_MPS or abs(s.omega) > REST_RADPS) for s in states)
        return {"tipped_cups": float(len(tipped)), "slow_s": slow * TRUTH_S}

    def arrival_errors(self, action: Action, arguments: Array, truth: Message) -> Mapping[str, float]:
        """Errors of a drive's position (m) and heading (rad), and of the speed (m/s)."""
        if not isinstance(truth, KitchenTruth) or action.name != "goToPose":
            return {}
        return {
            "position_m": math.hypot(truth.x - arguments[XG], truth.y - arguments[YG]),
            "heading_rad": difference(truth.phi, float(arguments[PHIG])),
            "speed_mps": truth.v - float(arguments[VG]),
        }
