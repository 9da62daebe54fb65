"""The B21 with its arm in a kitchen as a simulated body: PyBullet physics, firmware, sensors."""
