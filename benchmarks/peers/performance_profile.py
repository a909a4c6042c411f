#!/usr/bin/env python3
"""Performance profile (Dolan and More, 2002) of the solvers in the tables that siconos_peer prints:

    python3 benchmarks/peers/performance_profile.py PICTURE title=table.csv...

One panel a title; without a picture ("") the table only. An increment is solved if the residual is at most 1e-6 of the largest clamped force. The curve of a
solver is the share of all increments that it solves within tau times the time of the fastest one."""
import csv
import sys

ACCURACY = 1e-6


def read(file):
    """{(problem, increment): {solver: (seconds, residual)}}"""
    table = {}
    with open(file) as f:
        for row in csv.DictReader(f):
            table.setdefault((row["problem"], row["increment"]), {})[row["solver"]] = (
                float(row["seconds"]), float(row["residual"]))
    return table


def ratios(table):
    """{solver: time ratios to the fastest, of the increments it solves}"""
    solvers = {}
    for answers in table.values():
        solved = {s: t for s, (t, r) in answers.items() if r <= ACCURACY}
        for s in answers:
            solvers.setdefault(s, [])
        for s, t in solved.items():
            solvers[s].append(t / min(solved.values()))
    return {s: sorted(r) for s, r in solvers.items()}


def main():
    panels = [word.partition("=") for word in sys.argv[2:]]
    axes = [[None] * len(panels)]
    if sys.argv[1]:
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        figure, axes = plt.subplots(1, len(panels), figsize=(4.6 * len(panels), 3.8), sharey=True, squeeze=False)
    styles = {"cattaneo": ("k", "-"), "siconos lcp lemke": ("C0", "-"), "siconos lcp pivot": ("C0", "--"),
              "siconos lcp newton": ("C2", "-"), "siconos friction nsgs 1e-6": ("C1", ":"),
              "siconos friction nsgs 1e-10": ("C1", "-"), "siconos friction lemke": ("C3", "-")}
    for axis, (title, _, file) in zip(axes[0], panels):
        table = read(file)
        posed = {s for answers in table.values() for s in answers}
        everywhere = {s for s in posed if all(s in answers for answers in table.values())}
        table = {k: {s: a for s, a in answers.items() if s in everywhere} for k, answers in table.items()}
        print("%s: %d increments, solved to %g" % (title, len(table), ACCURACY))
        print("  %-28s %8s %12s %12s" % ("", "solved", "fastest", "median ratio"))
        for solver in sorted(ratios(table), key=lambda s: list(styles).index(s)):
            r = ratios(table)[solver]
            first = sum(x == 1 for x in r)
            print("  %-28s %7.1f%% %11.1f%% %12s" % (solver, 100 * len(r) / len(table), 100 * first / len(table),
                                                   "%.3g" % r[len(r) // 2] if r else "-"))
            if axis is None:
                continue
            color, style = styles[solver]
            x = [1] + [v for v in r for _ in (0, 1)] + [1e5]
            y = [0] + [k / len(table) for i in range(len(r)) for k in (i, i + 1)] + [len(r) / len(table)]
            axis.plot(x, y, color=color, linestyle=style, label=solver)
        for solver in sorted(posed - everywhere):
            print("  %-28s cannot be posed everywhere: where a body is held by contact alone there is no compliance" % solver)
        if axis is None:
            continue
        axis.set(xscale="log", xlim=(1, 1e5), ylim=(0, 1.02), title=title, xlabel="time over that of the fastest")
        axis.grid(alpha=0.3)
    if not sys.argv[1]:
        return
    axes[0][0].set_ylabel("share of increments solved to 1e-6")
    lines = {line.get_label(): line for axis in axes[0] for line in axis.get_lines()}
    figure.tight_layout(rect=(0, 0.1, 1, 1))
    figure.legend([lines[s] for s in styles if s in lines], [s for s in styles if s in lines], fontsize=8, loc="lower center", ncol=7)
    figure.savefig(sys.argv[1], dpi=130)


if __name__ == "__main__":
    main()
