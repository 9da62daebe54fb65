"""Trees and forests that predict failure."""
