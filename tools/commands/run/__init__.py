"""Commands that run robots: launch, drive, arm, stop, record, plan."""
