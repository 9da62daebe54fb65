"""The contract of drivers: clauses that are tried at a driver on the bus, or at a simulated one in lock-step."""
