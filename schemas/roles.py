"""Roles of the processes on a bus; what each may do derives from the tables of topics and services."""

from __future__ import annotations

from typing import Literal, get_args

Role = Literal["executive", "driver", "people", "recorder", "observer", "player"]
ROLES: tuple[Role, ...] = get_args(Role)
