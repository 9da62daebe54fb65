"""The AGILO soccer robot as a simulated body: MuJoCo physics, firmware, sensors."""
