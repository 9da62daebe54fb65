"""Where parts of a work run: processes of this machine, or the workers of a Dask cluster."""
