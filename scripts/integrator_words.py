"""Integrators as text says them, by their names in scenes."""

WORDS = {
    "forward_euler": "forward Euler",
    "symplectic_euler": "symplectic Euler",
    "verlet": "Verlet",
    "leapfrog": "leapfrog",
    "midpoint": "midpoint",
    "rk4": "Runge-Kutta 4",
    "implicit_euler": "implicit Euler",
    "bdf2": "BDF2",
}
