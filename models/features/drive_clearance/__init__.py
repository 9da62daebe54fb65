"""Clearances of a drive as its controller plans it from an upright box or cylinder."""
