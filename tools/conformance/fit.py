"""Does this robot move as the one did from which the action models were learned? Step responses of each axis, compared.

The models' robot is the simulated body of the package, in simulated time behind the same driver. A real robot that
answers later, accelerates otherwise or reaches another speed makes every predicted duration wrong.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import fmean, median, pstdev

from tailor.tools.conformance.bench import Bench, NotPossible, farther
from tailor.tools.conformance.link import speed_in

STEP_S = 3.0  # longest step; a step ends as soon as the axis has settled, since an arm has no room to run
WINDOW_S, SETTLED = 0.3, 0.03  # change of the mean speed from window to window, as a fraction of the step
SMOOTHED = 5  # samples
DEAD_S, SLOPE, SPEED = 0.08, 0.3, 0.1  # differences that matter: seconds, and fractions
RISE_S = 0.05  # of the whole rise: less is as good as at once; half of what is smoothed over, if that is longer
LOW, HIGH = 0.25, 0.75  # of the step; between them a response is steepest, and noise matters least
MAX_NOISE = LOW / 4  # of the step, after smoothing: else noise alone would cross LOW, and begin the response early
MAX_GAP_S = 0.04  # beyond the usual time between two measurements: half of the dead time that matters
TRIES = 5  # of a step with such a gap


@dataclass(frozen=True, slots=True)
class Response:
    """How one axis follows a step from standstill.

    Attributes:
      axis, unit: Name of the axis, and unit of its speed.
      commanded: Speed of the step.
      dead_s: Time until it begins to move, extrapolated from the steep part.
      slope: Acceleration in the steep part, unit per second.
      speed: Speed that it reaches.
      period_s: Usual time between two measurements.
    """

    axis: str
    unit: str
    commanded: float
    dead_s: float
    slope: float
    speed: float
    period_s: float = 0.0


def responses(bench: Bench, fraction: float) -> list[Response]:
    """Step responses of all axes that sensors show, up to a fraction of their limits.

    Raises:
      NotPossible: The driver cannot be armed, the robot does not come to rest, or measurements are missing whenever
        it takes a step.
    """
    found = []
    bench.begin()
    axes = bench.tested_axes()
    for index, _ in axes:
        axis, limit = bench.domain.axes[index], bench.spec.limits[index]
        step = fraction * farther(limit)
        command = [step if each == index else rest for each, rest in enumerate(bench.rest)]
        series = _whole_series(bench, command, index)
        if (noise := _noise(series)) > MAX_NOISE * abs(step):
            lost = f"a step of {step:.3g} {axis.unit} is lost in the noise of its measurements, {noise:.2g} {axis.unit}"
            raise NotPossible(f"{axis.name}: {lost}; expected a higher --speed, or --top-speed")
        response = _response(series, step)
        if response is not None:
            found.append(Response(axis.name, axis.unit, step, *response))
    return found


def _whole_series(bench: Bench, command: Sequence[float], index: int) -> list[tuple[float, float]]:
    """A series without gaps: a step that a busy machine or a busy bus interrupted measures nothing, and is repeated.

    Raises:
      NotPossible: Each of TRIES steps has one.
    """
    for _ in range(TRIES):
        bench.begin()
        bench.arm()
        series = _series(bench, command, index)
        bench.drive(bench.rest, 1.0)
        if _longest_gap_s(series) <= MAX_GAP_S:
            return series
    raise NotPossible(f"measurements of {bench.domain.axes[index].name} are missing in each of {TRIES} steps")


def _longest_gap_s(series: Sequence[tuple[float, float]]) -> float:
    """By how much the longest time between two measurements exceeds the usual one."""
    gaps_s = [later - earlier for (earlier, _), (later, _) in pairwise(series)]
    return max(gaps_s) - median(gaps_s) if gaps_s else 0.0


def _series(bench: Bench, command: Sequence[float], index: int) -> list[tuple[float, float]]:
    """Times since the step and speeds of the axis `index`, until it has settled.

    The times are those of the measurements, by the driver's clock; the fastest message shows how far that one is ahead
    of ours. So a message that waited on the bus, or for this process, is not taken for a robot that answers late.
    """
    name, step, start_s = bench.domain.axes[index].name, command[index], bench.link.now_s()
    means: list[float] = []
    while bench.link.now_s() - start_s < STEP_S:
        bench.drive(command, WINDOW_S)
        means.append(bench.measured(name, WINDOW_S) or 0.0)
        if len(means) > 1 and means[-1] / step > 0.5 and abs(means[-1] - means[-2]) < SETTLED * abs(step):
            break
    heard = [(each, v) for each in bench.log if each.at_s >= start_s and (v := speed_in(each, name)) is not None]
    ahead_s = min((each.at_s - each.stamp_s for each, _ in heard), default=0.0)
    return [(each.stamp_s + ahead_s - start_s, v) for each, v in heard]


def _noise(series: Sequence[tuple[float, float]]) -> float:
    """Standard deviation of the smoothed speeds once the axis has settled."""
    settled = [v for t, v in series if t > series[-1][0] - 2 * WINDOW_S]
    return pstdev(settled) / SMOOTHED**0.5 if settled else 0.0


def differences(real: Sequence[Response], models: Sequence[Response]) -> Iterator[str]:
    """Every difference that matters between a robot and the models' robot, in words."""
    by_axis = {each.axis: each for each in models}
    followed = {each.axis for each in real}
    yield from (f"{axis} does not follow a step, the models' robot does" for axis in by_axis if axis not in followed)
    for each in real:
        other = by_axis.get(each.axis)
        if other is None:
            continue
        if abs(each.dead_s - other.dead_s) > DEAD_S:
            yield f"{each.axis} answers after {each.dead_s:.2f} s, the models' robot after {other.dead_s:.2f} s"
        longer_s = each.commanded / each.slope - other.commanded / other.slope
        if abs(each.slope / other.slope - 1.0) > SLOPE and abs(longer_s) > max(RISE_S, SMOOTHED / 2 * each.period_s):
            unit = f"{each.unit}²" if each.unit.endswith("/s") else f"{each.unit}/s"
            yield f"{each.axis} accelerates with {each.slope:.2f} {unit}, the models' robot with {other.slope:.2f}"
        if abs(each.speed / other.speed - 1.0) > SPEED:
            yield (
                f"{each.axis} reaches {each.speed:.2f} of {each.commanded:.2f} {each.unit}, the models' robot "
                f"{other.speed:.2f}"
            )


