"""Feature spaces of two joints (Table 7): from angles and velocities to angles and velocities."""

from __future__ import annotations

from tailor.models.features.features import FeatureSpace, Operations, Rows, direction, length, quantities, wrap

JOINTS = quantities("a:rad wa:rad/s b:rad wb:rad/s ag:rad wag:rad/s bg:rad wbg:rad/s")


def _joints(rows: Rows, ops: Operations) -> Rows:
    a, wa, b, wb, ag, wag, bg, wbg = (rows[[k]] for k in range(8))
    da, db = ag - a, bg - b
    dist, v, vg = length(da, db, ops), length(wa, wb, ops), length(wag, wbg, ops)
    sight = direction(da, db, dist, 0.0, ops)
    leave = direction(wa, wb, v, sight, ops)  # at rest: the line of sight
    arrive = direction(wag, wbg, vg, sight, ops)
    return ops.stack(v, vg, dist, wrap(ops.stack(sight - leave, arrive - sight), ops))


def _joints_relative(rows: Rows, ops: Operations) -> Rows:
    places = rows[[0, 2]]
    return ops.stack(places, rows[[4, 6]] - places, rows[[1, 3, 5, 7]])


joints = FeatureSpace("joints", JOINTS, quantities("v:rad/s v_g:rad/s dist:rad angle_1:rad angle_2:rad"), _joints)
joints_relative = FeatureSpace(  # for quantities that depend on the joint positions, as gravity does
    "joints-relative",
    JOINTS,
    quantities("a:rad b:rad da:rad db:rad wa:rad/s wb:rad/s wag:rad/s wbg:rad/s"),
    _joints_relative,
)
SPACES = (joints, joints_relative)
