"""The zenoh bus: sessions, publishers, inboxes, services. Only session.py and wires.py import zenoh."""
