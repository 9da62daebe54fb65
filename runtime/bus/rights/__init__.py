"""Who may publish what on the bus, and how a process proves who it is."""
