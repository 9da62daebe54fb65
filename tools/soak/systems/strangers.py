"""How a soak marks what its strangers send, so that it does not take them for the system's own."""

STRANGER = "bad0"  # begin of every stranger's sender id
FORGED_NS = 0  # stamp of commands that a stranger sends in the executive's name: "unknown", which the guard accepts


def stranger_id(number: int) -> str:
    """Sender id of a stranger, 32 hex digits."""
    return f"{STRANGER}{number:028x}"
