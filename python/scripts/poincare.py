# %% [markdown]
# # Poincaré section of a loose joint
#
# The crank of a slider-crank turns evenly, once in 12 ms. The section shows the eccentricity of the loose pin once a turn, always at
# the same angle of the crank. A motion that repeats itself with the crank is one point, one that repeats itself after two turns is
# two points; a chaotic motion is a cloud. Run it at the top of the repository; it takes about a minute.

# %%
import os
import warnings

import matplotlib.pyplot as plt
import numpy as np

import looselink

SHORT = "LOOSELINK_SHORT" in os.environ  # few turns, for tests
TURNS = 6 if SHORT else 300
TRANSIENT = 1 if SHORT else 20  # turns until the start is forgotten
PERIOD = 0.012  # of the crank [s]

# %% [markdown]
# Rows that are a turn apart are the section: nothing needs to be interpolated.

# %%
scene = looselink.load("scenes/slider-crank/loose.toml")
scene.set("simulation.duration", TURNS * PERIOD).set("output.motion", False)
scene.set("output.channels", ["slider_pin.*"]).set("output.interval", PERIOD)
with warnings.catch_warnings():
    warnings.simplefilter("ignore", looselink.RunWarning)
    run = scene.run(progress=not SHORT)
print(*run.warnings, sep="\n")
assert np.allclose(np.diff(run.t), PERIOD, rtol=0, atol=1e-12)  # times are grid points up to rounding

# %%
section = np.array([run["slider_pin.ex"], run["slider_pin.ey"]])[:, TRANSIENT:]
distance = np.hypot(*section)
CLEARANCE = 5e-4  # that of the scene [m]
print(f"{section.shape[1]} turns, eccentricity from {distance.min() / CLEARANCE:.3f} to {distance.max() / CLEARANCE:.3f} clearances")

# %% [markdown]
# The circle is the clearance: outside of it the pin is pressed into its bearing.

# %%
figure, (plane, returns) = plt.subplots(1, 2, figsize=(9, 4.2), layout="constrained")
angle = np.linspace(0, 2 * np.pi, 400)
plane.plot(1e6 * CLEARANCE * np.cos(angle), 1e6 * CLEARANCE * np.sin(angle), linewidth=0.8, color="gray")
plane.plot(*(1e6 * section), ".", markersize=4)
plane.set(title="once a turn", xlabel="eccentricity along x [µm]", ylabel="along y [µm]", aspect="equal")
returns.plot(1e6 * distance[:-1], 1e6 * distance[1:], ".", markersize=4)
returns.set(title="return map", xlabel="eccentricity of a turn [µm]", ylabel="of the next [µm]")
figure.savefig("poincare.png", dpi=150)
