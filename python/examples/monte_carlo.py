"""What friction that is not well known does to the loss of a cycle: 1,000 marches on all cores.

A reduced problem is condensed once; each march has a friction of its own. march() lets other threads run, so that a pool of
threads is all it takes. Run as `python monte_carlo.py [problem.json] [marches]`."""

import concurrent.futures
import os

# One thread each for linear algebra: the marches are many. Before NumPy is imported.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pathlib
import sys
import time

import cattaneo
import numpy as np

shipped = pathlib.Path(__file__).parents[2] / "problems" / "hertz.json"
problem = cattaneo.load_reduced_problem(sys.argv[1] if len(sys.argv) > 1 else shipped)
marches = int(sys.argv[2]) if len(sys.argv) > 2 else 1000

P, Q = {"P": 1.0}, 0.2
history = cattaneo.LoadHistory.through(problem, [{}, P, {"Q": Q}, {"Q": -Q}, {"Q": Q}], cycle_start=2)


def loss(friction):
    """Energy loss of a steady cycle."""
    own = problem.copy()
    own.friction = friction
    report = cattaneo.march(own, history)
    return report.cycles[-1].dissipation if report.converged else np.nan


frictions = np.random.default_rng(1).normal(0.4, 0.04, marches)
begin = time.perf_counter()
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    losses = np.fromiter(pool.map(loss, frictions), float, marches)
seconds = time.perf_counter() - begin

low, middle, high = np.nanquantile(losses, [0.05, 0.5, 0.95])
print(f"{marches} marches of {problem.nodes} nodes in {seconds:.2f} s on {os.cpu_count()} cores")
print(f"{np.isnan(losses).sum()} of them did not converge (sliding)")
print(f"loss of a cycle: median {middle:.4g}, nine of ten between {low:.4g} and {high:.4g}")
