"""The zenoh bus: sessions, publishers, inboxes, services. Only session.py imports zenoh."""
