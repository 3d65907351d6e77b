"""Draws figure.svg with matplotlib: python figure.py"""

import matplotlib

matplotlib.use("svg")
# The same file every time.
matplotlib.rcParams.update({"svg.hashsalt": "pathwarp", "svg.fonttype": "path", "path.simplify": False})
import matplotlib.pyplot as plt
import numpy as np

t = np.linspace(0, 6, 400)
figure, axes = plt.subplots(figsize=(4, 2.5), layout="constrained")
for k, colour in ((1, "tab:blue"), (2, "tab:orange"), (3, "tab:green")):
    axes.plot(t, np.exp(-t / 4) * np.sin(k * t), color=colour, label=f"sin {k}t")
axes.fill_between(t, -np.exp(-t / 4), np.exp(-t / 4), color="tab:grey", alpha=0.2)
axes.set_xlabel("time t")
axes.legend()
figure.savefig("figure.svg", metadata={"Date": None})
