"""Joint states that repeat themselves to the last digit while their own velocities move the joints: frozen encoders.

A driver that has lost its motors may publish the last reading again and again, with new stamps. Taken for measurements,
such readings drove an arm blind to the ends of its joints.
"""

from __future__ import annotations

from dataclasses import dataclass

from tailor.schemas.messages import JointState

MOST = 0.1  # rad or m that a joint moves without one digit of any position: far more than encoders resolve
SLOWEST = 0.1  # rad/s or m/s; slower ones may be the offset of a tachometer at rest
LONGEST_NS = 100_000_000  # that a velocity counts for: nothing is known of a silence


@dataclass(frozen=True, slots=True)
class Repeat:
    """The last joint state of a key, its arrival, and how far its velocities have moved the fastest joint, rad or m."""

    state: JointState
    at_ns: int
    moved: float = 0.0


def repeated(known: Repeat | None, at_ns: int, state: JointState) -> tuple[Repeat, str]:
    """What is known after a joint state, and why it is no measurement.

    Args:
      known: What was known before it; None: there was none.
      at_ns: Its arrival.
      state: Of finite values; rad and rad/s, or m and m/s.

    Returns:
      What is known, and the fault, e.g. "repeats itself while its joints move at 0.9"; empty if it has none.
    """
    if known is None or _values(state) != _values(known.state):
        return Repeat(state, at_ns), ""
    speed = max(map(abs, state.velocities), default=0.0)
    passed_ns = min(LONGEST_NS, max(0, at_ns - known.at_ns))
    moved = known.moved + (speed > SLOWEST) * speed * 1e-9 * passed_ns
    fault = f"repeats itself while its joints move at {speed:.2g}" if moved > MOST else ""
    return Repeat(state, max(at_ns, known.at_ns), moved), fault


def _values(state: JointState) -> tuple[tuple[float, ...], tuple[float, ...]]:
    return state.positions, state.velocities