def _response(series: Sequence[tuple[float, float]], step: float) -> tuple[float, float, float, float] | None:
    """Dead time, slope, speed and period of the measurements; None if the axis does not move."""
    if len(series) <= SMOOTHED:
        return None
    period_s = (series[-1][0] - series[0][0]) / (len(series) - 1)
    still = [(series[0][0] - k * period_s, 0.0) for k in range(SMOOTHED, 0, -1)]  # before the step
    whole = [*still, *series]
    smooth = [
        (fmean(t for t, _ in part), fmean(v for _, v in part) / step)
        for part in (whole[i : i + SMOOTHED] for i in range(len(whole) - SMOOTHED + 1))
    ]
    low_s, high_s = _crossing(smooth, LOW), _crossing(smooth, HIGH)
    if low_s is None or high_s is None or high_s <= low_s:
        return None
    rise_s = (high_s - low_s) / (HIGH - LOW)
    settled = [v for t, v in series if t > series[-1][0] - WINDOW_S]
    return low_s - LOW * rise_s, step / rise_s, fmean(settled), period_s


def _crossing(series: Sequence[tuple[float, float]], level: float) -> float | None:
    for (t0, v0), (t1, v1) in pairwise(series):
        if v0 < level <= v1:
            return t0 + (t1 - t0) * (level - v0) / (v1 - v0)
    return None
