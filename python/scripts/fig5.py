# %% [markdown]
# # Displacement error of the platform
#
# Fig. 5 of [Zhang & Zhang 2017](https://doi.org/10.1007/978-981-10-2875-5_95): how far the platform of the 3-RRR mechanism is off
# its path along x, a) with flexible links, b) with loose joints, c) with both. The paper shows the time from 1 s on. The three runs
# take about a minute. Run it at the top of the repository.

# %%
import os
import warnings

import matplotlib.pyplot as plt
import numpy as np

import looselink

SHORT = "LOOSELINK_SHORT" in os.environ  # two hundredths of a second, for tests
DURATION, FROM = (0.02, 0.0) if SHORT else (3.0, 1.0)
CASES = {"a) flexible links": "case2", "b) loose joints": "case3", "c) both": "case4"}

# %% [markdown]
# The warnings are those of all runs of these scenes: contact forces that the law makes negative are clamped at zero.

# %%
runs = {}
for title, name in CASES.items():
    scene = looselink.load(f"scenes/3rrr/{name}.toml").set("simulation.duration", DURATION)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", looselink.RunWarning)
        runs[title] = scene.run(progress=not SHORT)
    print(title, *runs[title].warnings, sep="\n  ")

# %% [markdown]
# The error that the play of the joints allows is some times their clearance of 20 µm. The flexible links add the vibration of a).

# %%
figure, panels = plt.subplots(1, 3, figsize=(12, 3.5), layout="constrained")
for panel, (title, run) in zip(panels, runs.items()):
    shown = run.t >= FROM
    error = 1e6 * run["error.x"][shown]
    panel.plot(run.t[shown], error, linewidth=0.5)
    panel.set(title=f"{title}: largest {np.abs(error).max():.3g} µm", xlabel="time [s]", ylabel="error along x [µm]")
figure.savefig("fig5.png", dpi=150)
