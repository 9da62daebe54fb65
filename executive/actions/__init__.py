"""Control programs of executable actions: pure functions of the belief. Innate: they stay as they are."""
