"""Forward search through states for long problems without durations; its sequence is deordered into a partial order."""
