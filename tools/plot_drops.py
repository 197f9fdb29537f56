#!/usr/bin/env python3
"""Draws what a drop costs by their number, from the JSON of sim_bench, as docs/images/drops.svg is.

    build/release/bench/sim/sim_bench --benchmark_filter=Everything/Drops --benchmark_format=json > drops.json
    tools/plot_drops.py drops.json docs/images/drops.svg

Several files, or a file with repetitions: the median of each number of drops is drawn.
"""
import json
import math
import statistics
import sys

WIDTH, HEIGHT = 640, 320
LEFT, RIGHT, TOP, BOTTOM = 64, 24, 28, 48


def medians(paths):
    """{drops: (mean us a tick, 99 % us, ns per drop and tick)}"""
    runs = {}
    for path in paths:
        with open(path, encoding="utf-8") as file:
            for b in json.load(file)["benchmarks"]:
                if "Everything/Drops" in b["name"] and b.get("run_type", "iteration") == "iteration":
                    at = int(b["name"].split("/")[2])
                    runs.setdefault(at, []).append((b["us_mean"], b["us_p99"], b["ns_per_drop"]))
    return {n: tuple(statistics.median(column) for column in zip(*rows)) for n, rows in sorted(runs.items())}


def decades(low, high):
    return [10.0**e for e in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)]


def svg(table):
    counts = list(table)
    x_low, x_high = counts[0] * 0.8, counts[-1] * 1.25
    y_ticks = decades(min(min(row) for row in table.values()), max(max(row) for row in table.values()))

    def x(n):
        return LEFT + (WIDTH - LEFT - RIGHT) * math.log(n / x_low) / math.log(x_high / x_low)

    def y(v):
        return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * math.log(v / y_ticks[0]) / math.log(y_ticks[-1] / y_ticks[0])

    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
        "<title>What drops cost in a tick by their number</title>",
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
    ]
    for v in y_ticks:
        out.append(f'<path d="M{LEFT} {y(v):.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>')
        out.append(f'<text x="{LEFT - 6}" y="{y(v) + 4:.1f}" text-anchor="end">{v:,.0f}</text>')
    for n in counts:
        out.append(f'<text x="{x(n):.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">{n:,}</text>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 10}" text-anchor="middle">drops</text>')
    for k, (name, colour, dash) in enumerate(
        [("µs a tick, mean", "#a01820", ""), ("µs a tick, 99 %", "#a01820", "5 4"), ("ns per drop and tick", "#205090", "")]
    ):
        line = "L".join(f"{x(n):.1f} {y(table[n][k]):.1f}" for n in counts)
        out.append(f'<path d="M{line}" fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
        if not dash:
            out += [f'<circle cx="{x(n):.1f}" cy="{y(table[n][k]):.1f}" r="3" fill="{colour}"/>' for n in counts]
        at = LEFT + 10 + 190 * k
        out.append(f'<path d="M{at} {TOP - 12}h24" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
        out.append(f'<text x="{at + 30}" y="{TOP - 8}">{name}</text>')
    return "\n".join(out + ["</svg>", ""])


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    table = medians(sys.argv[1:-1])
    for drops, (mean, p99, each) in table.items():
        print(f"| {drops:,} | {mean:.0f} | {p99:.0f} | {each:.0f} |")
    with open(sys.argv[-1], "w", encoding="utf-8") as file:
        file.write(svg(table))


if __name__ == "__main__":
    main()
