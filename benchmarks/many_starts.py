"""The nonlinear route's search against optimistix: the same residuals from the same 512 starts, in float64.

A fraction (u0 + u1*x)/(1 + u2*x) with a value and two moments. Reported: the first solve of a process (imports and
compilation included, as a person meets it), a second one, and how many starts end at the true root.
"""

import time

import numpy as np
import sympy as sp

TRUE = (1.0, 2.0, 0.5)
STARTS = 512


def stated():
    """The residuals in ratfit's words: the value at 1 and two moments of (1 + 2*x)/(1 + x/2)."""
    from ratfit._solver.nonlinear.residuals import Moment, Residual, Residuals

    x, u = sp.Symbol("x", nonnegative=True), sp.symbols("u0:3", real=True)
    form, true = (u[0] + u[1] * x) / (1 + u[2] * x), (1 + 2 * x) / (1 + x / 2)
    parts = [Residual(form.subs(x, 1) - true.subs(x, 1))]
    for weight in (sp.S.One, x):
        demand = sp.integrate(sp.apart(weight * true, x), (x, 0, 1))
        parts.append(Residual(-demand, (Moment(weight * form, sp.S.Zero, sp.S.One),)))
    return Residuals(x, u, tuple(parts))


def ours(residuals, starts):
    from ratfit._solver.nonlinear.arrays import System
    from ratfit._solver.nonlinear.newton import damped
    from ratfit._solver.nonlinear.quadrature import Rule

    system = System.of(residuals)
    prepared = system.prepare(np.zeros((1, 0)), [Rule(48)] * len(system.moments))
    return damped(system, starts, prepared)


def theirs(name):
    """A solver of optimistix, vmapped and compiled."""
    import jax
    import jax.numpy as jnp
    import optimistix

    jax.config.update("jax_enable_x64", True)
    nodes, weights = (jnp.asarray(a) for a in np.polynomial.legendre.leggauss(48))
    nodes, weights = (nodes + 1) / 2, weights / 2
    true = (1 + 2 * nodes) / (1 + nodes / 2)
    demands = jnp.stack([jnp.sum(weights * true), jnp.sum(weights * nodes * true)])

    def residual(u, _):
        f = (u[0] + u[1] * nodes) / (1 + u[2] * nodes)
        moments = jnp.stack([jnp.sum(weights * f), jnp.sum(weights * nodes * f)]) - demands
        return jnp.concatenate([jnp.array([(u[0] + u[1]) / (1 + u[2]) - 2.0]), moments])

    solver = getattr(optimistix, name)(rtol=1e-12, atol=1e-12)
    solve = optimistix.least_squares if name == "LevenbergMarquardt" else optimistix.root_find
    return jax.jit(jax.vmap(lambda u: solve(residual, solver, u, max_steps=60, throw=False).value))


def hits(found) -> int:
    return int(np.sum(np.max(np.abs(np.asarray(found) - TRUE), axis=1) < 1e-6))


def report(name, solve, starts) -> None:
    begin = time.perf_counter()
    found = np.asarray(solve()(starts))
    first = time.perf_counter() - begin
    again = solve()
    np.asarray(again(starts))
    begin = time.perf_counter()
    np.asarray(again(starts))
    print(f"{name:32} {first:8.2f} s {time.perf_counter() - begin:8.3f} s   {hits(found):4d} of {STARTS}")


def main() -> None:
    starts = np.random.default_rng(0).standard_cauchy((STARTS, 3))
    print(f"{'':32} {'first':>10} {'again':>10}   starts at the true root")
    residuals = stated()
    report("ratfit (NumPy, LM)", lambda: lambda s: ours(residuals, s), starts)
    for name in ("Newton", "Dogleg", "LevenbergMarquardt"):
        report(f"optimistix {name}", lambda name=name: theirs(name), starts)


if __name__ == "__main__":
    main()
