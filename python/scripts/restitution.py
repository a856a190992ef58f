# %% [markdown]
# # Restitution from a measured motion
#
# A journal bounces in its bearing. From its position, measured with noise, the restitution of the contact is found by least squares
# with SciPy. The data come from a run with a known restitution, so that the result can be checked. Run it at the top of the
# repository.

# %%
import warnings

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import least_squares

import looselink

TRUE = 0.83  # restitution
NOISE = 2e-7  # standard deviation of the position [m]; the clearance is 2e-5 m
SAMPLES = 400

# %% [markdown]
# The journal touches the bearing about every 2 ms, and moves evenly in between.

# %%
scene = looselink.load("scenes/bouncing-journal.toml").set("simulation.duration", 0.012)


def position(restitution):
    """x over time [m] with this restitution."""
    tried = scene.copy().set("contacts.aluminium.restitution", restitution)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", looselink.RunWarning)
        run = tried.run()
    return run.t, run["journal.x"]


t, x = position(TRUE)
times = np.linspace(0.0, t[-1], SAMPLES)
measured = np.interp(times, t, x) + np.random.default_rng(1).normal(0.0, NOISE, SAMPLES)

# %% [markdown]
# Residuals in units of the noise. The step of the differences is well above the error of a run and well below the width of the
# minimum.

# %%


def residuals(unknowns):
    t, x = position(float(unknowns[0]))
    return (np.interp(times, t, x) - measured) / NOISE


fit = least_squares(residuals, x0=[0.7], bounds=(0.4, 1.0), diff_step=1e-4)
found = fit.x[0]
deviation = 1 / np.sqrt(float(fit.jac[:, 0] @ fit.jac[:, 0]))
print(f"restitution {found:.5f}, standard deviation {deviation:.1e}, true {TRUE}")

# %% [markdown]
# The estimate of a linear model is normally distributed about the true value with this standard deviation: 4 of them are exceeded
# once in 16 000 draws of the noise. The residuals are then those of the noise, whose mean square has a deviation of √(2/400) = 0.07.

# %%
assert abs(found - TRUE) < 4 * deviation
assert deviation < 1e-3
assert abs(np.mean(fit.fun**2) - 1) < 4 * np.sqrt(2 / SAMPLES)

# %%
figure, axes = plt.subplots(figsize=(8, 3.5), layout="constrained")
axes.plot(1e3 * times, 1e6 * measured, ".", markersize=3, label="measured")
axes.plot(1e3 * t, 1e6 * position(found)[1], label=f"restitution {found:.4f}")
axes.set(xlabel="time [ms]", ylabel="position of the journal [µm]")
axes.legend()
figure.savefig("restitution.png", dpi=150)
