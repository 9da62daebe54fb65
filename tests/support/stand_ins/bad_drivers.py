"""Drivers that break one clause of their contract each; the rest of them is the driver of every robot."""

import itertools
import math
from dataclasses import replace

from tailor.schemas.messages import Odometry
from tailor.simnodes import guard as guards
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.simnodes.guard import Mode, Reason
from tailor.simnodes.world import World
from tailor.tools.conformance.simulated_link import SimulatedLink
from tests.support.stand_ins.body import FakeBody

MS = 1_000_000
SPEC = shipped_driver_spec("agilo")


def good():
    """A driver that breaks none."""
    return SimulatedLink(World(FakeBody(), {}, 0), SPEC)


def published(link, topic, change):
    """`change(message, number)` instead of each message of a topic; None: none at all."""
    hear, numbers = link.hear, itertools.count()

    def changed(name, message, sequence):
        if name == topic:
            message = change(message, next(numbers))
        if message is not None:
            hear(name, message, sequence)

    link.hear = changed


def slow_state(link):
    published(link, "driver", lambda message, number: message if number % 3 == 0 else None)


def slow_odometry(link):
    published(link, "odom", lambda message, number: message if number % 3 == 0 else None)


def other_frame(link):
    hear = link.hear

    def changed(name, message, sequence):
        hear(name, message, sequence)
        if name == "odom":
            link._heard[-1] = replace(link._heard[-1], frame="world")

    link.hear = changed


def repeated_odometry(link):
    last = []

    def repeat(message, number):
        last[:] = last if last and number % 5 == 0 else [message]
        return last[0]

    published(link, "odom", repeat)


def changing_epoch(link):
    published(link, "driver", lambda message, number: replace(message, epoch=7 + number // 10))


def drives_while_disarmed(link):
    guard = link.node.driver.guard
    command, output, passed = guard.command, guard.output, {}

    def taken(now_ns, sender, sequence, values, *more):
        if guard.mode is not Mode.DISARMED:
            return command(now_ns, sender, sequence, values, *more)
        passed.update(values=tuple(values), until_ns=now_ns + 300 * MS)
        return None

    def put_out(now_ns):
        drives = guard.mode is Mode.DISARMED and passed and now_ns < passed["until_ns"]
        return passed["values"] if drives else output(now_ns)

    guard.command, guard.output = taken, put_out


def second_sender_takes_over(link):
    guard = link.node.driver.guard
    arm = guard.arm

    def armed(now_ns, sender, *more):
        if guard.mode is Mode.ARMED:
            guard.sender = sender
            return None
        return arm(now_ns, sender, *more)

    guard.arm = armed


def any_epoch(link):
    guard = link.node.driver.guard
    arm = guard.arm
    guard.arm = lambda now_ns, sender, epoch, *more: arm(now_ns, sender, 0, *more)


def unless(refusal):
    """The guard takes what it should refuse for one reason."""

    def bad(link):
        guard = link.node.driver.guard
        refuse = guard._refusal

        def lax(*command):
            found = refuse(*command)
            return None if found is refusal else found

        guard._refusal = lax

    return bad


def lax_stamps(link):
    command = link.node.driver.guard.command
    link.node.driver.guard.command = lambda now_ns, sender, sequence, values, *more: command(
        now_ns, sender, sequence, values
    )


def lax_numbers(link):
    link.received = lambda topic, message: message
    guard = link.node.driver.guard
    command = guard.command

    def finite(now_ns, sender, sequence, values, *more):
        return command(now_ns, sender, sequence, [0.0 if math.isnan(value) else value for value in values], *more)

    guard.command = finite


def turned_the_other_way(link):
    def mirrored(message, _):
        return replace(message, omega=-message.omega, phi=-message.phi) if isinstance(message, Odometry) else message

    published(link, "odom", mirrored)


def patient_guard(link):
    link.node.driver.guard._timeout_ns = 1500 * MS


def arms_itself_again(link):
    guard = link.node.driver.guard
    command, last = guard.command, []

    def taken(now_ns, sender, *more):
        last[:] = [guard.sender or (last[0] if last else "")]
        if guard.mode is Mode.STOPPED and sender == last[0]:
            guard.arm(now_ns, sender)
        return command(now_ns, sender, *more)

    guard.command = taken


def estop_only_disarms(link):
    guard = link.node.driver.guard
    estop = guard.estop

    def pressed(reason=Reason.ESTOP, detail=""):
        if reason is Reason.ESTOP:
            guard.disarm(Reason.DISARM_REQUEST)
        else:
            estop(reason, detail)

    guard.estop = pressed


def estop_without_latch(link):
    guard = link.node.driver.guard
    arm = guard.arm
    guard.arm = lambda now_ns, sender, epoch, reset, by_people: arm(now_ns, sender, epoch, True, by_people)


def switch_is_not_heard(link):
    link.node.driver.held.released = lambda now_ns: ()


BAD = {
    "reports_its_state": slow_state,
    "keeps_its_rates": slow_odometry,
    "keeps_its_frames": other_frame,
    "publishes_no_stale_data": repeated_odometry,
    "is_one_start": changing_epoch,
    "arms_for_one_sender": second_sender_takes_over,
    "refuses_another_epoch": any_epoch,
    "refuses_other_senders": unless(guards.CommandRefusal.OTHER_SENDER),
    "refuses_old_numbers": unless(guards.CommandRefusal.OLD_SEQUENCE),
    "refuses_late_commands": lax_stamps,
    "refuses_numbers_that_are_not_finite": lax_numbers,
    "refuses_values_beyond_limits": unless(guards.CommandRefusal.BEYOND_LIMIT),
    "moves_as_commanded": turned_the_other_way,
    "stops_without_commands": patient_guard,
    "stays_stopped": arms_itself_again,
    "takes_no_command_while_disarmed": drives_while_disarmed,
    "stops_at_an_estop": estop_only_disarms,
    "keeps_an_estop_until_a_reset": estop_without_latch,
    "stops_when_a_held_switch_is_released": switch_is_not_heard,
}
