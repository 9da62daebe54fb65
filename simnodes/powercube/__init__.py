"""The PowerCube arm: six joints in MuJoCo, two of which write, each with a current loop at 1 kHz."""
