#!/usr/bin/env python3
"""chart_by_matplotlib.py OUT.json: the chart of chart_bench by matplotlib: 10, 30 and 60 groups of four bars, 1200 x 700
pixels, drawn and encoded as PNG in memory."""
import io, json, pathlib, sys
from timing import least_seconds
import numpy as np
import matplotlib
matplotlib.use("Agg")
from matplotlib import pyplot


def chart(postures):
    figure, axes = pyplot.subplots(figsize=(12, 7), dpi=100)
    place = np.arange(postures)
    names = ["without compensation", "CP", "PP", "DPP"]
    for s, (name, colour) in enumerate(zip(names, ["#808080", "#c82828", "#2850c8", "#28a03c"])):
        axes.bar(place + 0.2 * (s - 1.5), (2 + 0.1 * ((7 * place) % 13)) / (1 + 2 * s), 0.2, label=name, color=colour)
    axes.set_xticks(place, [str(p + 1) for p in place], rotation=90 if postures > 30 else 0)
    axes.set(title="Displacement of $P_{wrist}$", xlabel="Posture", ylabel="Displacement of $P_{wrist}$ (mm)")
    axes.grid(axis="y")
    axes.legend()
    picture = io.BytesIO()
    figure.savefig(picture, format="png")
    pyplot.close(figure)
    return picture.getvalue()


pathlib.Path(sys.argv[1]).write_text(json.dumps({"Chart": {str(n): least_seconds(lambda: chart(n)) for n in (10, 30, 60)}}))
