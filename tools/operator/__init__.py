"""What an operator does to a running system: arm and disarm, stop every driver, hold a dead man's switch."""
